"""Aggregates at rest: what they are, and how they grow."""
