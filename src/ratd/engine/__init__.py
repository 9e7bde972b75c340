"""The engine: integrates every monomer of one aggregate. Arrays in, arrays out; no files, no Snakemake.

layout     where each number stands
state      the arrays of one run: set up, turned, enlarged
contacts   the list of contacts
forces     contact forces of one step, the hot loop
fragments  which monomers hang together, and what has left
advance    the time loop
measure    what is recorded of a state
"""
