"""Rows of the course of a disruption: loss of mass, contacts, fragments (Figs. 4 and 5)."""

import numpy as np

from ratd.beyond import binomial_interval
from ratd.calibration import onset
from ratd.ensemble import cell_of
from ratd.fragmentation import HALF
from ratd.marks import ROUNDING
from ratd.reproduction.bounds import by_type_and_size, in_cell, sizes_of, split_sizes
from ratd.reproduction.rate import is_calibrated
from ratd.reproduction.text import (
    NEAR,
    NOTHING,
    ROUGHLY,
    Answer,
    all_of,
    answer,
    between,
    drive_rows,
    lies_between,
    number,
    over,
    with_error,
)
from ratd.statistics import median_of

LEVEL = (
    "prescribed: a grain that turns as a whole cannot hold the printed omega (What the contacts can hold). literal: it "
    "hardly turns, and omega follows d omega/dt and the step (What the literal drive does)."
)
BAM = ("BAM1", "BAM2")
PIECES = (
    "A slow spin-up lets large pieces go. Those that have left are not spun up further; "
    "whether the paper counts them as they leave is not said."
)
EARLY_CONTACTS = "A hundredth of the load of omega_disr, far from what breaks a contact."
MOSTLY = 0.8
"""Share that counts as "almost completely"."""
RARELY = 0.1
"""Share that counts as "rarely"."""
LARGER = 0.95
"""Mass of the largest fragment below which larger ones have left."""


def rows(data):
    """Rows of the course of a disruption, list of Row."""
    cell = _of_cell(data)
    return [
        _onset(data),
        drive_rows(
            "decade",
            cell,
            lambda t, p: _median_answer(t["omega_end"] / t["omega_first_loss"], p, ROUGHLY),
            "The end is one contact left; the last two monomers of a grain can hold to many times omega_disr.",
        ),
        drive_rows(
            "gain",
            data.tables,
            _gain,
            "The median of all BAM2 grains, for which the paper finds the gain most pronounced.",
        ),
        drive_rows("gain_most", data.tables, _gain_most, "Medians."),
        drive_rows(
            "quarter",
            data.tables,
            _quarter,
            "Where it is far below 1, large pieces of a grain have left before the stress of what is left peaks.",
        ),
        *_whole(data),
        drive_rows(
            "blocks",
            {drive: table[table["half"] & table["type"].isin(BAM)] for drive, table in data.fragments.items()},
            _up_to(1),
            PIECES,
        ),
        drive_rows(
            "few",
            {drive: table[table["half"]] for drive, table in data.fragments.items()},
            _up_to(3),
            PIECES,
        ),
    ]


def _median_answer(values, printed, factor=NEAR, cell=None):
    """Answer with the median of some values and its bootstrap error, or None without values."""
    found = median_of(values, cell=cell)
    return answer(found["median"], found["error"], printed, factor) if found["n"] else None


def _of_cell(data):
    """Drive -> table of the grains of the cell of Fig. 4."""
    own = data.plan.config["figures"]["figure4"]
    if own is None:
        return {}
    return {drive: in_cell(table, own) for drive, table in data.tables.items()}


def _onset(data):
    """Where mass loss begins in Fig. 4, which decides nothing about a drive that was fixed on it."""
    fixed = is_calibrated(data)

    def evaluate(drive, runs, printed):
        own = _median_answer([onset(run) for run, _ in runs], printed)
        return Answer(f"{own.text} (fixed on this)", own.ratio) if own and drive == "literal" and fixed else own

    sources = {drive: (drive, runs) for drive, runs in data.course.items()}
    return drive_rows("onset", sources, lambda source, p: evaluate(*source, p), f"1 % of the mass lost. {LEVEL}")


def _gain(table, printed):
    table = table.assign(gain=table["n_contacts_max"] / table["n_contacts"])
    own = table[table["type"] == "BAM2"]
    found = median_of(own["gain"], cell=cell_of(own))
    if not found["n"]:
        return None
    parts = [
        f"{kind} {int((part['gain'] > 1).sum())} of {len(part)} above 1, at most {part['gain'].max():.4g}"
        for kind, part in table.groupby("type", sort=False)
    ]
    text = f"{with_error(found['median'], found['error'])} ({'; '.join(parts)})"
    return Answer(text, holds=bool(found["median"] > 1))


def _gain_most(table, printed):
    """Median gain of contacts of BAM2 less the greater one of BA and BAM1."""
    gain = table["n_contacts_max"] / table["n_contacts"]
    found = {kind: median_of(gain[own.index], cell=cell_of(own)) for kind, own in table.groupby("type", sort=False)}
    if set(found) != {"BA", *BAM}:
        return None
    other = max(("BA", "BAM1"), key=lambda kind: found[kind]["median"])
    value = found["BAM2"]["median"] - found[other]["median"]
    error = np.hypot(found["BAM2"]["error"], found[other]["error"])
    medians = ", ".join(f"{kind} {number(own['median'])}" for kind, own in found.items())
    return Answer(f"{with_error(value, error)} ({medians})", holds=lies_between(value, error, low=0.0))


def _reconnects(runs, printed):
    """How often the largest fragment gains mass among all changes of its mass up to omega_disr."""
    gains, n = 0, 0
    for run, mark in runs:
        here = run["omega"].values <= float(mark["omega_disr"])
        steps = np.diff(run["mass"].values[here]) / run.attrs["initial_mass"]
        gains, n = gains + int((steps > ROUNDING).sum()), n + int((np.abs(steps) > ROUNDING).sum())
    if not n:
        return None
    low, high = binomial_interval(gains, n)
    return Answer(
        f"{number(gains / n)} ({gains} of {n})", holds=True if high < RARELY else False if low > RARELY else None
    )


def _quarter(table, printed):
    parts, verdicts = [], []
    for kind, sizes, part in by_type_and_size(table):
        found = median_of(part["omega_mass_75"] / part["omega_disr"], cell=cell_of(part))
        if found["n"]:
            own = answer(found["median"], found["error"], printed)
            parts.append(f"{kind} {sizes} {own.text} ({between(found['low'], found['high'])})")
            verdicts.append(own.holds)
    return Answer("; ".join(parts), holds=all_of(verdicts)) if parts else None


def _whole(data):
    """Rows on the mass of the largest fragment at parts of omega_disr, of the cell of Fig. 4 and of Fig. 5."""
    course, shown = data.course, data.shown

    def row(key, part, holds, reason=""):
        def evaluate(source, printed):
            drive, runs = source
            values = _left(runs, "mass", part)
            if not len(values):
                return None
            middle = float(np.median(values))
            ends = f"{values.min():.3f}–{values.max():.3f} of {len(values)}" if len(values) > 1 else "one grain"
            text = f"{middle:.3f} ({ends})"
            for value in _left(shown.get(drive, []), "mass", part):
                text += f"; the grain of Fig. 5, of another cell, {value:.3f}"
            return Answer(text, over(middle, printed.value) if printed.value else NOTHING, holds(middle))

        return drive_rows(key, {drive: (drive, runs) for drive, runs in course.items()}, evaluate, reason)

    early = "Given are median, least and greatest; for all grains see the mass lost at omega_disr."
    return [
        row("whole_01", 0.1, lambda middle: bool(middle > 1 - 1e-9)),
        drive_rows("contacts_01", course, lambda runs, p: _fewer_contacts(runs, 0.1), EARLY_CONTACTS),
        row("whole_08", 0.8, lambda middle: bool(middle < 1 - 1e-9), early),
        row("whole_10", 1.0, lambda middle: bool(middle < LARGER), early),
        drive_rows("reconnect", course, _reconnects, "Records up to omega_disr, all runs together."),
    ]


def _fewer_contacts(runs, part):
    """Answer with the contacts at a part of omega_disr over those at the start."""
    values = _left(runs, "n_contacts", part)
    if not len(values):
        return None
    middle = float(np.median(values))
    text = f"{middle:.4f} ({values.min():.4f}–{values.max():.4f} of {len(values)})"
    return Answer(text, holds=bool(middle < 1 - 1e-9))


def _left(runs, name, part):
    """What the largest fragment has of the mass or the contacts of the grain at a part of omega_disr.

    Parameters
    ----------
    runs : list of tuple
        Runs and their marks.
    name : str
        mass or n_contacts.
    part : float

    Returns
    -------
    numpy.ndarray
        Over the value at the start, of each run that has an omega_disr; at the first record from that omega on.
    """
    values = []
    for run, mark in runs:
        omega = part * float(mark["omega_disr"])
        if np.isfinite(omega):
            k = min(int(np.searchsorted(run["omega"].values, omega * (1 - 1e-12))), run.sizes["record"] - 1)
            values.append(float(run[name].values[k]) / run.attrs[f"initial_{name}"])
    return np.array(values)


def _up_to(monomers):
    """What evaluates the share of the mass that leaves in fragments of up to so many monomers."""

    def share_of(part):
        mass = part["weight"] * part["mass_fraction"]
        return mass[part["fragment_n_monomers"] <= monomers].sum() / mass.sum()

    def evaluate(part, printed):
        if not len(part):
            return None
        share = share_of(part)
        most = HALF * share + 1 - HALF  # if nothing but such fragments left afterwards
        sides = ", ".join(f"{sizes_of(own)} {number(share_of(own))}" for own in split_sizes(part))
        text = f"{number(share)} of the first half of the mass ({sides}), so at most {number(most)} of all"
        return Answer(text, over(most, printed.value), True if share >= MOSTLY else False if most < MOSTLY else None)

    return evaluate
