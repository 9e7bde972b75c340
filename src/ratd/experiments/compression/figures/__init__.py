"""Figures of the compression, one module a figure."""
