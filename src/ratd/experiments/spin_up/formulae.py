"""What single formulae of the paper change: the same grains with one as printed, beside the consistent model.

Those of contacts are made by `ratd.experiments.spin_up.contact_law`.
"""

import pandas as pd

from ratd.base.statistics import median_of
from ratd.experiments.spin_up.cells import size_key
from ratd.experiments.spin_up.parameters import beside_own, marks_row
from ratd.experiments.spin_up.printed import PAPER
from ratd.experiments.spin_up.run_files import read_marks
from ratd.pipeline.kinds import Kind, as_dataset, entries, register

__all__ = [
    "DAMPING",
    "FORMULAE",
    "FORMULA_COLUMNS",
    "OWN",
    "formula_effects",
    "formula_table",
    "table",
]

OWN = "consistent"
DAMPING = "damping"
FORMULAE = {
    OWN: "the consistent model",
    "sliding_stiffness": "sliding stiffness of Eq. 13 with G* = G/(2 - 2 nu^2)",
    "sliding_limit": "zeta_c = r0 (1 - nu)/(16 pi)",
    "twisting_stiffness": "twisting stiffness of Eq. 17 with G* = G/(2 - 2 nu^2)",
    DAMPING: "no damping force, as in Eq. 29",
}
"""Name -> what is used as printed; all else is the consistent model. Those of contacts are options of
`ratd.laws.jkr`, see `ratd.experiments.spin_up.contact_law`; without the damping the material has the viscous time 0."""

FORMULA_COLUMNS = {
    "formula": ("", f"what is used as printed: {', '.join(FORMULAE)}"),
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "drive": ("", "what turns the grain: prescribed or literal"),
    "a_eff": ("m", "effective radius"),
    "seed": ("1", "seed of the grain"),
    "omega_disr": ("rad s-1", "angular velocity of disruption: peak of the total stress before the grain collapses"),
    "omega_mass_75": ("rad s-1", "angular velocity at which the largest fragment has lost 25 % of the initial mass"),
    "omega_disr_ratio": ("1", "omega_disr over that of the same grain in the consistent model"),
    "omega_mass_75_ratio": ("1", "omega_mass_75 over that of the same grain in the consistent model"),
}
"""Units and meaning of the columns of `formula_table`."""


def formula_table(files):
    """Marks of all grains with every formula, and over those of the same grain in the consistent model.

    Parameters
    ----------
    files : list of (str, list of xarray.Dataset)
        A name of `FORMULAE`, and the marks of some grains from `ratd.disruption`.

    Returns
    -------
    pandas.DataFrame
        Columns of `FORMULA_COLUMNS`; a ratio is NaN where one of the two marks is.

    Raises
    ------
    InputError
        If a grain was not spun up in the consistent model.
    """
    rows = [{"formula": formula} | marks_row(marks) for formula, grains in files for marks in grains]
    table = pd.DataFrame(rows, columns=list(FORMULA_COLUMNS))
    return beside_own(table, table["formula"] == OWN, "the consistent model")


def table(files, settings, say):
    """The table of the runs with single printed formulae, from their files.

    Parameters
    ----------
    files : sequence of path-like
        Marks of the grains of each formula.
    settings : dict
        ``formulae``: of each file the name of its formula.
    say : callable
        Called with a sentence.

    Returns
    -------
    dict
        Name of an output -> what it holds.
    """
    found = formula_table(list(zip(settings["formulae"], map(read_marks, files), strict=True)))
    say(f"{len(found)} runs")
    return {"formulae": as_dataset(found), "formulae_csv": found}


def formula_effects(table, mark):
    """How far each printed formula moves a mark: medians over the grains of a type and size, and over all of a size.

    Parameters
    ----------
    table : pandas.DataFrame
        From `formula_table`.
    mark : str
        One of `parameters.MARKS`.

    Returns
    -------
    pandas.DataFrame
        One row a formula, size and type (``all`` for all of them together): formula, nm (the size), type, and what
        `median_of` of ratd.base.statistics gives for the ratio to the consistent model.
    """
    rows = []
    changed = table[table["formula"] != OWN]
    for (formula, size), part in changed.groupby(["formula", size_key(changed["a_eff"])], sort=False):
        for kind, here in [*part.groupby("type"), ("all", part)]:
            rows.append({"formula": formula, "nm": size / 1000, "type": kind} | median_of(here[f"{mark}_ratio"]))
    return pd.DataFrame(rows)


register("formulae", Kind("Grains spun up with single formulae as printed", entries(FORMULA_COLUMNS), references=PAPER))
