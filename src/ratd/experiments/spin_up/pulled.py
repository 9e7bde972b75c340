"""Tensile strengths of the grains of the spin-up, beside the tension that they bear when they turn apart.

`ratd.validation.pulling` pulls the grains and writes the files whose kind stands here. Each is pulled in two ways. In
the *box* its own copies squeeze it until it fills a periodic box as densely as itself, which changes it, and the box
grows along one axis. By its *ends* it is pulled as it stands. A strength S is told as S <a>/(gamma phi^1.8), <a> being
the mean radius of the monomers and phi the filling factor of what is pulled: 0.6 by Tatsuuma et al. (2019).
"""

from pathlib import Path

import numpy as np
import pandas as pd

from ratd.aggregates.strength import TENSILE_FACTOR, midplane_tension, tensile_strength_tatsuuma2019
from ratd.base.errors import InputError
from ratd.experiments.spin_up.cells import joined, sort_cells
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import MATERIAL, ROW, Kind, Variable, over, register, row_sizes

__all__ = ["AXES", "KIND", "VARIANTS", "WAYS", "beside_spin", "outer_radius", "read_pulled", "usual"]

WAYS = ("box", "ends")
"""How a grain is pulled; the flag in a file is the place in this list."""
AXES = ("shortest", "middle", "longest")
"""Principal axes of a grain; the flag in a file is the place in this list."""
VARIANTS = ("usual", "slow", "less", "more")
"""The pull that counts, and with one thing changed: the rates, or the column ``part`` of the table."""
MARKS = {"": "omega_mass_75", " first": "omega_first_loss"}
"""Marks whose tension stands beside the strength, by what is put to the name of a slot."""

_PULL = {
    "part": ("1", "box: filling factor squeezed to, over that of the grain; ends: part of the mass held at each"),
    "squeeze_rate": ("1", "strain rate C_v of the squeezing"),
    "strain_rate": ("1", "strain rate C_v of the pulling"),
    "phi": ("1", "filling factor of what is pulled"),
    "strength": ("Pa", "greatest tension; box: in the mean over 2 % in L"),
    "peak": ("Pa", "greatest tension in the mean over 0.5 % in L"),
    "strain": ("1", "ln L (box), or way of the ends over their distance, at the greatest tension"),
    "residual": ("Pa", "pressure left at rest before the pulling"),
    "kept": ("1", "contacts of the grain that the squeezing has left, over all that it had"),
    "new": ("1", "new contacts within the grain, over all that it had"),
    "across": ("1", "number of contacts with own copies along the pulled axis"),
    "unequal": ("1", "mean difference of the forces at both ends, over the greatest"),
    "omega": ("rad s-1", "at which half of the turning grain pulls at the other as hard as it holds"),
    "steps": ("1", "time steps"),
}
"""Numbers of a pull: units and meaning; NaN where it has none."""

KIND = register(
    "pulled",
    Kind(
        "Grains pulled until they come apart",
        {
            **MATERIAL,
            **over(
                (ROW,),
                {
                    "a_eff": ("m", "effective radius"),
                    "filling_factor": ("1", "filling factor of the grain as grown"),
                    "mean_monomer_radius": ("m", "mean radius of its monomers"),
                },
            ),
            **over(
                (ROW,),
                {"seed": ("1", "seed"), "n_monomers": ("1", "monomers"), "n_contacts": ("1", "contacts")},
                dtype="i8",
            ),
            "source": Variable((ROW,), "str", "", "hash of the source that pulled it"),
            **row_sizes(("pull",)),
            "way": Variable(("pull",), "i1", "", "how it was pulled", flags=WAYS),
            "axis": Variable(("pull",), "i1", "", "along which of its principal axes", flags=AXES),
            "variant": Variable(("pull",), "i1", "", "what was changed", flags=VARIANTS),
            **over(("pull",), _PULL, nan=True),
        },
        attributes=("material", "type"),
        ragged=("pull",),
    ),
)


def outer_radius(a_eff, filling_factor):
    """Radius [m] of the porous sphere that stands for a grain, a_eff phi^(-1/3); S by the ends is force over pi times
    its square."""
    return a_eff * filling_factor ** (-1.0 / 3.0)


def read_pulled(folder):
    """Table of all pulls.

    Parameters
    ----------
    folder : path-like
        Of `ratd.validation.pulling`.

    Returns
    -------
    pandas.DataFrame
        A row a pull, in the order of the paper, with what is known of its grain: material, type, a_eff, seed,
        n_monomers, n_contacts, filling_factor, mean_monomer_radius, surface_energy, density. ``ratio`` is
        S <a>/(gamma phi^1.8).

    Raises
    ------
    InputError
        If there are no files.
    """
    found = []
    for path in sorted(Path(folder).glob("*.nc")):
        file = io.read(path, KIND)
        material = material_of(file)
        constants = {"surface_energy": material.surface_energy, "density": material.density}
        for row in rows(file, KIND):
            grain = {name: row[name].item() for name in row.data_vars if not row[name].dims}
            own = row[["way", "axis", "variant", *_PULL]].to_dataframe()
            found.append(own.assign(material=material.name, type=row.attrs["type"], **grain, **constants))
    if not found:
        raise InputError(f"{folder}: holds no pulled grains.")
    table = sort_cells(pd.concat(found, ignore_index=True))
    for name, words in (("way", WAYS), ("axis", AXES), ("variant", VARIANTS)):
        table[name] = np.array(words)[table[name]]
    table["ratio"] = _ratio(table["strength"], table, table["phi"])
    return table


def _ratio(strength, grains, phi):
    """S <a>/(gamma phi^1.8) of strengths S [Pa]."""
    formula = tensile_strength_tatsuuma2019(grains["surface_energy"], grains["mean_monomer_radius"], phi)
    return TENSILE_FACTOR * strength / formula


def usual(table):
    """The pulls that count, one a grain and way: along its longest axis, in the variant ``usual``."""
    return table[(table["axis"] == "longest") & (table["variant"] == "usual")]


def beside_spin(table, spun):
    """What the spin-up says of the same grains.

    Parameters
    ----------
    table : pandas.DataFrame
        Of `read_pulled`, or a part of it.
    spun : pandas.DataFrame
        Of `ratd.experiments.spin_up.grain_table.spun_up_table`.

    Returns
    -------
    pandas.DataFrame
        The table with the marks; for each ``spin_MARK``, the mean tension in the mid-plane of the turning sphere that
        stands for the grain, in units of gamma/<a> phi^1.8. NaN for a grain that was not spun up.
    """
    both = joined(table, spun, MARKS.values(), how="left")
    phi = both["filling_factor"]
    outer = outer_radius(both["a_eff"], phi)
    for mark in MARKS.values():
        tension = midplane_tension(both[mark], both["density"], phi, outer)
        both[f"spin_{mark}"] = _ratio(tension, both, phi)
    return both
