"""Every number printed in Reissl et al. (2024) that code of this experiment needs, and nothing computed.

Values are as printed, in SI units unless their digits matter, in which case they are texts.
"""

import math

__all__ = [
    "FIRST_LOSS",
    "OBSERVED",
    "PAIR_ERROR",
    "PAPER",
    "PAPER_MEAN_RADIUS",
    "PRINTED_1",
    "PRINTED_2",
    "PRINTED_GRAINS",
    "SPIN_UP",
    "TABLE_3",
    "TABLE_3_SOURCE",
    "VISCOUS_EFFECT",
]

PAPER = "Reissl et al. (2024), A&A 692, A60, arXiv:2301.12889"

PRINTED_1 = {"Mg/O": "0.23", "Si/O": "0.27", "Fe/O": "0.21", "Mg/Fe": "1.08", "(Mg+Fe)/Si": "1.60"}
"""Ratios of element abundances in co-S as printed in Table 1 ("this work"), with their printed digits."""

OBSERVED = {
    "min_2007": ("Min et al. (2007)", (0.31, 0.26, 0.15, 2.03, 1.82)),
    "voshchinnikov_2010": ("Voshchinnikov & Henning (2010)", (math.nan, math.nan, math.nan, 1.09, 2.25)),
    "compiegne_2011": ("Compiègne et al. (2011)", (0.23, 0.19, 0.19, 1.25, 2.25)),
    "hensley_2021": ("Hensley & Draine (2021)", (0.19, 0.15, 0.17, 1.07, 2.34)),
}
"""Ratios in the interstellar medium as Table 1 quotes them, in the order of `PRINTED_1`."""

PRINTED_GRAINS = {
    ("BA", 200): (160, 162, 543.1e-9),
    ("BA", 350): (521, 521, 882.6e-9),
    ("BA", 500): (1773, 1772, 1385.7e-9),
    ("BAM1", 200): (117, 235, 457.4e-9),
    ("BAM1", 350): (636, 1275, 901.2e-9),
    ("BAM1", 500): (1885, 3774, 1214.7e-9),
    ("BAM2", 200): (157, 475, 320.1e-9),
    ("BAM2", 350): (649, 1950, 603.3e-9),
    ("BAM2", 500): (1814, 5546, 845.2e-9),
}
"""Type and a_eff [nm] of the grains of Fig. 1 -> their N_mon, N_con and a_out [m]."""

PRINTED_2 = {
    "a-C": ("50", "168", "0.16", "2368"),
    "q-S": ("20", "54", "0.17", "2650"),
    "co-S": ("70", "169", "0.27", "3707"),
    "forsterite": ("70", "204", "0.24", "3213"),
    "fayalite": ("70", "140", "0.32", "4393"),
    "enstatite": ("70", "180", "0.21", "3209"),
    "ferrosilite": ("70", "142", "0.31", "4014"),
}
"""Table 2 as printed, with its digits, in the order and units of `composition.PROPERTIES`."""

TABLE_3 = {
    ("a-C", "BA"): (1.97, 0.10),
    ("a-C", "BAM1"): (2.28, 0.12),
    ("a-C", "BAM2"): (2.25, 0.13),
    ("q-S", "BA"): (2.13, 0.10),
    ("q-S", "BAM1"): (2.18, 0.14),
    ("q-S", "BAM2"): (2.22, 0.14),
    ("co-S", "BA"): (1.50, 0.10),
    ("co-S", "BAM1"): (1.65, 0.14),
    ("co-S", "BAM2"): (1.57, 0.15),
}
"""(A, alpha) of Eq. 33 as printed in Table 3 of Reissl et al. (2024), A&A 692, A60, for comparison only."""
TABLE_3_SOURCE = "Reissl et al. (2024), A&A 692, A60, Table 3"
PAPER_MEAN_RADIUS = 20e-9
"""<a_mon> [m] that the paper gives for its radius distribution (Sect. 3); the grains' own mean is about 30 nm."""

PAIR_ERROR = 0.018
"""Greatest error of the angular velocity at which two monomers part, against Eq. 35 (Appendix A, Fig. 10)."""

FIRST_LOSS = (("q-S", "BAM2", 350e-9), 3e8)
"""Material, type, a_eff [m] of the grains of Fig. 4, and omega [rad s-1] up to which their mass stays (Sect. 7.1)."""

SPIN_UP = (3e10, 3600.0)
"""omega [rad s-1] towards which grains are turned, and the shortest time [s] that "hours" (Sect. 6) can mean for it."""

VISCOUS_EFFECT = (9e-12, 1.11)
"""T_vis [s], and omega_disr with it over that at 5 ps, of a-C BAM2 (Sect. 7.5)."""
