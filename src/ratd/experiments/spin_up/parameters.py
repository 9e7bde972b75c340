"""What the two least known constants do to disruption: critical rolling displacement and viscous time (Fig. 9)."""

import numpy as np
import pandas as pd

from ratd.base.errors import InputError
from ratd.base.statistics import median_of
from ratd.experiments.spin_up.printed import PAPER
from ratd.pipeline import io
from ratd.pipeline.blocks import material_of, rows
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = [
    "MARKS",
    "PARAMETERS",
    "PARAMETER_COLUMNS",
    "beside_own",
    "effect",
    "marks_row",
    "parameter_table",
    "table",
    "ways",
]

PARAMETERS = {"xi_c": "critical_rolling_displacement", "T_vis": "viscous_time"}
"""Name of what is varied -> attribute of `ratd.Material`, and column of the table."""
OWN = "none"
"""Instead of a name of `PARAMETERS`: the material as it is."""
MARKS = ("omega_disr", "omega_mass_75")
PARAMETER_COLUMNS = {
    "parameter": ("", "what differs from the material as it is: none, xi_c or T_vis"),
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "drive": ("", "what turns the grain: prescribed, torque or literal"),
    "a_eff": ("m", "effective radius"),
    "seed": ("1", "seed of the grain"),
    "critical_rolling_displacement": ("m", "critical rolling displacement xi_c"),
    "viscous_time": ("s", "viscous time T_vis"),
    "omega_disr": ("rad s-1", "angular velocity of disruption: peak of the total stress before the grain collapses"),
    "omega_mass_75": ("rad s-1", "angular velocity at which the largest fragment has lost 25 % of the initial mass"),
    "omega_disr_ratio": ("1", "omega_disr over that of the same grain with the material as it is"),
    "omega_mass_75_ratio": ("1", "omega_mass_75 over that of the same grain with the material as it is"),
}
"""Units and meaning of the columns of `parameter_table`."""
_GRAIN = ["material", "type", "drive", "a_eff", "seed"]
"""What names a grain of such a table."""


def ways(material, values):
    """The settings that a grain is spun up with: the material as it is, then one constant changed at a time.

    Parameters
    ----------
    material : ratd.Material
    values : dict of str to sequence of float
        Name of `PARAMETERS` -> values; the material's own is left out, since the grain as it is has it.

    Returns
    -------
    list of (str, dict)
        What is varied (`OWN` or a name of `PARAMETERS`), and the changed attributes of the material.
    """
    found = [(OWN, {})]
    for name, attribute in PARAMETERS.items():
        own = getattr(material, attribute)
        found += [(name, {attribute: value}) for value in values[name] if abs(value - own) > 1e-9 * own]
    return found


def parameter_table(files):
    """Marks of all grains with every setting, and over those of the same grain with the material as it is.

    Parameters
    ----------
    files : list of (str, ratd.Material, list of xarray.Dataset)
        What is varied (`OWN` or a name of `PARAMETERS`), the material that the grains were spun up with, and their
        marks from `ratd.disruption`.

    Returns
    -------
    pandas.DataFrame
        Columns of `PARAMETER_COLUMNS`; a ratio is NaN where one of the two marks is.

    Raises
    ------
    InputError
        If a grain was not spun up with the material as it is.
    """
    rows = []
    for parameter, material, grains in files:
        constants = {attribute: getattr(material, attribute) for attribute in PARAMETERS.values()}
        rows += [{"parameter": parameter} | constants | marks_row(marks) for marks in grains]
    table = pd.DataFrame(rows, columns=list(PARAMETER_COLUMNS))
    return beside_own(table, table["parameter"] == OWN, "its material as it is")


def table(files, settings, say):
    """The table of figure 9, from the files of its runs.

    Parameters
    ----------
    files : sequence of path-like
        Marks of the grains spun up in each way.
    settings : dict
        ``parameters``: of each file what is varied in it.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    opened = [io.read(path, "disruption") for path in files]
    found = parameter_table(
        [
            (parameter, material_of(file), rows(file, "disruption"))
            for parameter, file in zip(settings["parameters"], opened, strict=True)
        ]
    )
    say(f"{len(found)} runs")
    return {"parameters": as_dataset(found), "parameters_csv": found}


def marks_row(marks):
    """What names a grain and its `MARKS`, dict, from the marks of `ratd.disruption`."""
    return {name: marks.attrs[name] for name in _GRAIN} | {name: float(marks[name]) for name in MARKS}


def beside_own(table, own, words):
    """A table of runs with the ratio of each mark to that of the same grain in the run that it is compared with.

    Parameters
    ----------
    table : pandas.DataFrame
        With what names a grain (material, type, drive, a_eff, seed) and `MARKS`.
    own : array_like of bool
        Which rows are those to compare with, one a grain.
    words : str
        What these are, for the message.

    Returns
    -------
    pandas.DataFrame
        With the columns ``MARK_ratio``.

    Raises
    ------
    InputError
        If a grain has no such row.
    """
    keys = pd.MultiIndex.from_frame(table[_GRAIN])
    reference = table[np.asarray(own)].set_index(_GRAIN)[list(MARKS)]
    missing = keys.difference(reference.index)
    if len(missing):
        raise InputError(f"the grain {', '.join(map(str, missing[0]))} was not spun up with {words}")
    reference = reference.loc[keys]
    return table.assign(**{f"{name}_ratio": table[name].to_numpy() / reference[name].to_numpy() for name in MARKS})


def effect(table, parameter, mark):
    """How far one constant moves a mark: medians over the grains of a type.

    Parameters
    ----------
    table : pandas.DataFrame
        From `parameter_table`, of one drive.
    parameter : str
        A name of `PARAMETERS`.
    mark : str
        One of `MARKS`.

    Returns
    -------
    pandas.DataFrame
        One row a type and value, sorted: type, value [SI], and what `median_of` of ratd.base.statistics gives for
        the ratio to the grain as it is.
    """
    here = table[table["parameter"].isin((OWN, parameter))]
    rows = [
        {"type": kind, "value": value} | median_of(part[f"{mark}_ratio"])
        for (kind, value), part in here.groupby(["type", PARAMETERS[parameter]])
    ]
    return pd.DataFrame(rows)


register(
    "parameters",
    Kind(
        "Grains spun up with other rolling displacements and viscous times",
        entries(PARAMETER_COLUMNS),
        references=PAPER,
    ),
)
