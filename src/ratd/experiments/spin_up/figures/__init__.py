"""Figures of the paper, a module each: a function that draws it, and `draw`, which reads what it needs from files."""
