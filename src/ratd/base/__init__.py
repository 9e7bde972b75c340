"""What everything else stands on.

errors      the two errors that a user is meant to see
checks      what numbers of a user must be
units       multiples of SI units in configuration files, tables and figures
materials   constants of the bulk and of its surface, and means of several materials
parts       parts of the engine that are chosen by their type: laws, drives, boxes, integrators
jit         how functions are compiled, and where they are kept
own_cache   compiled functions on the disk, told apart by what they were compiled from
fastmath    roots and reciprocals for the hot loop
rows        eight rows of memory as columns in vector registers, and back, for the hot loop
vectors     four numbers that are moved and computed as one, for the hot loop
statistics  medians, means and slopes with their uncertainty
measured    numbers with their standard errors
words       numbers and plurals in texts
"""
