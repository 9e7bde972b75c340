"""The quasi-static spin-up: what each of its numbers does to the marks, and the marks beside another way to them.

Every grain is spun up as in production, and with one number changed at a time. A grain compared with itself has no
scatter from its form; what is left is the shift that is looked for and the chaos of the breaks, which the same run with
a start moved by 1e-12 m shows.
"""

import numpy as np
import pandas as pd

from ratd.aggregates.growth import grow
from ratd.base.errors import GrainError, is_of_one_grain
from ratd.base.statistics import median_of
from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import semi_implicit
from ratd.experiments.spin_up.cells import GRAIN
from ratd.experiments.spin_up.how import DRIVES, STEP
from ratd.experiments.spin_up.marks import BEFORE_MARKS, before_marks, disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.validation.tables import GRAIN_COLUMNS, empty_row, grain_values, table_kind

MARKS = ("omega_first_loss", "omega_mass_75", "omega_disr")
COLUMNS = {
    "vary": ("", "what is changed, production where nothing is"),
    "value": ("1", "to what: a number, or the place in the list of words of WORDS"),
    **GRAIN_COLUMNS,
    "outcome": ("", "how the run ended"),
    "steps": ("1", "time steps up to the end"),
    "smaller_steps": ("1", "parts of the run made again with smaller steps"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
    **{name: about for name, about in BEFORE_MARKS.items() if name != "steps_first_loss"},
}
table_kind("quasi_static", "Marks of the quasi-static spin-up against each of its numbers", COLUMNS)
PRODUCTION = "production"
MOVED = 1e-12
"""Distance [m] by which the start of a repeat is moved."""
UNWAITING = {"pace": 0.004, "unrest": 1.0}
"""Of a spin-up that never waits, as slow as one of epsilon = 0.004, but has a drag."""
WORDS = {"drive": DRIVES, "integrator": ("semi-implicit", "leapfrog")}
"""What is changed to a word, and the words."""


def compute(settings, progress=None):
    """Spin one grain up in every way.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, ``vary``: name -> list of values. Names: stretch, unrest, pace, drag, drive,
        epsilon (arguments of `ratd.spin_up`), longest, displacement, travel, calming (of the semi-implicit step),
        integrator, moved (seeds of random shifts of the start), unwaiting (drag of a spin-up of `UNWAITING`).
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`. A run that fails has NaN marks and says so in ``outcome``.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    rows = [_spin(grain, PRODUCTION, 0.0)]
    for vary, values in settings["vary"].items():
        for value in values:
            rows.append(_spin(grain, vary, value))
            if progress is not None:
                progress(f"{vary} {value}: {rows[-1]['outcome']}")
    return rows


def _arguments(vary, value):
    """Arguments of `ratd.spin_up` for one change."""
    if vary in STEP:
        return {"integrator": semi_implicit(**(STEP | {vary: value}))}
    if vary == "integrator":
        return {"integrator": leapfrog()}
    if vary == "unwaiting":
        return {"drag": value, "integrator": leapfrog()} | UNWAITING
    if vary in (PRODUCTION, "moved"):
        return {}
    return {vary: value}


def _spin(grain, vary, value):
    if vary == "moved":
        shift = np.random.default_rng(value).normal(scale=MOVED, size=grain.position.shape)
        grain = grain.replace(position=grain.position + shift)
    row = empty_row(COLUMNS)
    number = WORDS[vary].index(value) if vary in WORDS else float(value)
    row |= {"vary": vary, "value": number, **grain_values(grain)}
    try:
        run = spin_up(grain, **_arguments(vary, value))
    except (RuntimeError, GrainError) as error:
        if not is_of_one_grain(error):
            raise
        return row | {"outcome": "failed: " + str(error).split(":")[0]}
    marks = disruption(run)
    row |= {name: float(marks[name]) for name in MARKS}
    return (
        row
        | {name: value for name, value in before_marks(run, marks).items() if name in COLUMNS}
        | {
            "outcome": run.attrs["end_reason"],
            "steps": run.attrs["steps"],
            "smaller_steps": run.attrs["smaller_steps"],
            "cut_bound": run.attrs["cut_bound"],
        }
    )


def shifts(table, marks=MARKS, by=("type",)):
    """Medians of the marks over those of production, grain by grain.

    Parameters
    ----------
    table : pandas.DataFrame
        Rows of `COLUMNS`.
    marks : sequence of str
    by : sequence of str
        Columns to group by, beside vary and value.

    Returns
    -------
    pandas.DataFrame
        vary, value, the columns of `by`, mark, and what `median_of` of ratd.base.statistics gives for the ratios.
    """
    # a grain that two groups of config/validation.yaml hold stands twice
    own = table[table["vary"] == PRODUCTION].drop_duplicates(GRAIN).set_index(GRAIN)
    found = []
    for (vary, value), part in table[table["vary"] != PRODUCTION].groupby(["vary", "value"]):
        for mark in marks:
            ratio = part[mark].to_numpy() / own[mark].reindex(pd.MultiIndex.from_frame(part[GRAIN])).to_numpy()
            for key, ratios in part.assign(ratio=ratio).groupby(list(by), observed=True)["ratio"]:
                names = dict(zip(by, key if isinstance(key, tuple) else (key,), strict=True))
                found.append({"vary": vary, "value": value, **names, "mark": mark} | median_of(ratios))
    return pd.DataFrame(found)
