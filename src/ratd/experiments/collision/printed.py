"""What Umstaetter & Urbassek (2020, A&A 633, A24) print of their results, and what is read from it."""

PRINTED_THRESHOLDS = {0.396e-6: 27.0, 0.453e-6: 19.0, 0.57e-6: 12.5}
"""Radius of equal spheres [m] -> fragmentation velocity [m/s] (Sect. 3.3)."""
PRINTED_RADII = {"N_s": (0.314e-6, 4.6), "X": (0.353e-6, 5.0), "energy_half": (0.298e-6, 4.5)}
"""Quantity -> radius [m] of the equal spheres that MRN is like, and its moment q (Sects. 3.1, 3.2). The energy
is said to be like that of 0.298 to 0.314 um, q = 4.5 to 4.6."""
RADII = (0.298e-6, 0.314e-6, 0.353e-6, 0.396e-6, 0.453e-6, 0.57e-6)
"""Radii of the equal spheres [m]."""
