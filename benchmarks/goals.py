"""What was aimed at, and what was found."""

from typing import NamedTuple

import numpy as np

from benchmarks.answer import SLOW, ratios
from benchmarks.tables import frame, pair_ratios, projected_range

MOST_NS = {"BAM2": 17.0, "BA": 15.0}
"""Time of a step and contact that is aimed at [ns]; those of one contact a monomer have fewer to share its motion."""
OF_FILES = 17.0
"""... of an aggregate from a file."""


class Goal(NamedTuple):
    """What was aimed at and what was found.

    Attributes
    ----------
    what, unit : str
    value, limit : float
    greatest : bool
        Whether the limit is the greatest value that meets the goal, else the least.
    low, high : float, optional
        Where a projected value may lie; None for a measured one.
    """

    what: str
    unit: str
    value: float
    limit: float
    greatest: bool
    low: float | None = None
    high: float | None = None

    def off(self, value):
        """By what factor a value misses the goal; 1 and less where it meets it."""
        return value / self.limit if self.greatest else self.limit / value

    @property
    def verdict(self):
        """Whether the goal is met."""
        nearest, farthest = sorted(self.off(end) for end in (self.low or self.value, self.high or self.value))
        if farthest <= 1.0:
            return "met"
        if nearest <= 1.0:
            return "left open"
        if self.low is None:
            return f"missed by a factor of {nearest:.2f}"
        return f"missed by a factor of {nearest:.2f} to {farthest:.2f}"

    @property
    def found(self):
        """The value, with its range where it is projected."""
        text = f"{self.value:.3g}"
        # what was measured in every part has no range
        return text if self.low == self.high else f"projected {text} ({self.low:.3g}–{self.high:.3g})"


def goals(out):
    """What was aimed at and what was measured.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.

    Returns
    -------
    list of Goal
        What was not measured is left out.
    """
    data, small, runs = frame(out, "kernel"), frame(out, "small"), frame(out, "cost_runs")
    others, paper = frame(out, "combinations"), frame(out, "cost_paper")
    growth, overhead = frame(out, "scaling"), frame(out, "pipeline")
    found = []
    for (name, motion), case in [] if data is None else data.groupby(["aggregate", "motion"], sort=False):
        own = case.loc[case["code"] == "ratd", "ns_per_contact_step"].median()
        found.append(
            Goal(f"kernel, {name} {motion}", "ns per contact and step", own, MOST_NS.get(name, OF_FILES), True)
        )
        ratio = pair_ratios(case)
        if len(ratio):
            found.append(Goal(f"LAMMPS over ratd, {name} {motion}", "times", float(np.median(ratio)), 10.0, False))
    found += [] if others is None else _by_number(others[others["code"] == "ratd"])
    if small is not None:
        slowest = small.groupby(["aggregate", "motion"])["us_per_step"].median().max()
        found.append(Goal(f"a step of {small['monomers'].iloc[0]} monomers, slowest case", "us", slowest, 1.5, True))
    if runs is not None:
        largest = runs[runs["size_nm"] == runs["size_nm"].max()]
        name = f"growth of a grain of {largest['size_nm'].iloc[0]:g} nm, slowest"
        found.append(Goal(name, "s", largest["growth_seconds"].max(), 0.5, True))
    for row in [] if paper is None else paper.itertuples():
        law = f"drive {row.drive}, {row.pace}, f = {row.timestep_factor:g}"
        found.append(
            Goal(f"{row.grains} grains, {law}", "core-hours", row.core_hours, 48.0, True, *projected_range(row))
        )
    answers = frame(out, "answer")
    if answers is not None:
        # what was run is faster than the goal asks for, and its answer is off
        epsilon = answers["epsilon"].min()
        least = min(ratios(answers).values())
        what = f"least type, projected from {least * SLOW / epsilon:.3g} times at epsilon = {epsilon:.2g} to {SLOW:g}"
        found.append(Goal(f"LAMMPS over ratd, time to omega at 25 % mass loss, {what}", "times", least, 300.0, False))
    squeezed = frame(out, "compression")
    if squeezed is not None:
        largest = squeezed[squeezed["monomers"] == squeezed["monomers"].max()].set_index("code")
        own, other, long = (largest.loc[code] for code in ("ratd, explicit", "LAMMPS", "ratd, long steps"))
        what = f"compression of {own['monomers']} monomers"
        found += [
            Goal(f"{what}, explicit", "ns per contact and step", own["ns_per_contact_step"], 20.0, True),
            Goal(
                f"{what}, LAMMPS over ratd, step by step", "times",
                other["ns_per_contact_step"] / own["ns_per_contact_step"], 10.0, False,
            ),
            Goal(f"{what}, LAMMPS over ratd, with long steps", "times", other["hours"] / long["hours"], 100.0, False),
            Goal(f"growth of a cluster of {own['monomers']}", "s", own["growth_seconds"], 2.0, True),
        ]  # fmt: skip
    shot = frame(out, "collision")
    if shot is not None:
        met = shot[(shot["code"] == "ratd") & (shot["friction"] == "velocity")].iloc[0]
        what = f"collision of {met['spheres']:.0f} MRN spheres"
        found.append(Goal(what, "ns per contact and step", met["ns_per_contact_step"], 25.0, True))
        for row, most in zip(shot[shot["code"].isna()].itertuples(), (3.0, 120.0), strict=True):
            found.append(Goal(row.what, "s", row.seconds, most, True))
    if overhead is not None:
        share = 1.0 - overhead["seconds_of_work"].sum() / overhead["seconds_of_pipeline"].sum()
        largest = overhead["size_nm"].max()
        found.append(Goal(f"pipeline, sizes up to {largest:g} nm: not work", "%", 100.0 * share, 10.0, True))
    if growth is not None:
        paper_sized = growth[growth["monomers"] <= 3000]
        peak = paper_sized["peak_bytes"].max() / 1e6
        found.append(Goal("memory of a job, up to 3000 monomers", "MB", peak, 400.0, True))
    return found


def _by_number(data):
    """Whether many monomers cost no more than fewer, for each type that was grown with two numbers, list of Goal."""
    found = []
    kind = data["aggregate"].str.extract(r"^(\w+) of \d+$")[0]
    for name, case in data.groupby(kind, sort=False):
        cost = case.groupby("monomers")["ns_per_contact_step"].median()
        few, many = cost.index.min(), cost.index.max()
        what = f"{many} monomers over {few}, {name}"
        found.append(Goal(what, "times the time of a step and contact", cost[many] / cost[few], 1.0, True))
    return found
