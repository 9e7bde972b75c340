"""docs/collision.md and its appendix: the values of their slots; `.claims` has what their sentences say."""

from pathlib import Path

import numpy as np
from scipy.stats import ttest_ind

from ratd.aggregates.mrn import SMALLEST, moment_of_length
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.base.measured import quotient
from ratd.base.units import NM
from ratd.experiments.collision.claims import claims
from ratd.experiments.collision.document_plan import figure_settings
from ratd.experiments.collision.document_samples import (
    at_own_v_frag,
    by_sample,
    change_by,
    halved,
    largest,
    of_same_samples,
    radius_by_half,
    samples_of_the_law,
    with_and_without,
)
from ratd.experiments.collision.document_texts import moment_text, radius_text, with_error
from ratd.experiments.collision.fragmentation import (
    STICKING,
    crossings,
    fragmentation_velocities,
    fragmentation_velocity,
    mean_and_error,
    means,
)
from ratd.experiments.collision.likeness import is_equal, likeness_table
from ratd.experiments.collision.printed import PRINTED_THRESHOLDS, RADII
from ratd.experiments.collision.tables import threshold_error
from ratd.experiments.collision.thresholds import head_on, is_close, of_paper, of_same_energy
from ratd.laws.dmt_with_friction import PERIOD_PARTS
from ratd.pipeline import io
from ratd.pipeline.documents import fill

__all__ = ["document", "values"]

COLUMNS = (
    "X", "N_s", "X_rest", "N_s_rest", "X_early", "N_s_early", "energy_half", "energy_end", "by_damping", "by_sliding",
    "by_rolling", "by_twisting", "single_share", "large_share", "largest_share", "joined", "potential_share",
    "n_pieces",
)  # fmt: skip


NEAR_CEILING = 0.85
"""Part of what N_s cannot exceed from which on it says more of the largest sphere than of fragmentation."""
SMALLEST_OF = {"mrn": SMALLEST, "mrn100": 100 * NM}
"""Least radius [m] of clusters of the MRN law, up to 2.5 um all."""
SAME = ("longer", "half_step")
"""Laws under which some of the collisions of the law "velocity" were done once more."""


def values(table, thresholds, likeness):
    """Values of all slots that there can be, dict of str to str.

    Parameters
    ----------
    table, thresholds, likeness : pandas.DataFrame
        Of `ratd.experiments.collision.tables.findings`.

    Returns
    -------
    dict of str to str
        ``X velocity mrn100 30``: mean and error of a column at a velocity; ``n ...``: how many collisions;
        ``v_frag velocity 570nm``: the fragmentation velocity; both with ``... b0.3`` for an impact parameter;
        ``v_stick``, ``ratio`` (of the two), ``energy`` (E_0/(N E_break)) likewise; ``radius velocity mrn100 X`` and
        ``q ...``: the equal spheres that a cluster is like; and some totals.
    """
    found = {}
    for (law, cluster, velocity, impact), part in table.groupby(["law", "cluster", "velocity", "impact_parameter"]):
        key = f"{law} {cluster} {velocity:g}" + _off_centre(impact)
        found[f"n {key}"] = str(len(part))
        for column in COLUMNS:
            found[f"{column} {key}"] = with_error(*mean_and_error(part, column))
    printed = {f"{radius / NM:.0f}nm": velocity for radius, velocity in PRINTED_THRESHOLDS.items()}
    for _, row in thresholds.iterrows():
        key = f"{row['law']} {row['cluster']}" + _off_centre(row["impact_parameter"])
        found[f"v_frag {key}"] = _threshold(row)
        found[f"collisions {key}"] = f"{row['collisions']:.0f}"
        found[f"v_stick {key}"] = with_error(row["sticking_velocity"], np.nan)
        stick = row["sticking_velocity"]
        found[f"ratio {key}"] = with_error(row["velocity"] / stick, row["error"] / stick, 1) if is_close(row) else "–"
        relative = 2.0 * row["error"] / row["velocity"]
        found[f"energy {key}"] = f"{row['energy_per_contact']:.2g} ± {relative:.0%}" if is_close(row) else "–"
        if row["law"] == "velocity" and row["cluster"] in printed:
            # it goes with the square of the velocity
            energy = row["energy_per_contact"] * (printed[row["cluster"]] / row["velocity"]) ** 2
            found[f"energy printed {row['cluster']}"] = f"{energy:.2g}"
    for _, row in likeness.iterrows():
        key = f"{row['law']} {row['cluster']} {row['quantity']}"
        found[f"radius {key}"] = radius_text(row)
        if row["cluster"] in SMALLEST_OF:
            found[f"q {key}"] = moment_text(row, SMALLEST_OF[row["cluster"]])
        found[f"misfit {key}"] = with_error(row["misfit"], np.nan)
        found[f"velocities {key}"] = f"{row['velocities']:.0f}"
    found |= by_sample(table, "velocity", "mrn") | with_and_without(table, COLUMNS) | largest(table)
    found |= samples_of_the_law() | of_same_samples(table) | _one_pair(table) | _same_collisions(table)
    found |= _calibrated(thresholds) | _first_fall(table, thresholds) | _exponents(thresholds) | _constants(table)
    found |= _recipe(table, thresholds) | at_own_v_frag(table, ("mrn", "353nm")) | _on_all_three(thresholds)
    found |= _by_v_frag(table, thresholds) | _below_ceiling(table) | _at_each_velocity(table)
    found |= halved(table) | radius_by_half(table, "mrn") | _late(table) | _shorter(table, "velocity", "mrn")
    found |= {
        "collisions": str((~table["law"].isin(SAME)).sum()),
        "collisions again": str(table["law"].isin(SAME).sum()),
        "worst balance velocity": f"{100 * table.loc[table['friction'] != 'spring', 'balance'].max():.1f} %",
        "worst balance spring": f"{100 * table.loc[table['friction'] == 'spring', 'balance'].max():.1f} %",
    }
    found |= {f"q of {radius * 1e6:g}": f"{moment_of_length(radius):.2f}" for radius in RADII}
    return found


def _off_centre(impact):
    """What stands behind a slot of collisions off centre."""
    return f" b{impact:g}" if impact else ""


def _calibrated(thresholds):
    """The damping time A at which v_frag of 0.57 um is the printed one, and what that predicts of the other two.

    ``A FRICTION``: A [ns] for the friction "velocity" or "spring"; ``predicted FRICTION 453nm``: v_frag [m/s]. Between
    the A that were tried v_frag is linear in the logarithms of both; errors are those of the v_frag.
    """
    found = {}
    own = of_same_energy(head_on(thresholds)).dropna(subset=["velocity"])
    for friction, part in own.groupby("friction"):
        curves = {name: one.sort_values("damping_time") for name, one in part.groupby("cluster")}
        known = curves.get("570nm")
        if friction not in ("velocity", "spring") or known is None:
            continue
        rng = np.random.Generator(np.random.PCG64(0))
        wanted = np.log(PRINTED_THRESHOLDS[RADII[-1]])
        speed, error = (known[name].to_numpy() for name in ("velocity", "error"))
        if len(known) < 2 or not (np.diff(speed) > 0.0).all() or not speed[0] < np.exp(wanted) < speed[-1]:
            continue
        time = np.log(known["damping_time"].to_numpy())
        drawn = np.log(speed * (1.0 + error / speed * rng.normal(size=(1000, len(speed)))))
        drawn = np.sort(drawn, axis=1)
        times = np.array([np.interp(wanted, row, time) for row in drawn])
        best = np.interp(wanted, np.log(speed), time)
        found[f"A {friction}"] = with_error(1e9 * np.exp(best), 1e9 * np.exp(best) * times.std(), 2)
        for name, other in curves.items():
            at = np.log(other["damping_time"].to_numpy())
            if name == "570nm" or len(other) < 2 or best > at[-1]:
                continue
            level = np.log(other["velocity"].to_numpy())
            spread = other["error"].to_numpy() / other["velocity"].to_numpy()
            several = [np.interp(time_drawn, at, level + spread * rng.normal(size=len(level))) for time_drawn in times]
            value = np.exp(np.interp(best, at, level))
            found[f"predicted {friction} {name}"] = with_error(value, value * np.std(several), 1)
    return found


def _on_all_three(thresholds):
    """``A common``: damping time [ns] that fits all three printed v_frag best; ``common 570nm``: v_frag there [m/s].

    ``A alone 570nm``: damping time [ns] at which a power law has the printed v_frag of one radius.

    v_frag of each radius is a power of the damping time, fitted to all that were tried, by their errors; ``common
    off``: by how much the worst of the three is off.
    """
    own = of_same_energy(head_on(thresholds)).dropna(subset=["velocity", "error"])
    own = own[(own["friction"] == "velocity") & (own["error"] > 0.0)]
    lines, printed = {}, {}
    for radius, speed in PRINTED_THRESHOLDS.items():
        name = f"{radius / NM:.0f}nm"
        part = own[own["cluster"] == name]
        if len(part) < 2:
            return {}
        weights = (part["velocity"] / part["error"]).to_numpy()
        time, level = (np.log(part[column].to_numpy()) for column in ("damping_time", "velocity"))
        lines[name], printed[name] = np.polyfit(time, level, 1, w=weights), np.log(speed)
    slopes, heights = np.array(list(lines.values())).T
    best = np.sum(slopes * (np.array(list(printed.values())) - heights)) / np.sum(slopes**2)
    found = {f"common {name}": f"{np.exp(np.polyval(line, best)):.1f}" for name, line in lines.items()}
    off = max(abs(np.expm1(np.polyval(line, best) - printed[name])) for name, line in lines.items())
    for name, (slope, height) in lines.items():
        found[f"A alone {name}"] = f"{1e9 * np.exp((printed[name] - height) / slope):.2f}"
    return found | {"A common": f"{1e9 * np.exp(best):.2f}", "common off": f"{100.0 * off:.0f} %"}


def _one_pair(table):
    """Values of single rotations of the first sample: ``first X velocity mrn 30``, ``shown ...`` for that of Fig. 4."""
    central = table[(table["impact_parameter"] == 0) & (table["sample"] == 1)]
    found = {}
    for name, seed in {"first": 0, "shown": figure_settings("figure4")["rotation"]}.items():
        for row in central[central["seed"] == seed].to_dict("records"):
            key = f"{row['law']} {row['cluster']} {row['velocity']:g}"
            found |= {f"{name} {column} {key}": with_error(row[column], np.nan) for column in COLUMNS}
    return found


def _v_frag_of_samples(table):
    """v_frag [m/s] of each sample of MRN and of 0.353 um, central collisions with rate friction, (k,) arrays."""
    central = table[(table["law"] == "velocity") & (table["impact_parameter"] == 0)]
    return [fragmentation_velocities(central[central["cluster"] == name]) for name in ("mrn", "353nm")]


def _recipe(table, thresholds):
    """``too low``: by how much of v_frag of MRN that of the recipe's 0.353 um is too low, rate friction.

    ``too low speed``: the same in m/s, and ``too low errors`` over its error; ``too low chance``: in one case of how
    many two sets of samples whose v_frag are alike lie so far apart (Welch's t).
    """
    own = thresholds[(thresholds["law"] == "velocity") & (thresholds["impact_parameter"] == 0)].set_index("cluster")
    if not {"mrn", "353nm"} <= set(own.index):
        return {}
    (true, error), (equal, other) = (own.loc[name, ["velocity", "error"]] for name in ("mrn", "353nm"))
    ratio, spread = quotient((equal, other), (true, error))
    gap, wide = true - equal, np.hypot(error, other)
    chance = ttest_ind(*_v_frag_of_samples(table), equal_var=False).pvalue
    return {
        "too low chance": f"{1.0 / chance:.0f}",
        "too low": f"{100 * (1 - ratio):.0f} ± {100 * spread:.0f} %",
        "too low speed": with_error(gap, wide, 1),
        "too low errors": f"{gap / wide:.1f}",
    }


def _by_v_frag(table, thresholds):
    """``radius velocity mrn v_frag``: radius [nm] of the equal spheres that have the v_frag of MRN, rate friction.

    v_frag of equal spheres is linear between the logarithms of both; one error, of both, to either side. ``by sample
    v_frag velocity mrn`` and ``... 353nm``: v_frag [m/s] of each sample.
    """
    own = thresholds[(thresholds["law"] == "velocity") & (thresholds["impact_parameter"] == 0)].set_index("cluster")
    names = [name for name in own.index if name.removesuffix("nm").isdigit()]
    equal = own.loc[names].dropna(subset="velocity").sort_values("velocity")
    found = {}
    if "mrn" in own.index and len(equal) > 1:
        rng = np.random.Generator(np.random.PCG64(0))
        true, error = own.loc["mrn", ["velocity", "error"]]
        speed, spread = equal["velocity"].to_numpy(), equal["error"].to_numpy()
        length = np.log(equal["radius"].to_numpy())

        def radius(velocity, of_equal):
            order = np.argsort(of_equal)
            return np.exp(np.interp(np.log(velocity), np.log(of_equal[order]), length[order])) / NM

        drawn = [radius(true + error * rng.normal(), speed + spread * rng.normal(size=len(speed))) for _ in range(2000)]
        low, high = np.quantile(drawn, [0.16, 0.84])
        found["radius velocity mrn v_frag"] = f"{radius(true, speed):.0f} ({low:.0f}–{high:.0f})"
    for name, each in zip(("mrn", "353nm"), _v_frag_of_samples(table), strict=True):
        found[f"by sample v_frag velocity {name}"] = ", ".join(f"{velocity:.1f}" for velocity in each)
    return found


def _below_ceiling(table):
    """``radius below LAW N_s``: what MRN is like by N_s where it is below `NEAR_CEILING` of what it cannot exceed.

    ``ceiling LAW 30``: N_s of MRN over the mean of what its collisions cannot exceed.
    """
    found = {}
    for law in ("velocity", "spring"):
        own = table[(table["law"] == law) & (table["impact_parameter"] == 0)]
        one = own[own["cluster"] == "mrn"].assign(ceiling=1.0 - own["largest_share"])
        part = {
            velocity: mean_and_error(at, "N_s")[0] / mean_and_error(at, "ceiling")[0]
            for velocity, at in one.groupby("velocity")
        }
        found |= {f"ceiling {law} {velocity:g}": f"{100 * share:.0f} %" for velocity, share in part.items()}
        below = [velocity for velocity, share in part.items() if share < NEAR_CEILING]
        rows = likeness_table(own[((own["cluster"] == "mrn") | is_equal(own)) & own["velocity"].isin(below)])
        for _, row in rows[(rows["cluster"] == "mrn") & (rows["quantity"] == "N_s")].iterrows():
            found[f"radius below {law} N_s"] = radius_text(row)
    return found


def _at_each_velocity(table):
    """``radius at velocity CLUSTER X 15``: radius [nm] of the equal spheres that a cluster is like at one velocity."""
    own = table[(table["law"] == "velocity") & (table["impact_parameter"] == 0)]
    one = own["cluster"] == "mrn100_to_800"
    found = {}
    for velocity in own.loc[one, "velocity"].unique():
        # the least bootstrap: its errors are not told
        rows = likeness_table(own[(one | is_equal(own)) & (own["velocity"] == velocity)], samples=2)
        for _, row in rows[rows["cluster"] == "mrn100_to_800"].iterrows():
            end = " (end of the range)" if row["at_end"] else ""
            key = f"radius at velocity {row['cluster']} {row['quantity']} {velocity:g}"
            found[key] = f"{row['radius'] / NM:.0f}{end}"
    return found


def _same_collisions(table):
    """What collisions that were done once more, under a law of `SAME`, had under the law "velocity".

    ``same X longer 353nm 20``, ``same v_frag longer 298nm``; ``change X longer 353nm 20``: by how much they changed.
    """
    alike = ["cluster", "velocity", "sample", "seed"]
    table = table[table["impact_parameter"] == 0]
    base = table[table["law"] == "velocity"]
    found = {}
    for law in SAME:
        own = base.merge(table.loc[table["law"] == law, alike])
        for (cluster, velocity), part in own.groupby(["cluster", "velocity"]):
            for column in ("X", "N_s"):
                key = f"{column} {law} {cluster} {velocity:g}"
                found[f"same {key}"] = with_error(*mean_and_error(part, column))
                pairs = change_by(law, table, column, cluster)
                found[f"change {key}"] = with_error(*mean_and_error(pairs[pairs["velocity"] == velocity], "change"))
        for cluster, part in own.groupby("cluster"):
            row = fragmentation_velocity(part)
            found[f"same v_frag {law} {cluster}"] = with_error(row["velocity"], threshold_error(row), 1)
    return found


def _first_fall(table, thresholds):
    """``A first velocity``: A [ns] as in `_calibrated` if X had to fall through its limit once, not for the last time.

    ``first v_frag velocity_2.0ns 570nm``: the v_frag [m/s] of that.
    """
    first, found = thresholds.copy(), {}
    central = table[table["impact_parameter"] == 0]
    for (law, cluster), part in central.groupby(["law", "cluster"]):
        velocity = crossings(*means(part, "X")[:2], STICKING)
        row = (first["law"] == law) & (first["cluster"] == cluster) & (first["impact_parameter"] == 0)
        if len(velocity):
            first.loc[row, "velocity"] = velocity[0]
            found[f"first v_frag {law} {cluster}"] = f"{velocity[0]:.1f}"
    known = _calibrated(first).get("A velocity")
    return found | ({} if known is None else {"A first velocity": known.split(" ")[0]})


def _late(table):
    """``late X LAW CLUSTER``: by how much the mean X of a velocity moves at most between 2 us and the end."""
    found = {}
    central = table[(table["impact_parameter"] == 0) & table["X_late"].notna()]
    for (law, cluster), part in central.groupby(["law", "cluster"]):
        moved = np.abs(means(part, "X")[1] - means(part, "X_late")[1])
        found[f"late X {law} {cluster}"] = f"{moved.max():.2f}"
    return found


def _shorter(table, law, cluster):
    """``shorter X LAW CLUSTER``: what rotations with the shortest step have more than others of their cells; ``n``."""
    own = table[(table["law"] == law) & (table["cluster"] == cluster) & (table["impact_parameter"] == 0)]
    short = np.isclose(own["timestep"], own["timestep"].min(), atol=0.0)
    cell = ["sample", "velocity"]
    found = {}
    for column in ("X", "N_s"):
        more = own[short].groupby(cell)[column].mean() - own[~short].groupby(cell)[column].mean()
        more = more.dropna()
        found[f"shorter {column} {law} {cluster}"] = with_error(more.mean(), more.std(ddof=1) / np.sqrt(len(more)))
        found[f"shorter n {law} {cluster}"] = str(len(more))
    return found


def _exponents(thresholds):
    """Powers with which v_frag and v_stick go with the radius, and at 0.57 um with the surface energy; A = 0.5 ns.

    The error of that of v_frag is the greater of two: of the errors of its velocities, and of how they lie about the
    line. v_stick is exact, and no power: the least and greatest slope between neighbours are told.
    """
    own = of_paper(head_on(thresholds))
    own = own[(own["friction"] == "velocity") & np.isclose(own["damping_time"], 0.5e-9, atol=0.0)]
    own = own.dropna(subset=["velocity", "sticking_velocity"])
    found = {}
    for name, x, part in (
        ("radius", "radius", of_same_energy(own)),
        ("energy", "surface_energy", own[np.isclose(own["radius"], RADII[-1])]),
    ):
        part = part.sort_values(x)
        at, speed = np.log(part[x].to_numpy()), part["velocity"].to_numpy()
        (power, _), cover = np.polyfit(at, np.log(speed), 1, cov=True)
        lever = (at - at.mean()) / np.sum((at - at.mean()) ** 2)
        known = np.sqrt(np.sum((lever * part["error"].to_numpy() / speed) ** 2))
        found[f"exponent {name}"] = with_error(power, max(known, np.sqrt(cover[0, 0])))
        slopes = np.sort(np.diff(np.log(part["sticking_velocity"].to_numpy())) / np.diff(at))
        found[f"exponent {name} stick"] = f"{slopes[0]:.2f} to {slopes[-1]:.2f}"
    return found


def _constants(table):
    """``constant NAME``: what silica and its contacts are in these collisions."""
    silica = MATERIALS["silica"]
    return {
        "constant Y": f"{silica.youngs_modulus / 1e9:g} GPa",
        "constant nu": f"{silica.poisson_number:g}",
        "constant rho": f"{silica.density:g} kg/m³",
        "constant gamma": f"{silica.surface_energy * 1e3:g} mJ/m²",
        "constant xi": f"{silica.critical_rolling_displacement / NM:g} nm",
        "constant A": f"{table.loc[table['law'] == 'velocity', 'damping_time'].iloc[0] * 1e9:g} ns",
        "constant tau": f"1/{PERIOD_PARTS:.0f}",
    }


def _threshold(row):
    """Text of a fragmentation velocity; where X stays on one side of the limit, on which."""
    if np.isfinite(row["velocity"]):
        # what lies between two velocities far apart is not known by a straight line between them
        if not is_close(row):
            return f"between {row['below']:g} and {row['above']:g}"
        return with_error(row["velocity"], row["error"], 1)
    return f"not between {row['slowest']:g} and {row['fastest']:g}"


def tables_of(files):
    """The three tables of a job, from its files."""
    kinds = {"table": "collision_table", "thresholds": "collision_thresholds", "likeness": "collision_likeness"}
    return [io.read(files[name], kind).to_dataframe() for name, kind in kinds.items()]


def document(files, settings, say):
    """The document of a job of the pipeline and its appendix: their templates, filled, if all `claims` hold."""
    tables = tables_of(files)
    wrong = [claim for claim, holds in claims(*tables).items() if not holds]
    if wrong:
        raise InputError(
            f"docs/collision.md says what the data no longer do: {'; '.join(wrong)}; read the sentences around these "
            "in its template and that of the appendix again, and mend them and ratd.experiments.collision.claims"
        )
    found = values(*tables)
    templates = {name: Path(files[f"{name}_template"]) for name in ("document", "appendix")}
    return {name: fill(path.read_text(encoding="utf-8"), found, str(path)) for name, path in templates.items()}
