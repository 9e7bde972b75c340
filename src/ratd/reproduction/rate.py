"""The one free number of the drive literal, d omega/dt: how it was fixed, and what it gives."""

import numpy as np

from ratd.calibration import PRINTED_STEP, printed_acceleration, same_rate, step_ratios
from ratd.drives import OMEGA_RAT
from ratd.ensemble import cell_of
from ratd.markdown import markdown_table, plural
from ratd.parameters import MARKS
from ratd.parameters import OWN as AS_IT_IS
from ratd.reproduction.bounds import (
    by_type_and_size,
    in_cell,
    median_and_range,
    ratios,
    same_grains,
    sizes_of,
    table3_omega,
    whole_nm,
)
from ratd.reproduction.paper import PRINTED
from ratd.reproduction.text import NOTHING, between, number, with_error
from ratd.solid import solid_omega
from ratd.statistics import equal_weights, median_of, quantiles, slope_error, slope_of

HOUR = 3600.0
"""Drag time of “hours” [s] (Sect. 6 of the paper)."""


def calibration_section(data):
    """The rate of the literal drive that gives the onset of Fig. 4, and what the literal ensemble has in common."""
    parts = []
    found = data.calibration
    if found is None:
        parts.append("The calibration of d omega/dt on the onset of mass loss in Fig. 4 is not part of the data.")
    else:
        value = {name: found[name].item() for name in ("omega_onset", "calibrated", "exponent", "exponent_error")}
        low, high = found["calibrated_low"].item(), found["calibrated_high"].item()
        runs = found.to_dataframe()
        parts.append(
            "The literal drive has one number that the paper does not give, the d omega/dt that its figures were made "
            f"with (the step is printed). The onset of mass loss in Fig. 4, {number(value['omega_onset'])} rad/s, "
            "fixes it: "
            f"{number(value['calibrated'])} rad/s² ({between(low, high)} for one standard error), from a fit of "
            f"omega ~ (d omega/dt)^p with p = {with_error(value['exponent'], value['exponent_error'])} over "
            f"{plural(int(found.sizes['entry']), 'run')} of {plural(runs['seed'].nunique(), 'grain')}; the errors are "
            "those of leaving out one grain after the other. The onset is the loss of 1 % of the mass. With p = 1/3, "
            "the limit of a threshold far above q, it is "
            f"{number(found['calibrated_by_law'].item())} rad/s² from the slowest run of each grain, "
            "among equally slow ones that with the shortest step. "
            f"{_rates(runs, found['calibrated'].item())}Besides the "
            "radii of the monomers, which give the numbers of Fig. 1, nothing else was fitted to the paper."
        )
        parts += _steps(step_ratios(runs), value["exponent"])
    parts += [*_shorter_step(data), *_drag_time(data), *solid_parts(data)]
    if "literal" in data.tables:
        law = data.plan.spin_up_of("literal")
        table = ratios(data.tables["literal"], data.plan.materials)
        rate = printed_rate(data)
        stands = "" if rate is None else f", which stands for {number(rate)} rad/s² at the printed step"
        parts.append(
            f"The grains of the drive `literal` here were spun up with {data.plan.pace('literal')} and f = "
            f"{law['timestep_factor']:g}{stands}. The table sets them beside Eq. 33 with Table 3 for the same grains: "
            "level (median of the ratio), power of size, and how the types are ordered at the sizes that all of them "
            "have, from the lowest omega to the highest. The level follows from the one number that was fixed; what "
            "tests the drive is how omega_disr goes with type and size."
        )
        parts += _beside_table3(table, data.plan.materials)
    return "\n\n".join(parts)


def _steps(pairs, exponent):
    """A paragraph: how well runs with one step stand for those with another, and what the difference means."""
    if not len(pairs):
        return []
    found, meaning = [], ""
    for (longer, shorter), part in pairs.groupby(["timestep_factor", "shorter_factor"]):
        own = median_of(part["ratio"], part["seed"])
        ratio = with_error(own["median"], own["error"]) if np.isfinite(own["error"]) else f"{own['median']:.4f}"
        scatter = f"; {part['ratio'].min():.4f} to {part['ratio'].max():.4f}" if len(part) > 1 else ""
        found.append(f"{ratio} (f = {longer:g} over f = {shorter:g}, {plural(len(part), 'pair')}{scatter})")
        if np.isclose(shorter, PRINTED_STEP) and np.isfinite(exponent):  # the last is with the longest step
            off = 100 * (1 - own["median"] ** (-1 / exponent))
            meaning = (
                f" By the exponent of the fit, runs with f = {longer:g} ask for a d omega/dt that is {abs(off):.2g} % "
                f"too {'low' if off > 0 else 'high'} beside those at the printed step itself."
            )
    return [
        f"It is the rate at the printed step, f = {PRINTED_STEP:g}. Only d omega/dt over the step counts, so runs with "
        "a longer step and a d omega/dt that is as much greater, which are far cheaper, stand for it. The onset with "
        f"the longer step over that with the shorter one in pairs of runs of the same grain: {', '.join(found)}."
        + meaning
    ]


def _rates(runs, calibrated):
    """A sentence: which d omega/dt the runs had, and whether the calibrated one lies outside."""
    rates = sorted(same_rate(runs["printed_acceleration"]).unique())
    words = f"The runs stand for {', '.join(map(number, rates))} rad/s²"
    if np.isfinite(calibrated) and not rates[0] <= calibrated <= rates[-1]:
        nearest = rates[0] if calibrated < rates[0] else rates[-1]
        words += f", from which the answer is extrapolated by {100 * abs(calibrated / nearest - 1):.2g} %"
    return f"{words}. "


def _drag_time(data):
    """A paragraph: what the drag time that the paper names would give."""
    figure4 = data.plan.config["figures"]["figure4"]
    if figure4 is None or "prescribed" not in data.tables:
        return []
    rate = OMEGA_RAT / HOUR
    table = with_literal_step(data, PRINTED_STEP)
    cell = in_cell(table, figure4)
    solid = median_of(solid_prediction(cell, rate))
    if not solid["n"]:
        return []
    onset = PRINTED["onset"].value
    steps = onset / rate / cell["literal_step"].median()
    words = (
        f"The paper does name omega_RAT = {number(OMEGA_RAT)} rad/s and a drag time “in the order of hours”, which "
        "“does not impact the result … as long as the change in centrifugal forces per time step remains much smaller” "
        f"than what lets monomers settle anew (Sects. 6 and 7). One hour is {number(rate)} rad/s² by Eq. 26, and "
        f"{number(onset)} rad/s would be reached after {number(steps)} printed steps, so that the figures can hardly "
        "have been made with it. Under the printed equations it is no detail: at that rate a solid grain of the cell "
        f"of Fig. 4 would part at {with_error(solid['median'], solid['error'])} rad/s, "
        f"{number(solid['median'] / onset)} times the printed onset. This omega is that of the frame; the lag turns "
        "the grain backwards, and it parts where it turns as fast as in the consistent model"
    )
    calibrated = np.nan if data.calibration is None else data.calibration["calibrated"].item()
    if np.isfinite(calibrated):
        words += f". The calibrated rate is a drag time of {1e3 * OMEGA_RAT / calibrated:.2g} ms"
    return [f"{words}."]


def _shorter_step(data):
    """Grains of Fig. 9 beside themselves in the ensemble, which the literal drive spun up with a longer step."""
    if "literal" not in data.tables or "literal" not in data.parameters:
        return []
    law, figure9, rate = data.plan.spin_up_of("literal"), data.plan.config["figures"]["figure9"], printed_rate(data)
    if figure9 is None or rate is None:
        return []
    other = figure9["literal"]
    if not np.isclose(
        rate, printed_acceleration(other["angular_acceleration"], other["timestep_factor"]), rtol=1e-6, atol=0
    ):
        return []
    short = data.parameters["literal"]
    both = same_grains(data.tables["literal"], short[short["parameter"] == AS_IT_IS], ("_long", "_short"))
    found = {mark: median_of(both[f"{mark}_long"] / both[f"{mark}_short"]) for mark in MARKS}
    if not all(own["n"] for own in found.values()):
        return []
    words = [
        f"{name} at {with_error(found[mark]['median'], found[mark]['error'])} times "
        f"({between(found[mark]['low'], found[mark]['high'])} for the middle two thirds)"
        for mark, name in (("omega_mass_75", "a quarter of the mass is lost"), ("omega_disr", "the stress is greatest"))
    ]
    return [
        f"So it is in the {plural(len(both), 'grain')} that both the ensemble and Fig. 9 have: with f = "
        f"{law['timestep_factor']:g} {' and '.join(words)} the omega with f = {other['timestep_factor']:g}."
    ]


def printed_rate(data):
    """d omega/dt [rad/s2] at the printed step that the runs of the drive `literal` stand for; None without one."""
    law = data.plan.spin_up_of("literal")
    rate = law["angular_acceleration"]
    return None if rate is None else printed_acceleration(rate, law["timestep_factor"])


def is_calibrated(data):
    """Whether the drive `literal` was run with the d omega/dt that its calibration gives, within a standard error."""
    rate = printed_rate(data)
    if data.calibration is None or rate is None:
        return False
    return data.calibration["calibrated_low"].item() <= rate <= data.calibration["calibrated_high"].item()


def solid_parts(data):
    """What the literal drive does with a solid grain, and how nearly the grains are solid; a paragraph."""
    law = data.plan.spin_up_of("literal")
    if "prescribed" not in data.tables:
        return []
    parts = [
        "What the literal drive gives at another rate can be told without a run for a solid grain: under the printed "
        "equations it turns with Omega in the inertial frame, d Omega/dt = s d omega/dt - (1 - s) omega (omega - "
        "Omega)² dt, where s is the share of the monomers' own moments of inertia, and parts where |Omega| is the "
        "omega_disr of the drive `prescribed` for the same grain (docs/validation.md, The literal drive)."
    ]
    if "literal" not in data.tables or law["angular_acceleration"] is None:
        return parts
    both = same_grains(with_literal_step(data, law["timestep_factor"]), data.tables["literal"], ("", "_literal"))
    both = both.assign(over=both["omega_disr_literal"] / solid_prediction(both, law["angular_acceleration"]))
    told = []
    for kind, sizes, part in by_type_and_size(both):
        found = median_of(part["over"], cell=cell_of(part))
        told.append(f"{kind} {sizes} {with_error(found['median'], found['error'])}")
    parts[0] += (
        f" In the {plural(int(both['over'].notna().sum()), 'grain')} that both drives have here, at "
        f"{number(law['angular_acceleration'])} rad/s², omega_disr of the run is so many times that, in medians: "
        f"{'; '.join(told)}. What differs from 1 is by how much a grain is not solid."
    )
    return parts


def _beside_table3(table, materials):
    """Table of level, power of size and order of the types of a drive beside Eq. 33 with Table 3, and a sentence."""
    rows, flatter, of = [], 0, 0
    for name, part in table.groupby("material", sort=False):
        for kind, own in part.groupby("type", sort=False):
            slope, error = _slope(own)
            printed, _ = _slope(own.assign(omega_disr=table3_omega(own, materials)))
            of += np.isfinite(printed)
            flatter += slope > printed + 1e-9  # less than that is rounding
            level = median_and_range(own, own["found_over_printed"])
            rows.append([name, kind, sizes_of(own), level, with_error(slope, error), number(printed)])
        printed = part.assign(printed=table3_omega(part, materials))
        rows.append([name, "order", "", f"{_order(part, 'omega_disr')}; Table 3: {_order(printed, 'printed')}", "", ""])
    head = ["material", "type", "sizes", "omega_disr over Table 3", "d ln omega/d ln a_eff", "of Table 3"]
    return [
        markdown_table(head, rows),
        f"It falls less steeply with size than Table 3 in {flatter} of {plural(of, 'case')}.",
    ]


def with_literal_step(data, timestep_factor):
    """Table of the grains of the drive `prescribed`, with literal_step, the time step [s] for another f."""
    table = data.tables["prescribed"]
    own = data.plan.spin_up_of("prescribed")["timestep_factor"]
    return table.assign(literal_step=table["timestep"] * timestep_factor / own)


def solid_prediction(table, acceleration):
    """omega at which solid grains part under the printed equations, from their omega_disr of the consistent model.

    Parameters
    ----------
    table : pandas.DataFrame
        Grains with omega_disr [rad/s] of the drive `prescribed`, spin_share, and literal_step [s], the time step of the
        drive `literal`.
    acceleration : float
        d omega/dt [rad/s2].

    Returns
    -------
    numpy.ndarray
        See `ratd.solid.solid_omega`; NaN where something is not known.
    """
    columns = table[["omega_disr", "spin_share", "literal_step"]].to_numpy(float)
    return np.array(
        [solid_omega(own[0], own[1], acceleration, own[2])[0] if np.isfinite(own).all() else np.nan for own in columns]
    )


def _slope(table):
    """Slope of ln omega_disr against ln a_eff, and its standard error; all cells count alike."""
    known = table[table["omega_disr"].notna()]
    x, y = np.log(known["a_eff"].to_numpy(float)), np.log(known["omega_disr"].to_numpy(float))
    slope, influence = slope_of(x, y, weights=equal_weights(cell_of(known)))
    return slope, slope_error(influence)


def _order(table, column):
    """Types from the lowest to the highest median at the sizes that all types have, text."""
    table = table.assign(nm=whole_nm(table))
    counts = table.groupby("nm")["type"].nunique()
    common = counts.index[counts == table["type"].nunique()]
    if not len(common) or table["type"].nunique() < 2:
        return NOTHING
    known = table[table["nm"].isin(common) & table[column].notna()]
    medians = {kind: quantiles(part[column], 0.5, equal_weights(cell_of(part))) for kind, part in known.groupby("type")}
    return " < ".join(sorted(medians, key=medians.get))
