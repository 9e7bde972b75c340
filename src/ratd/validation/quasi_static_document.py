"""docs/quasi_static.md and its figures, drawn from the tables of two checks beside them.

python -m ratd.validation.quasi_static_document collect RESULTS    take the tables, such as results/validation/full
python -m ratd.validation.quasi_static_document redraw             figures and text, in seconds
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

from ratd.base.errors import FileError
from ratd.base.measured import Measured, geometric_mean, median
from ratd.base.statistics import median_of
from ratd.base.units import NM
from ratd.experiments.spin_up.cells import GRAIN, TYPES, joined
from ratd.experiments.spin_up.figures.style import TYPE_MARKER
from ratd.experiments.spin_up.findings.scheme import paired
from ratd.experiments.spin_up.grain_table import spun_up_files, spun_up_table
from ratd.experiments.spin_up.run_files import read_table
from ratd.pictures.style import GREY, TWO_COLUMNS, TYPE_COLOUR, new_figure, save, styled
from ratd.pipeline.atomic import atomic, write_text
from ratd.pipeline.documents import command, fill
from ratd.validation import remnant
from ratd.validation.findings import decided
from ratd.validation.quasi_static import MARKS, PRODUCTION, shifts

__all__ = ["collect", "findings", "main", "redraw"]

DATA = Path("docs/quasi_static/data")
FIGURES = Path("docs/quasi_static")
TEMPLATE = Path("docs/templates/quasi_static.md")
DOCUMENT = Path("docs/quasi_static.md")
CHECKS = ("quasi_static", "remnant")
ENSEMBLE = Path("docs/reproduction/data/spun_up/prescribed")
BEFORE = DATA / "without_waiting.nc"
"""The grains as the queue of spin-ups finds them, and as they were found by spin-ups that do not wait."""
CLASSES = {"100 to 200 nm": (0, 250), "300 nm": (250, 400), "450 nm": (400, 600)}
"""Size classes [nm]."""
SIZES = {"small": (0, 225), "middle": (225, 425), "large": (425, 600)}
"""Classes of size of the ensemble [nm]."""
SHOWN = {
    ("stretch", 8e-14): "stretch 0.08 pm",
    ("stretch", 4e-14): "stretch 0.04 pm",
    ("stretch", 1e-14): "stretch 0.01 pm",
    ("pace", 0.005): "pace 0.005",
    ("drag", 0.3): "drag 0.3",
    ("longest", 1e-9): "longest step 1 ns",
    ("displacement", 1e-10): "step moves 0.1 nm",
    ("moved", 1.0): "start moved 1 pm",
    ("integrator", 1.0): "explicit step",
    ("epsilon", 0.001): "no wait, ε 0.001",
    ("unwaiting", 1.0): "no wait, but drag",
    ("drive", 1.0): "torque",
}
"""What is changed, with its name on the figure; the names of its slots begin with both."""
ARMS = (("stretch", 1e-14), ("stretch", 5e-15), ("unrest", 0.005), ("pace", 0.005))
KNOWN = 0.01
"""Error of the median of a class that tells something of 1 %."""
SEEN = np.radians(1.0)
"""A tilt [rad] that is more than the grain's being out of shape."""
OF_SCHEME = ("stretch", "pace", "drag", "longest", "displacement")
STEADY = (*(pair for pair in SHOWN if pair[0] in OF_SCHEME), ("stretch", 5e-15), ("unrest", 0.005))
"""Numbers of the scheme, on which the marks must not depend."""
EARLIER = 0.05
"""Part by which a first loss that is earlier than ours is told."""
EARLY = 0.7
"""Part of the cut bound below which `python -m benchmarks profile` counts work."""
ENOUGH = 5
"""Grains of a class whose median has an error; of three a bootstrap gives none."""


def collect(results, data=DATA):
    """Copy the tables of a folder of results of the validation."""
    for check in CHECKS:
        source = Path(results, f"{check}.csv")
        if not source.is_file():
            raise FileError(f"{source}: is missing; `snakemake --cores 2 {source}` makes it")
        with atomic(Path(data, source.name)) as temporary:
            pd.read_csv(source).to_csv(temporary, index=False, float_format="%.7g")


def redraw(folder=".", into=None):
    """Write the document and its figures, into another folder where one is given."""
    folder = Path(folder)
    into = folder if into is None else Path(into)
    table, looks = (pd.read_csv(folder / DATA / f"{check}.csv") for check in CHECKS)
    save(strips(table), into / FIGURES / "numbers.png")
    save(turning(looks), into / FIGURES / "remnant.png")
    values = findings(table, looks)
    if any((folder / ENSEMBLE).glob("*.nc")):
        files = spun_up_files(folder / ENSEMBLE)
        values |= against(spun_up_table(files), read_table(folder / BEFORE))
        values["ensemble.smaller_steps"] = sum(int((file["smaller_steps"] > 0).sum()) for file in files)
    template = (folder / TEMPLATE).read_text(encoding="utf-8")
    write_text(into / DOCUMENT, fill(template, values, str(TEMPLATE)))


def findings(table, looks):
    """Values of the slots.

    Parameters
    ----------
    table, looks : pandas.DataFrame
        Rows of the checks quasi_static and remnant.

    Returns
    -------
    dict
        Name of a slot -> number or text.
    """
    table = table.assign(a_eff=table["a_eff"].round(12))
    own = table[table["vary"] == PRODUCTION].drop_duplicates(GRAIN)
    values = {
        "grains": len(own),
        "runs": len(table.drop_duplicates([*GRAIN, "vary", "value"])),
        "failed": int(table["outcome"].str.startswith("failed").sum()),
        "smaller_steps": int((table["smaller_steps"] > 0).sum()),
    }
    for kind in TYPES:
        values[f"large {kind}"] = int(((own["type"] == kind) & (own["a_eff"] > 400 * NM)).sum())
    every = shifts(table)
    for row in every.to_dict("records"):
        if (row["vary"], row["value"]) in SHOWN:
            values[f"{row['vary']} {row['value']:g} {row['type']} {row['mark']}"] = _text(row)
    size_class = pd.cut(table["a_eff"] / NM, [0, *(high for _, high in CLASSES.values())], labels=list(CLASSES))
    table = table.assign(size_class=size_class)
    of_scheme = table[["vary", "value"]].apply(tuple, axis=1).isin(STEADY) | (table["vary"] == PRODUCTION)
    every_class = shifts(table[of_scheme], by=("type", "size_class"))
    # where all three types were run: a pool without one of them says nothing of all
    types = table.groupby(["vary", "value", "size_class"], dropna=False, observed=True)["type"].transform("nunique")
    all_types = of_scheme & ((types == len(TYPES)) | (table["vary"] == PRODUCTION))
    together = shifts(table[all_types], marks=("omega_mass_75",), by=("size_class",))
    values["together"] = (together["median"] - 1.0).abs().max()
    values["together known"] = together["error"].max()
    known = (every_class["error"] < KNOWN) & (every_class["n"] >= ENOUGH)
    fine = every_class[known]
    for mark in MARKS:
        part = fine[fine["mark"] == mark]
        values[f"classes {mark}"] = len(part)
        off = (part["median"] - 1.0).abs()
        worst = part.loc[off.idxmax()]
        values[f"worst {mark}"] = Measured(off.max(), worst["error"])
        each = [Measured(*row) for row in part[["median", "error"]].itertuples(index=False)]
        values[f"sure {mark}"] = sum(decided([one], KNOWN) == "met" for one in each)
        values[f"verdict {mark}"] = decided(each, KNOWN)
    unsure = every_class[(every_class["mark"] == "omega_mass_75") & ~known]
    values["few"] = int((unsure["n"] < ENOUGH).sum())
    farthest = unsure.loc[(unsure["median"] - 1.0).abs().idxmax()]
    three = paired(table[table["size_class"] == farthest["size_class"]], own, farthest["vary"], farthest["value"])
    three = three[three["type"] == farthest["type"]]
    off = np.sort((three["omega_mass_75"] / three["omega_mass_75_own"] - 1.0).dropna())
    values["unsure each"] = ", ".join(f"{100.0 * each:.0f} %".replace("-", "−") for each in off)
    ba = paired(table[is_hard(table)], own, "stretch", 1e-14)
    values["BA differ"] = ((ba["omega_mass_75"] / ba["omega_mass_75_own"] - 1.0).abs() > 0.01).mean()
    values["all classes"] = int((every_class["mark"] == "omega_mass_75").sum())
    values["steady"] = (
        "do not depend"
        if max(values["worst omega_first_loss"].value, values["worst omega_mass_75"].value) < 0.01
        else "depend"
    )
    values |= _means(table, own) | _single(table) | _same(table, own)
    values |= _arms(table, own) | _steps(own) | _torque(table, own) | _slow(table, own) | _remnants(looks)
    return values


def against(now, before):
    """Values of the slots on the ensemble, over that of spin-ups that do not wait, grain by grain.

    Parameters
    ----------
    now, before : pandas.DataFrame
        As `ratd.experiments.spin_up.grain_table.grain_table` makes them.

    Returns
    -------
    dict
    """
    pairs = joined(now, before, MARKS, suffix="_before")
    values = {"ensemble.grains": len(now), "ensemble.pairs": len(pairs)}
    values["ensemble.unfinished"] = int((now["end_reason"] != "one contact left").sum())
    for kind in TYPES:
        early = now.loc[now["type"] == kind, ["omega_first_loss", "cut_bound"]]
        values[f"ensemble.{kind} early"] = (early["omega_first_loss"] < EARLY * early["cut_bound"]).mean()
        for name, (low, high) in SIZES.items():
            part = pairs[(pairs["type"] == kind) & pairs["a_eff"].between(low * NM, high * NM)]
            for mark in MARKS:
                ratio = part[mark] / part[f"{mark}_before"]
                values[f"ensemble.{kind} {name} {mark}"] = _text(median_of(ratio))
                values[f"ensemble.{kind} {name} mean {mark}"] = geometric_mean(ratio)
    return values


def _text(row):
    """Median of ratios with its error, where two thirds of them lie, and how many there are."""
    error = " ± < 0.0001" if row["error"] < 5e-5 else f" ± {row['error']:.4f}" if row["n"] > 2 else ""
    return f"{row['median']:.4f}{error} ({row['low']:.3f}–{row['high']:.3f}; {row['n']})"


def _steps(own):
    """Where the steps go."""
    values = {}
    for kind, part in own.groupby("type"):
        large = part[part["a_eff"] > 400 * NM]
        values[f"steps {kind}"] = f"{large['steps'].median():,.0f}".replace(",", " ")
        values[f"steps until quarter {kind}"] = (large["steps_mass_75"] / large["steps"]).median()
    return values


def is_hard(table):
    """Whether grains are BA of 300 nm and above, the hard case, (n,) of bool."""
    return (table["type"] == "BA") & (table["a_eff"] > 250 * NM)


def is_fluffy(table):
    """Whether grains are BA of 300 nm, of which there are many, (n,) of bool."""
    return (table["type"] == "BA") & np.isclose(table["a_eff"], 300 * NM, atol=0.0)


def _means(table, own):
    """Geometric means of all types together, and the farthest that a number of the scheme moves them.

    ``mean farthest MARK`` of all types together, ``mean farthest TYPE MARK`` of one, ``mean hard VARY VALUE MARK`` of
    BA of 300 nm.
    """
    values, steady = {}, {mark: [] for mark in MARKS}
    for vary, value in (*SHOWN, ("epsilon", 0.004), ("unwaiting", 0.1)):
        pairs = paired(table, own, vary, value)
        for mark in MARKS:
            found = geometric_mean(pairs[mark] / pairs[f"{mark}_own"])
            values[f"mean {vary} {value:g} {mark}"] = found
            if (vary, value) in STEADY:
                steady[mark].append(found)
        values[f"mean {vary} {value:g} grains"] = len(pairs)
    for vary, value in STEADY:
        pairs = paired(table, own, vary, value)
        hard = pairs[is_fluffy(pairs)]
        for mark in MARKS:
            ratio = pairs[mark] / pairs[f"{mark}_own"]
            for kind in TYPES:
                part = ratio[(pairs["type"] == kind) & ratio.notna()]
                if len(part) >= ENOUGH:
                    steady.setdefault(f"{kind} {mark}", []).append(geometric_mean(part))
            found = (hard[mark] / hard[f"{mark}_own"]).dropna()
            if len(found) >= ENOUGH:
                values[f"mean hard {vary} {value:g} {mark}"] = geometric_mean(found)
    for name, means in steady.items():
        farthest = max(means, key=lambda found: abs(found.value - 1.0))
        values[f"mean farthest {name}"] = Measured(abs(farthest.value - 1.0), farthest.error)
    return values


def _single(table):
    """How far one in six grains of the hard case is off at least, with a weak drag and with what else does most."""
    hard = table[is_hard(table)]
    own = hard[hard["vary"] == PRODUCTION].drop_duplicates(GRAIN)
    far = {}
    for vary, value in STEADY:
        pairs = paired(hard, own, vary, value)
        off = (pairs["omega_mass_75"] / pairs["omega_mass_75_own"] - 1.0).abs().dropna()
        if len(off) >= ENOUGH:
            rng = np.random.default_rng(0)
            drawn = [np.quantile(rng.choice(off, len(off)), 5.0 / 6.0) for _ in range(1000)]
            far[vary, value] = Measured(off.quantile(5.0 / 6.0), float(np.std(drawn))), len(off)
    drag, grains = far.pop(("drag", 0.3))
    worst, others = max(far.values(), key=lambda found: found[0].value)
    return {"single drag": drag, "single drag grains": grains, "single": worst, "single grains": others}


def _same(table, own):
    """Share of the BAM grains that lose a quarter within 0.1 %, whatever number of the scheme is changed."""
    pairs = pd.concat(paired(table, own, *pair) for pair in STEADY)
    off = (pairs["omega_mass_75"] / pairs["omega_mass_75_own"] - 1.0).abs()
    return {"BAM same": (off[(pairs["type"] != "BA") & off.notna()] < 1e-3).mean()}


def _arms(table, own):
    """BA grains of 300 nm, the hard case."""
    values = {}
    for vary, value in ARMS:
        pairs = paired(table, own, vary, value)
        pairs = pairs[is_fluffy(pairs)]
        for mark in ("first_loss", "mass_75"):
            ratios = pairs[f"omega_{mark}"] / pairs[f"omega_{mark}_own"]
            values[f"arms.{vary} {value:g} {mark}"] = _text(median_of(ratios))
        values["arms.grains"] = max(values.get("arms.grains", 0), len(pairs))
    return values


def _torque(table, own):
    """omega, L and shape under a torque over those under a prescribed omega."""
    pairs = paired(table, own, "drive", 1.0)
    values = {}
    for kind, part in pairs.groupby("type"):
        values[f"torque {kind} omega_disr"] = _text(median_of(part["omega_disr"] / part["omega_disr_own"]))
        for mark in ("first_loss", "mass_75"):
            omega, momentum, ratio = (
                part[f"{name}_{mark}"] / part[f"{name}_{mark}_own"]
                for name in ("omega", "angular_momentum", "axis_ratio")
            )
            for name, ratios in (("omega", omega), ("L", momentum), ("shape", ratio)):
                values[f"torque {kind} {mark} {name}"] = _text(median_of(ratios))
    pairs = pairs[np.isfinite(pairs["omega_mass_75"] * pairs["omega_mass_75_own"])]
    omega = pairs["omega_mass_75"] / pairs["omega_mass_75_own"]
    yielding = pairs["axis_ratio_mass_75"] / pairs["axis_ratio_mass_75_own"]
    found = median(omega)
    values["torque change"] = Measured(abs(found.value - 1.0), found.error)
    hard = is_fluffy(pairs)
    values["torque hard"] = median(omega[hard])
    values["torque same"] = ((omega - 1.0).abs() < 0.02).mean()
    values["torque higher"] = (omega > 1.02).mean()
    values["torque stretched"] = _text(median_of(yielding[omega > 1.02]))
    values["torque lower"] = (omega < 0.98).mean()
    chaos = paired(table, own, "moved", 1.0)
    moved = chaos["omega_mass_75"] / chaos["omega_mass_75_own"]
    values["moved hard"] = ((moved[is_hard(chaos)] - 1.0).abs() > 0.01).mean()
    values["moved differs"] = ((moved.dropna() - 1.0).abs() > 0.02).mean()
    return values


def _slow(table, own):
    """Beside spin-ups that do not wait and the explicit step, of all types together, and a quarter of each."""
    values = {}
    for vary, value in (
        ("integrator", 1.0), ("epsilon", 0.004), ("epsilon", 0.001), ("unwaiting", 1.0), ("unwaiting", 0.1),
    ):  # fmt: skip
        pairs = paired(table, own, vary, value)
        for mark in MARKS:
            values[f"{vary} {value:g} {mark}"] = _text(median_of(pairs[mark] / pairs[f"{mark}_own"]))
        values[f"{vary} {value:g} grains"] = len(pairs)
        off = pairs["omega_mass_75"] / pairs["omega_mass_75_own"]
        values[f"{vary} {value:g} range"] = f"{off.min():.2f} to {off.max():.2f}"
        values |= {f"{vary} {value:g} {kind}": median(part) for kind, part in off.groupby(pairs["type"])}
        first = (pairs["omega_first_loss"] / pairs["omega_first_loss_own"])[pairs["type"] == "BAM2"]
        lower = 1.0 - first[first < 1.0 - EARLIER]
        values[f"{vary} {value:g} BAM2 first"] = f"{len(lower)} of {len(first)}"
        if len(lower):
            values[f"{vary} {value:g} BAM2 earlier"] = f"{100.0 * lower.min():.0f} to {100.0 * lower.max():.0f} %"
        values[f"{vary} {value:g} steps"] = (pairs["steps"] / pairs["steps_own"]).median()
    return values


def _remnants(looks):
    """How far remnants stand off their axis, and how soon that is over."""
    events = remnant.events(looks)
    values = {"remnant grains": len(looks.groupby(["type", "seed"]))}
    for drag, part in events.groupby("drag"):
        seen = part[part["turns"].notna() & (part["tilt"] > SEEN)]
        values[f"remnant {drag:g} events"] = len(part)
        values[f"remnant {drag:g} seen"] = len(seen)
        values[f"remnant {drag:g} tilt"] = np.degrees(part["tilt"].median())
        values[f"remnant {drag:g} greatest"] = np.degrees(part["tilt"].max())
        values[f"remnant {drag:g} turns"] = seen["turns"].median()
        values[f"remnant {drag:g} turns high"] = seen["turns"].quantile(0.84)
    quiet = looks[(looks["drag"] == 1.0) & (looks["roundness"] < 0.95)]
    values["remnant tilt at rest"] = np.degrees(quiet["tilt"].median())
    return values


@styled
def strips(table):
    """Figure: every grain with one thing changed, over itself, for the loss of a quarter of the mass."""
    figure = new_figure(TWO_COLUMNS, 0.62 * TWO_COLUMNS, "The same grains with one thing changed (bars: medians)")
    axes = figure.subplots()
    table = table.assign(a_eff=table["a_eff"].round(12))
    own = table[table["vary"] == PRODUCTION].drop_duplicates(GRAIN)
    names = list(SHOWN.values())
    for place, (vary, value) in enumerate(SHOWN):
        pairs = paired(table, own, vary, value)
        ratios = pairs["omega_mass_75"] / pairs["omega_mass_75_own"]
        for shift, kind in zip((-0.24, 0.0, 0.24), TYPES, strict=True):
            part = np.sort(ratios[pairs["type"] == kind].dropna())
            height = place + shift + 0.09 * np.sin(2.4 * np.arange(len(part)))
            axes.plot(
                100 * (part - 1), height, TYPE_MARKER[kind], color=TYPE_COLOUR[kind], markersize=2.5, alpha=0.6,
                linestyle="none", label=kind if place == 0 else None, clip_on=False,
            )  # fmt: skip
            if len(part):
                axes.plot(100 * (np.median(part) - 1), place + shift, "|", color="black", markersize=9)
    axes.axvline(0.0, color=GREY, linewidth=0.6, zorder=0)
    axes.set_xscale("symlog", linthresh=1.0)
    ticks = [-50, -10, -1, -0.5, 0, 0.5, 1, 10, 50]
    axes.set_xticks(ticks, [f"{tick:+g}".replace("-", "\N{MINUS SIGN}") if tick else "0" for tick in ticks])
    axes.minorticks_off()
    axes.set_xlim(-60, 90)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("change of $\\omega$ at which a quarter of the mass is lost [%]; linear between −1 and 1")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


@styled
def turning(looks):
    """Figure: one grain that loses mass, and how far its axis of greatest inertia stands off."""
    key = ["type", "seed"]
    events = remnant.events(looks)
    seen = events[(events["drag"] == 1.0) & events["turns"].notna() & (events["tilt"] > 10 * SEEN)]
    counts = (seen if len(seen) else events).groupby(key).size()
    kind, seed = counts.idxmax()
    figure = new_figure(TWO_COLUMNS, 0.5 * TWO_COLUMNS, f"What is left of a {kind} grain turns into its own axis")
    above, below = figure.subplots(2, 1, sharex=True)
    for drag, look in ((1.0, {"color": "black"}), (0.3, {"color": GREY, "ls": (0, (3, 1)), "lw": 1.2})):
        run = looks[(looks["type"] == kind) & (looks["seed"] == seed) & (looks["drag"] == drag)]
        if not len(run):
            continue
        label = f"drag $c$ = {drag:g}"
        above.plot(run["turns"], 100 * run["mass_fraction"], drawstyle="steps-post", label=label, **look)
        below.plot(run["turns"], np.degrees(run["tilt"]), **look)
    above.set_ylabel("mass left [%]")
    above.set_ylim(0, 104)
    below.set_ylabel("tilt [°]")
    below.set_ylim(0, None)
    below.set_xlabel("turns since the first loss of mass")
    figure.legend(*above.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def main(words):
    """The command line; returns the exit code."""
    return command(words, __doc__, collect, redraw)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
