"""Collision: two clusters shot at each other, and what becomes of them."""
