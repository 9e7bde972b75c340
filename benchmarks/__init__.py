"""Speed of ratd: the kernel beside LAMMPS, what each part of the paper costs, how cost grows with size.

    python -m benchmarks                    # everything, in the folder of the repository
    python -m benchmarks kernel             # one part: kernel, cost, scaling, pipeline, profile, agreement
    python -m benchmarks --quick --out /tmp/b    # a tiny run that shows that it works; its numbers mean nothing

machine  what it runs on: processor, memory, one core, versions
grains   aggregates of a given number of monomers, grown or read
engine   `ratd.engine.step.run` timed
before   the engine of another checkout of the repository timed on the same aggregate
peer     LAMMPS timed on the same aggregate
kernel   part (a): all in alternation; large aggregates, other laws and boxes, grains of ten monomers
cost     part (b): cost of every cell of the config, and of the whole paper
scaling  part (c): time and memory from 10 to 30 000 monomers
pipeline part (d): what the pipeline adds to the work over small sizes
profile  part (e): where the steps of a spin-up go, only where it is asked for by its name
agreement  the same grains spun up by this and another checkout, only where it is asked for by its name
tables   CSV files of the parts
goals    what was aimed at, beside what was found
report   text and tables of benchmarks/results/README.md and docs/speed.md, from the CSV files
figures  what is drawn in it
"""
