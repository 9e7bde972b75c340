"""What the document tells of grains that radiation destroys."""

import numpy as np

from ratd.base.measured import Measured
from ratd.base.units import NM
from ratd.experiments.spin_up.surviving import surviving

__all__ = ["NONE", "of_radiation"]

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
        same with "printed" for "ours", and with " porous" behind it, where gas hits all of the porous grain. With
        " greatest" behind it the largest size that is destroyed, `NONE` also where there is no end to them.
    """
    values = {}
    for porous in (False, True):
        for row in surviving(table, grown, strengths, porous=porous, **options).to_dict("records"):
            key = f"radiation.{row['material']} {row['type']} {row['strength']:g} {row['law']}"
            key += " porous" if porous else ""
            for end, size, error in (("", "a_disr", row["a_disr_error"]), (" greatest", "greatest", np.nan)):
                found = np.isfinite(row[size])
                values[key + end] = Measured(row[size] / NM, error / NM) if found else NONE
    return values
