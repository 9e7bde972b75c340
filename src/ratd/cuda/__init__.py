"""The engine on an NVIDIA GPU: many grains at once, the same physics as `ratd.engine`.

A grain is small and knows nothing of the others, so each gets one thread block, which runs the whole time loop: steps,
contacts made and broken, fragments, records. Hundreds of grains are in flight. Everything is float64.

What is shared with the CPU. A grain on the device is a `ratd.engine.state.State` in the same layout: blocks of contacts
with one field after the other are what neighbouring threads read together. numba compiles the functions of the CPU
engine for the device as well, so every formula stands once: a thread calls `forces_between` for one contact,
`kick_and_drift_one` for one monomer, and thread 0 calls `append_contact`, `remove_contact`, `drop`. Only what the CPU
does in loops over all contacts or monomers is written again here, for a block of threads.

One step has three barriers. (1) Contacts: each thread takes every T-th contact and leaves force and torques in the
array `result`. (2) Monomers: each thread takes every T-th monomer, sums over the list of its contacts in the order of
their numbers, kicks and moves it; angular momentum, moment of inertia and greatest speed are summed in a fixed tree.
(3) Pairs that may touch. Scalars such as time and omega are computed alike by all threads. No sum uses atomics; integer
atomics only find labels of fragments and fill lists that are sorted afterwards. So a run repeats bit for bit, for one
number of threads, which follows from the grain alone.

A launch runs each grain for a segment, a number of steps that follows from the grain's size so that all blocks take
about as long, or until the host is needed: a snapshot, too little room, the end. Segments end at steps that do not
depend on when the process was killed; checkpoints are written between them, so a run that was killed goes on with the
same bits. Records are made on the device, as sums from which the host gets the columns of `ratd.spinup`. The
relaxation at rest runs in the same loop.

device     what is compiled how, and whether there is a device
block      sums, greatest values and prefix sums over a thread block
arena      the arrays of all grains on the device; from State and back
lists      contacts of each monomer, pairs that may come into contact
forces     one step
fragments  fragments found, departed ones dropped
measure    sums of a record
advance    the time loop, a kernel
spin_up    relaxation and spin-up of many grains, as `ratd.spinup` does one
"""
