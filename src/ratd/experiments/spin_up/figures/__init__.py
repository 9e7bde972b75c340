"""Figures of the spin-up, a module each: a function that draws it from tables, datasets or grains.

Those that the pipeline makes have `draw` as well, which reads what it needs from files: the figures of the paper,
`calibration` and `formulae`. The others are of docs/reproduction.md alone.
"""
