"""Space: what is where, without forces.

box         open space, and a periodic box that may shrink or grow
neighbours  which spheres are near each other, and which hang together
shape       moments of inertia, axes, porosity, fractal dimension, enclosing sphere
directions  random directions
"""
