"""What the document tells of grains that radiation destroys."""

import numpy as np

from ratd.base.measured import Measured
from ratd.base.units import NM
from ratd.experiments.spin_up.radiation import infrared_coefficient
from ratd.experiments.spin_up.surviving import COMPUTED, surviving

__all__ = ["NONE", "of_radiation"]

SILICATE = infrared_coefficient(0.18, 16.4)
"""F_IR of silicate, where the printed 0.4 is near that of graphite."""
FARTHEST = 2.0 * COMPUTED[1]
"""Greatest size [m] that is told: the laws are of grains half as large."""
NONE = "none"
"""What stands in a document where no size is destroyed."""


def of_radiation(table, grown, strengths=(1.0, 1e2, 1e4), **options):
    """Smallest and greatest sizes that radiation destroys.

    Parameters
    ----------
    table, grown
        As of `ratd.experiments.spin_up.surviving.surviving`.
    strengths : sequence of float
        U of the radiation.
    **options
        Of the same, but `porous`.

    Returns
    -------
    dict
        "radiation.q-S BAM1 100 ours" -> a_disr [nm] as a `Measured`, or the text `NONE` where no size is destroyed; the
        same with "printed" for "ours", and with " porous" behind it, where gas hits all of the porous grain, or with
        " cool", where the grain sheds infrared light as silicate does (`SILICATE`). With
        " greatest" behind it the largest size that is destroyed, `NONE` also where there is no end to them.
    """
    values = {}
    for behind, how in (("", {}), (" porous", {"porous": True}), (" cool", {"coefficient": SILICATE})):
        for row in surviving(table, grown, strengths, **how, **options).to_dict("records"):
            key = f"radiation.{row['material']} {row['type']} {row['strength']:g} {row['law']}{behind}"
            for end, size, error in (("", "a_disr", row["a_disr_error"]), (" greatest", "greatest", np.nan)):
                found = np.isfinite(row[size])
                values[key + end] = Measured(row[size] / NM, error / NM) if found else NONE
            if row["a_disr"] > FARTHEST:
                values[key] = f"over {FARTHEST / NM:.0f}"
    return values
