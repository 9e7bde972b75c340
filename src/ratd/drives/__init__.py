"""What moves an aggregate, besides its contacts.

A drive is a NamedTuple marked by `ratd.base.parts.part`. Its methods, compiled together with the time loop, are

turning()
    Whether the aggregate as a whole turns in the coordinates of the run.
follow(state, changed)
    Called at the start of a call, and with ``changed`` after contacts were made or broken.
leave(state, law)
    Take out of the run what has left; the number of fragments taken.
sample(state, law)
    Called now and then, for means over a time.
load(state, kick)
    Add forces of the drive to `state.force` before the integrator weighs them; most drives have none to add.
longest_step(state)
    Longest step [s] that the drive allows an integrator that chooses its step by the motion.
move(state, box, kick, dt)
    Change the velocities by the forces in `state.force`, acting for ``kick``, then the positions by these for ``dt``;
    clear the forces, and leave a bound on the greatest speed in `FASTEST`, or NaN after a failure.

What a drive keeps stands in `state.drive`; the first number is its clock, in which `Until.clock` is told.

free          nothing from outside; `rest` with a drag
squeezing     a periodic box that shrinks or grows
quasi_static  the turning frame of a spin-up that waits until the grain is quiet
rotating      the turning frame of a spin-up at a given rate
"""
