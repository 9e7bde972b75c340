"""Figures and words of the checks: each module has `draw(table)` and `tell(table)` for the check of its name."""
