"""The engine: moves every sphere of a run. Arrays in, arrays out; it knows no law and no experiment by name.

layout      where each number of a monomer and of a run stands
state       the arrays of one run: set up, enlarged, brought to rest
contacts    the list of contacts: one added, one removed, the step and the damping that they allow
forces      forces and torques of all contacts at one step, the hot loop
lists       pairs that may come into contact
fragments   which monomers hang together, and taking fragments out
leapfrog    the integrator
step        the time loop, and when it ends
checkpoint  keep a run in a file, and go on from it with the same bits

A run also has a law (`ratd.laws`), a drive (`ratd.drives`) and a box (`ratd.geometry.box`), each chosen by its type.
docs/model/engine.md tells how they work together.
"""
