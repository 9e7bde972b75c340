"""Figures of the collision: those of the paper by their numbers, and what is beyond it."""
