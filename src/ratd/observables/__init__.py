"""Observables: functions of a state, computed when asked for.

energy     kinetic, stored and dissipated, by mode
stress     of contacts
pressure   of a periodic box
pieces     the fragments, the largest one's monomers and shape
structure  how the monomers are spread
"""
