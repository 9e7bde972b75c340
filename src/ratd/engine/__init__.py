"""The engine: moves every sphere of a run. Arrays in, arrays out; it knows no law and no experiment by name.

layout         where each number of a monomer and of a run stands
state          the arrays of one run: set up, enlarged, brought to rest
contacts       the list of contacts: one added, one removed, the step and the damping that they allow
forces         forces and torques of all contacts at one step, the hot loop
lists          pairs that may come into contact
fragments      which monomers hang together, and taking fragments out
leapfrog       the explicit integrator
semi_implicit  the integrator of slow processes
block_factor   the sparse matrix that it solves
step           the time loop, and when it ends
checkpoint     keep a run in a file, and go on from it with the same bits

An integrator is a part too. Its methods are

set_step(state, shortest)
    Choose the step `DT` after contacts have changed; ``shortest`` is the shortest time of any contact [s].
prepare(state, law), renew(state, law, work)
    What it needs between two changes of contacts: at the start of a call, and after a change.
step(state, law, drive, box, scratch, work)
    One step; the number of contacts that have ended.
farthest()
    How far a monomer may move in one long step [m], by which the lists of near pairs reach farther; 0 for short steps.
limit(state, law, drive, box, far, least, work)
    Shorten or lengthen the step to come by the motion; ``far`` holds the pairs that are near, ``least`` is the least
    radius [m].
with_smaller_steps(part)
    The same integrator with steps that are smaller by this part.

One field is asked for, `implicit_damping`: whether the normal damping is weakened such that it cannot limit the step.

A run also has a law (`ratd.laws`), a drive (`ratd.drives`) and a box (`ratd.geometry.box`), each chosen by its type.
docs/model/engine.md tells how they work together.
"""
