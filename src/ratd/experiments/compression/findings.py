"""Every number that docs/compression.md tells, from the tables of the compression."""

import math

import numpy as np
from scipy.stats import t as student

from ratd.aggregates.clusters import MONOMER_RADIUS
from ratd.aggregates.strength import (
    compressive_strength_kataoka2013,
    compressive_strength_tatsuuma2023,
    filling_factor_guettler2009,
    rolling_pressure,
    sound_speed_kataoka2013,
)
from ratd.base.materials import get_material
from ratd.base.measured import Measured, quotient
from ratd.base.statistics import mean_of
from ratd.experiments.compression.beside_lammps import of_box, of_dense, of_lammps
from ratd.experiments.compression.losses import lost_from, overtakes, part_of_work, share_at
from ratd.experiments.compression.monomers import LENGTHS, predicted_pressures
from ratd.experiments.compression.pairs import BY_SIZE, HIGH, LOW_RANGE, SMALL, beside, of_pairs
from ratd.experiments.compression.static import (
    box_rate,
    face_speed,
    filling_factor_bcca,
    slower_than_sound_from,
    time_unit,
)
from ratd.experiments.compression.strength import (
    FIT_RANGE,
    NEAR,
    along_axes,
    anisotropy_at,
    crosses_line,
    far_slope_of_structure,
    fit_power_law,
    fit_with_limit,
    led_by,
    measured,
    of_means,
    of_same_clusters,
    phi_at,
    ratio_at,
    scatter_at,
    several,
    slope_of_structure,
)
from ratd.experiments.compression.tables import nearest_phi
from ratd.experiments.compression.tension_findings import of_spun, of_tension
from ratd.observables.energy import DISSIPATED

__all__ = ["findings"]

SLIDING = 1e-16
"""Energy [J] lost by sliding in a cluster at which it is said to begin: the least in the printed Fig. 8."""
AT = (0.002, 0.003, 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.48)
"""Filling factors at which numbers are told."""
STEPS_WAYS = ("dissipated_rolling", "dissipated_twisting", "dissipated_damping", "dissipated_made")
"""Losses that are compared between long steps and explicit ones."""
STEPS_AT = (0.01, 0.02)
"""Filling factors below the range of the fit at which long steps are compared with explicit ones."""
WAYS = ("rolling", "twisting", "sliding", "damping", "made")
"""Ways of losing energy whose shares are told; "made" is what a new contact radiates as it forms."""
ROLLING_BETWEEN = ((0.005, 0.008), (0.008, 0.01), (0.01, 0.012), (0.012, 0.015), (0.02, 0.03))
"""Filling factors between which the part of the work that rolling takes is told."""
BALANCE_AT = (0.003, 0.005, 0.01, 0.02, 0.03, 0.1, 0.3)
"""Filling factors at which the balance of energy is told."""
LED = (("xi_32", 1), ("explicit", 3))
"""Sets whose pressure at 0.01 few clusters bear, and how many."""
PAPER_N = 16384
"""Monomers in the clusters of most sets of the paper."""


def of_set(name, table):
    """Numbers of one set: name -> value, each name beginning with that of the set."""
    found = {"n": table.sizes["seed_number"], "N": table["n_monomers"].item()}
    found["steps"] = float(np.mean(table["steps"].values)) / 1e6
    found["rate"] = float(table["strain_rate"].values[0])
    found["static"] = float(table["static_from"].values[0])
    found["P0"] = float(table["rolling_pressure"].values[0])
    found["E_roll"] = found["P0"] * table["monomer_radius"].item() ** 3
    found["t_0"] = table["time_unit"].item()
    found["start"] = float(np.mean(table["phi_start"].values))
    found["latest_start"] = float(np.max(table["phi_start"].values))
    # a run can be static from the start
    found["static_seen"] = max(found["static"], found["start"])
    gyration, error = table["mean_square_gyration"].item(), table["mean_square_gyration_error"].item()
    root = math.sqrt(gyration)
    r_0 = table["monomer_radius"].item()
    found["gyration"] = Measured(root / r_0, 0.5 * error / root / r_0)
    # of a cluster over N^(1/2) r_0; the pressure that Sect. 4 of the paper derives goes with its sixth power
    width, spread = (number / math.sqrt(found["N"]) for number in found["gyration"])
    found |= {"width": Measured(width, spread), "width_6": Measured(width**6, 6.0 * width**5 * spread)}
    # of a sphere with this radius of gyration, whose own radius is sqrt(5/3) of it (Eq. 24)
    found["width_6_sphere"] = Measured(*((5.0 / 3.0) ** 3 * number for number in found["width_6"]))
    last = float(table["phi"].values[np.isfinite(table["pressure"].values).all(axis=0)].max())
    for phi in [phi for phi in AT if 1.2 * table["phi_start"].values.max() < phi < last]:
        found[f"ratio_{phi:g}"] = measured(ratio_at(table, phi))
        found[f"pressure_{phi:g}"] = found[f"ratio_{phi:g}"].value * found["P0"] * phi**3
        found[f"scatter_{phi:g}"] = measured(scatter_at(table, phi))
        k = _bin_at(table, phi)
        found[f"contacts_{phi:g}"] = _contacts_at(table, phi)
        found[f"contacts_arakawa_{phi:g}"] = 1.0 + 4.69 * phi**1.62
        found[f"anisotropy_{phi:g}"] = measured(anisotropy_at(table, phi))
        found |= dict(zip((f"along_{axis}_{phi:g}" for axis in "xyz"), several(along_axes(table, phi)), strict=True))
        for way in WAYS:
            found[f"{way}_{phi:g}"] = measured(share_at(table, way, phi))
        work = np.nanmean(table["work"].values[:, k])
        for mode in ("rolling", "twisting"):
            found[f"held_{mode}_{phi:g}"] = float(np.nanmean(table[f"stored_{mode}"].values[:, k]) / work)
        found[f"lost_rolling_{phi:g}"] = float(np.nanmean(table["dissipated_rolling"].values[:, k]) / work)
        found[f"sliding_energy_{phi:g}"] = float(np.mean(table["dissipated_sliding"].values[:, k]))
    if last * NEAR > FIT_RANGE[1]:
        exponent, at, ratio = several(fit_power_law(table))
        found |= {"exponent": exponent, "prefactor": at, "ratio": ratio}
    if found["start"] < 0.1 * LOW_RANGE[0] and last > LOW_RANGE[1]:
        found["exponent_low"], _, found["ratio_low"] = several(fit_power_law(table, *LOW_RANGE))
    found["rolling_over_made"] = measured(overtakes(table, "rolling", "made", found["static"]))
    found["rolling_over_damping"] = measured(overtakes(table, "rolling", "damping", found["static"]))
    found["sliding_from"] = measured(lost_from(table, "sliding", SLIDING))
    for first, second in (("sliding", "rolling"), ("twisting", "rolling"), ("sliding", "twisting")):
        found[f"{first}_over_{second}"] = measured(overtakes(table, first, second))
    found |= _balance(table, last)
    for low, high in ROLLING_BETWEEN:
        if found["latest_start"] < low and high < last:
            found[f"rolling_between_{low:g}"] = measured(part_of_work(table, "rolling", low, high))
    for k, phi in enumerate(table["snapshot_phi"].values):
        nominal = f"{float(f'{phi:.1g}'):g}"
        found[f"slope_{nominal}"] = measured(slope_of_structure(table, k))
        found[f"far_slope_{nominal}"] = measured(far_slope_of_structure(table, k))
    if last > 0.4:
        found |= _with_limit(table, min(0.5, last))
    if last > 0.1:
        found["phi_300"] = measured(phi_at(table, 300.0, min(0.45, last)))
        found["crosses"] = measured(crosses_line(table, min(0.3, last)))
    found["line_300"] = float((300.0 / found["P0"]) ** (1.0 / 3.0))
    found["tatsuuma_300"] = _solved(300.0, found["P0"])
    return {f"{name}.{key}": value for key, value in found.items()}


def _contacts_at(table, phi):
    """Number of contacts over that of monomers at a filling factor, `Measured`."""
    every = table["n_contacts"].values / table["n_monomers"].item()
    x = np.log(table["phi"].values)
    each = [np.interp(math.log(phi), x[there], own[there]) for own in every if (there := np.isfinite(own)).any()]
    return Measured(*mean_of(np.array(each)))


def _balance(table, last):
    """What the balance of energy lacks of the work: in any cluster from a filling factor on, and in the mean at it.

    ``lacks`` is the sum over the clusters over the sum of their work, which single clusters hardly have where they are
    loose, and ``lacks_lost`` the same over all that they lost.
    """
    missing, work = table["energy_residual"].values, table["work"].values
    lost = sum(table[f"dissipated_{way}"].values for way in DISSIPATED)
    found = {}
    for phi in [phi for phi in BALANCE_AT if phi < last]:
        k = _bin_at(table, phi)
        found[f"residual_{phi:g}"] = float(np.nanmax(np.abs((missing / work)[:, table["phi"].values > phi])))
        found[f"untold_{phi:g}"] = Measured(*mean_of(-(missing / work)[:, k]))
        found[f"lacks_{phi:g}"] = float(abs(np.nansum(missing[:, k]) / np.nansum(work[:, k])))
        found[f"lacks_lost_{phi:g}"] = float(abs(np.nansum(missing[:, k]) / np.nansum(lost[:, k])))
    return found


def _with_limit(table, high):
    """The fit with a greatest filling factor, and what it and the recalled formula give over P_0 phi^3."""
    found = dict(zip(("limit_c", "limit_phi"), several(fit_with_limit(table, high=high)), strict=True))
    for shorter in (0.3, 0.4):
        found[f"limit_phi_{shorter:g}"] = several(fit_with_limit(table, high=shorter))[1]
    for phi in AT:
        found[f"tatsuuma_{phi:g}"] = float(compressive_strength_tatsuuma2023(phi, 1.0) / phi**3)
        fitted = compressive_strength_tatsuuma2023(phi, 1.0, found["limit_phi"].value)
        found[f"fitted_{phi:g}"] = float(found["limit_c"].value * fitted / phi**3)
    return found


def _solved(pressure, rolling_pressure):
    phi = np.linspace(0.01, 0.6, 5000)
    return float(np.interp(pressure, compressive_strength_tatsuuma2023(phi, rolling_pressure), phi))


def of_monomers(equal, tables):
    """P over what each length predicts, geometric mean over the range of the fit, and over that of equal monomers."""
    found = {}
    reference = several(fit_power_law(equal))[2]
    for name, table in tables.items():
        own = several(fit_power_law(table))[2]
        predicted = predicted_pressures(table, equal)
        # l^6 goes with the cube of r_g^2, of both
        of_widths = [3.0 * each["mean_square_gyration_error"] / each["mean_square_gyration"] for each in (table, equal)]
        for length in LENGTHS:
            ratio = own.value * table["rolling_pressure"].values[0] / predicted[length] / reference.value
            parts = [own.error / own.value, reference.error / reference.value]
            parts += [float(part) for part in of_widths] if length == "derived" else []
            found[f"{name}.over_{length}"] = Measured(ratio, ratio * math.hypot(*parts))
        found[f"{name}.length"] = math.sqrt(
            table["mean_square_gyration"].item() / equal["mean_square_gyration"].item()
        ) * (equal["monomer_radius"].item() / table["monomer_radius"].item())
        found[f"{name}.mean_over_volume"] = table["mean_radius"].item() / table["monomer_radius"].item()
    return found


def of_steps(tables):
    """Long steps over explicit ones, of the same clusters: pressure between the filling factors of the fit, work,
    contacts and steps up to 0.2.

    Parameters
    ----------
    tables : dict of str to xarray.Dataset
        ``explicit``, and others.
    """
    explicit = tables["explicit"]
    seeds = list(explicit["seed"].values)
    phi = explicit["phi"].values
    fitted, end = phi[(phi > FIT_RANGE[0]) & (phi < FIT_RANGE[1])], phi[[_bin_at(explicit, 0.2)]]
    found = {}
    for name, table in tables.items():
        same = [seeds.index(seed) for seed in table["seed"].values]
        told = [("pressure", fitted), *((name, end) for name in ("n_contacts", "work", *STEPS_WAYS))]
        for column, where in told:
            own, other = (
                each[column].values[:, [_bin_at(each, value) for value in where]].mean(axis=1)
                for each in (table, explicit)
            )
            found[f"{name}.over_{column}"] = Measured(*mean_of(own / other[same]))
        for value in STEPS_AT:
            own, other = (_near(each, value) for each in (table, explicit))
            both = np.stack([own, other[same]], axis=1)
            found[f"{name}.over_pressure_{value:g}"] = measured(of_means(both, lambda mean: mean[0] / mean[1]))
        found[f"{name}.over_steps"] = float(np.mean(explicit["steps"].values[same] / table["steps"].values))
    return found


def of_closed_formulae():
    """What the paper reckons for ice without a simulation: speeds [cm/s], and the filling factor of a cluster."""
    ice = get_material("ice")
    radius = MONOMER_RADIUS["ice"]
    rate = box_rate(3e-7, time_unit(ice, radius))
    P_0 = rolling_pressure(ice.surface_energy, ice.critical_rolling_displacement, radius)
    found = {f"v_d_{phi:g}": 100.0 * face_speed(rate, PAPER_N, radius, phi) for phi in (0.001, 0.01, 0.1)}
    found["sound"] = 100.0 * float(sound_speed_kataoka2013(1.0, P_0, ice.density))
    # of the faces of the box, over the speed of sound
    for strain_rate in (1e-7, 3e-7, 3e-8):
        for phi in (0.001, 0.002, 0.003, 0.005, 0.01, 0.02, 0.03):
            found[f"mach_{strain_rate:.0e}_{phi:g}"] = _mach("ice", strain_rate, phi)
    for strain_rate in (3e-6, 1e-5):
        found[f"mach_4096_{strain_rate:.0e}_0.05"] = _mach("ice", strain_rate, 0.05, n=4096)
    for phi in (0.05, 0.1):
        found[f"mach_silicate_{phi:g}"] = _mach("silicate", 3e-7, phi)
    face, sound = _face_and_sound("silicate", 3e-7, 0.01)
    found |= {"v_d_silicate": face, "sound_silicate": sound}
    silicate, radius = get_material("silicate"), MONOMER_RADIUS["silicate"]
    P_0 = rolling_pressure(silicate.surface_energy, silicate.critical_rolling_displacement, radius)
    rate = box_rate(3e-7, time_unit(silicate, radius))
    found["sound_from_silicate"] = slower_than_sound_from(rate, PAPER_N, radius, silicate.density, P_0)
    for name in MONOMER_RADIUS:
        found |= {f"of_{name}.{key}": value for key, value in _constants(name).items()}
    return found | {"phi_bcca": filling_factor_bcca(PAPER_N)}


def _constants(name):
    """Constants of a material, in the units of the page."""
    own = get_material(name)
    return {
        "radius": 1e6 * MONOMER_RADIUS[name],
        "gamma": 1e3 * own.surface_energy,
        "E": 1e-9 * own.youngs_modulus,
        "nu": own.poisson_number,
        "density": own.density,
        "xi": 1e9 * own.critical_rolling_displacement,
    }


def _face_and_sound(name, strain_rate, phi, n=PAPER_N):
    """Speed of a face of the box of `n` monomers, and of sound in the cluster [cm/s]."""
    own, radius = get_material(name), MONOMER_RADIUS[name]
    P_0 = rolling_pressure(own.surface_energy, own.critical_rolling_displacement, radius)
    face = face_speed(box_rate(strain_rate, time_unit(own, radius)), n, radius, phi)
    return 100.0 * face, 100.0 * float(sound_speed_kataoka2013(phi, P_0, own.density))


def _mach(name, strain_rate, phi, n=PAPER_N):
    """Speed of a face of the box over that of sound."""
    face, sound = _face_and_sound(name, strain_rate, phi, n)
    return face / sound


def _near(table, phi):
    """Pressures of single clusters near a filling factor, (seeds,)."""
    k = _bin_at(table, phi)
    return table["pressure"].values[:, k - 2 : k + 3].mean(axis=1)


def _again(table, other, phi):
    """Root mean square of P over that of the same cluster in another run, less 1, near a filling factor."""
    own, other = (_near(each, phi) for each in of_same_clusters([table, other]))
    return float(np.sqrt(np.mean((own / other - 1.0) ** 2)))


def _bin_at(table, phi):
    """Number of the bin of a filling factor in a table."""
    return nearest_phi(table["phi"].values, phi)


def verdicts(values, sets):
    """Words on which sentences of the document rest."""
    found = {}
    for name, phi in ((BY_SIZE[-1], 0.03), (BY_SIZE[-1], 0.1), (HIGH, 0.3)):
        if f"{name}.ratio_{phi:g}" in values:
            ratio = values[f"{name}.ratio_{phi:g}"].value
            found[f"line_{phi:g}"] = "on" if abs(ratio - 1.0) < 0.25 else "below" if ratio < 1.0 else "above"
    exponents = [values[f"{name}.exponent"] for name in ("base", BY_SIZE[-1]) if f"{name}.exponent" in values]
    words = {_beside_3(exponent) for exponent in exponents}
    found["exponent"] = words.pop() if len(words) == 1 else "differs"
    for name, phi in (("base", 0.1), (HIGH, 0.48)):
        if f"{name}.rolling_{phi:g}" in values:
            found[f"leader_{phi:g}"] = max(WAYS[:3], key=lambda way: values[f"{name}.{way}_{phi:g}"].value)
    for name in sets:
        other = beside(name)
        if name != other and {f"{name}.ratio", f"{other}.ratio"} <= set(values):
            found[f"{name}.same"] = "agrees" if _same(values, name, other) else "differs"
    if "xi_p48_32" in values:
        alike = max(abs(values[f"xi_p48_{name}"].value - 1.0) for name in ("8", "32")) < 0.4
        found["high_density"] = "hardly depends" if alike else "depends"
    if "slow_16384.over_0.03" in values:
        n = values["slow_16384.n"]
        late = values["slow_16384.over_0.03"]
        early = [values[f"slow_16384.{what}_0.005"] for what in ("over", "ratio")]
        found["slow_early"] = "less" if all(_below(own, n) for own in early) else "as much"
        found["slow_line"] = "below" if _below(values["slow_16384.ratio_0.01"], n) else "not below"
        for phi in (0.01, 0.02):
            both = [values[f"slow_16384.{over}_{phi}"] for over in ("over", "over_all")]
            sure = all(_below(own, n) for own in both)
            found[f"slow_{phi}"] = "show" if sure else "suggest" if both[0].value < 1.0 else "deny"
        found["slow_0.03"] = "the same" if abs(late.value - 1.0) < 2.0 * late.error else "another"
        steeper = values["slow_16384.steeper_low"]
        found["slow_steeper"] = "more" if steeper.value > _sure(steeper, n) else "no more"
    if "slow_16384.over_next_0.01" in values:
        found["loose_line"] = "below" if _below(values["loose_16384.ratio_0.005"], values["loose_16384.n"]) else "on"
        over = [values[f"slow_16384.over_next_{phi:g}"] for phi in (0.005, 0.01)]
        found["slow_enough"] = "the same" if all(abs(own.value - 1.0) < 2.0 * own.error for own in over) else "another"
    if "short_16384.over_0.01" in values:
        off = max(abs(values[f"short_16384.over_{phi}"].value - 1.0) for phi in (0.005, 0.01))
        found["short_steps"] = "less than a tenth" if off < 0.1 else "a tenth or more"
    if {"slow_65536.ratio_0.005", "slow_16384.ratio_0.005"} <= set(values):
        alike = [
            abs(values[f"slow_65536.ratio_{phi:g}"].value - own.value) < 2.0 * own.error
            for phi, own in ((phi, values[f"slow_16384.ratio_{phi:g}"]) for phi in (0.005, 0.01))
        ]
        found["slow_size"] = "not the reason" if all(alike) else "a reason"
    slow = [values[f"rate_{rate}.paired"].value for rate in ("1e-7", "1e-6", "3e-6") if f"rate_{rate}.paired" in values]
    if slow:
        found["rates"] = "a tenth" if max(abs(ratio - 1.0) for ratio in slow) < 0.15 else "more"
    at_02 = [f"{name}.ratio_0.2" for name in ("xi_32", HIGH, "xi_2", "silicate_16384")]
    if set(at_02) <= set(values):
        much, some, *little = (values[name].value for name in at_02)
        found["twisting_0.2"] = "the more" if much < some < min(little) else "no more"
    if "silicate" in sets:
        found["silicate_300"] = "agrees" if abs(values["silicate.phi_300"].value - 0.24) < 0.02 else "differs"
    return found


def _sure(own, n):
    """Half the width of the range that holds a mean of `n` clusters in 19 cases of 20 (Student's t)."""
    return student.ppf(0.975, n - 1) * own.error


def _below(own, n):
    """Whether a ratio of `n` clusters is surely below 1."""
    return own.value + _sure(own, n) < 1.0


def _beside_3(exponent):
    """Where an exponent lies beside the printed one."""
    steeper = exponent.value - 3.0
    return "is 3" if abs(steeper) < 2.0 * exponent.error else "above 3" if steeper > 0.0 else "below 3"


def _same(values, name, beside):
    """Whether the mean ratio in the range of the fit is that of another set, within 15 % and two errors."""
    own, other = values[f"{name}.ratio"], values[f"{beside}.ratio"]
    return abs(own.value - other.value) < max(0.15, 2.0 * math.hypot(own.error, other.error))


def worst_balance(sets, values):
    """The worst balance of energy from 0.1 on of all sets with long steps, over the work."""
    long = [name for name, table in sets.items() if "SemiImplicit" in table.attrs["integrator"]]
    residuals = [values[f"{name}.residual_0.1"] for name in long if f"{name}.residual_0.1" in values]
    return {"long_steps.residual": max(residuals)} if residuals else {}


def findings(sets, entries, spun, lammps=None, box=None, dense=None):
    """Values and verdicts for the slots of the document.

    Parameters
    ----------
    sets : dict of str to xarray.Dataset
        Tables of the kind ``compression_set``, ``base`` among them.
    entries : xarray.Dataset or None
        Of the kind ``tension_set``.
    spun : dict or None
        From `spun_up`.
    lammps : pandas.DataFrame, optional
        See `ratd.experiments.compression.beside_lammps.of_lammps`.
    box : pandas.DataFrame, optional
        See `ratd.experiments.compression.beside_lammps.of_box`.
    dense : pandas.DataFrame, optional
        See `ratd.experiments.compression.beside_lammps.of_dense`.
    """
    values = {"fit_low": FIT_RANGE[0], "fit_high": FIT_RANGE[1]}
    values["guettler_300"] = float(filling_factor_guettler2009(300.0))
    for name, table in sets.items():
        values |= of_set(name, table)
    values |= of_pairs(sets)
    values |= worst_balance(sets, values)
    both = [name for name in (HIGH, BY_SIZE[-1]) if name in sets]
    if len(both) == 2:
        values[f"{HIGH}.over_all"] = quotient(*(values[f"{name}.ratio_0.1"] for name in both))
        values[f"{HIGH}.again"] = _again(*(sets[name] for name in both), 0.1)
    for name, k in LED:
        if name in sets:
            values[f"{name}.led_by_{k}"] = led_by(sets[name], 0.01, k)
    unequal = {name: table for name, table in sets.items() if name in ("lognormal", "mrn")}
    values |= of_monomers(sets.get("equal", sets["base"]), unequal)
    if "explicit" in sets:
        values |= of_steps(
            {name: table for name, table in sets.items() if name.startswith("steps_")} | {"explicit": sets["explicit"]}
        )
    if {SMALL, "xi_2", "xi_32"} <= set(sets):
        for name, times in ((SMALL, 4.0), ("xi_32", 16.0)):
            over = quotient(values[f"{name}.ratio_0.48"], values["xi_2.ratio_0.48"])
            values[f"xi_p48_{'8' if name == SMALL else '32'}"] = Measured(times * over.value, times * over.error)
    values["line_silicate_024"] = (
        float(compressive_strength_kataoka2013(0.24, values["silicate.P0"])) if "silicate" in sets else math.nan
    )
    values |= of_closed_formulae()
    if entries is not None:
        values |= of_tension(entries)
    if lammps is not None:
        values |= of_lammps(lammps)
    if box is not None:
        values |= of_box(box)
    if dense is not None:
        values |= of_dense(dense)
    if spun is not None:
        values |= of_spun(spun)
    return values | verdicts(values, sets)
