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
    machine : str
        That it was measured on.
    """

    what: str
    unit: str
    value: float
    limit: float
    greatest: bool
    low: float | None = None
    high: float | None = None
    machine: str = ""

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
    found = []
    for name, judge in _JUDGES.items():
        data = frame(out, name)
        if data is not None:
            machine = data["machine"].iloc[0] if "machine" in data else ""
            found += [goal._replace(machine=machine) for goal in judge(data)]
    return found


def _kernel(data):
    found = []
    for (name, motion), case in data.groupby(["aggregate", "motion"], sort=False):
        own = case.loc[case["code"] == "ratd", "ns_per_contact_step"].median()
        found.append(
            Goal(f"kernel, {name} {motion}", "ns per contact and step", own, MOST_NS.get(name, OF_FILES), True)
        )
        ratio = pair_ratios(case)
        if len(ratio):
            found.append(Goal(f"LAMMPS over ratd, {name} {motion}", "times", float(np.median(ratio)), 10.0, False))
    return found


def _small(data):
    slowest = data.groupby(["aggregate", "motion"])["us_per_step"].median().max()
    return [Goal(f"a step of {data['monomers'].iloc[0]} monomers, slowest case", "us", slowest, 1.5, True)]


def _growth(data):
    largest = data[data["size_nm"] == data["size_nm"].max()]
    name = f"growth of a grain of {largest['size_nm'].iloc[0]:g} nm, slowest"
    return [Goal(name, "s", largest["growth_seconds"].max(), 0.5, True)]


def _paper(data):
    found = []
    for row in data.itertuples():
        law = f"drive {row.drive}, {row.pace}, f = {row.timestep_factor:g}"
        found.append(
            Goal(f"{row.grains} grains, {law}", "core-hours", row.core_hours, 48.0, True, *projected_range(row))
        )
    return found


def _answer(data):
    # what was run is faster than the goal asks for, and its answer is off
    epsilon = data["epsilon"].min()
    least = min(ratios(data).values())
    what = f"least type, projected from {least * SLOW / epsilon:.3g} times at epsilon = {epsilon:.2g} to {SLOW:g}"
    return [Goal(f"LAMMPS over ratd, time to omega at 25 % mass loss, {what}", "times", least, 300.0, False)]


def _compression(data):
    largest = data[data["monomers"] == data["monomers"].max()].set_index("code")
    own, other = largest.loc["ratd, explicit"], largest.loc["LAMMPS"]
    what = f"compression of {own['monomers']} monomers"
    ratio = other["ns_per_contact_step"] / own["ns_per_contact_step"]
    found = [
        Goal(f"{what}, explicit", "ns per contact and step", own["ns_per_contact_step"], 20.0, True),
        Goal(f"{what}, LAMMPS over ratd, step by step", "times", ratio, 10.0, False),
    ]
    if "ratd, long steps" in largest.index:
        hours = largest.loc["ratd, long steps", "hours"]
        found.append(Goal(f"{what}, LAMMPS over ratd, with long steps", "times", other["hours"] / hours, 100.0, False))
    found.append(Goal(f"growth of a cluster of {own['monomers']}", "s", own["growth_seconds"], 2.0, True))
    return found


def _collision(data):
    codes = data[data["code"].notna()].set_index(["code", "friction"])
    own = codes.loc[("ratd", "velocity")]
    what = f"collision of {own['spheres']:.0f} MRN spheres"
    found = [Goal(what, "ns per contact and step", own["ns_per_contact_step"], 25.0, True)]
    for row, most in zip(data[data["code"].isna()].itertuples(), (3.0, 120.0), strict=True):
        found.append(Goal(row.what, "s", row.seconds, most, True))
    return found


def _pipeline(data):
    share = 1.0 - data["seconds_of_work"].sum() / data["seconds_of_pipeline"].sum()
    largest = data["size_nm"].max()
    return [Goal(f"pipeline, sizes up to {largest:g} nm: not work", "%", 100.0 * share, 10.0, True)]


def _memory(data):
    peak = data.loc[data["monomers"] <= 3000, "peak_bytes"].max() / 1e6
    return [Goal("memory of a job, up to 3000 monomers", "MB", peak, 400.0, True)]


def _by_number(data):
    """Whether many monomers cost no more than fewer, for each type that was grown with two numbers."""
    data, found = data[data["code"] == "ratd"], []
    kind = data["aggregate"].str.extract(r"^(\w+) of \d+$")[0]
    for name, case in data.groupby(kind, sort=False):
        cost = case.groupby("monomers")["ns_per_contact_step"].median()
        few, many = cost.index.min(), cost.index.max()
        what = f"{many} monomers over {few}, {name}"
        found.append(Goal(what, "times the time of a step and contact", cost[many] / cost[few], 1.0, True))
    return found


_JUDGES = {
    "kernel": _kernel,
    "combinations": _by_number,
    "small": _small,
    "cost_runs": _growth,
    "cost_paper": _paper,
    "answer": _answer,
    "compression": _compression,
    "collision": _collision,
    "pipeline": _pipeline,
    "scaling": _memory,
}
"""Name of a table -> the goals that it is judged by, a list of Goal."""
