"""Checks of the whole model against exact answers, theory and its own convergence: `snakemake validation`.

A check is a module here, which computes a table with one row a case. The tests hold the fast part of each check.
"""
