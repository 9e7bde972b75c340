"""Checks of the whole model against exact answers, theory and its own convergence: `snakemake validation`.

A check is a module here, which computes a table with one row a case, and a module of the same name in
`ratd.validation.show`, which draws the table and says in words and numbers what it shows. The tests hold the fast part
of each check.
"""
