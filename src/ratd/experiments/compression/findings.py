"""Every number that docs/compression.md tells, from the tables of the compression."""

import math

import numpy as np

from ratd.aggregates.clusters import MONOMER_RADIUS
from ratd.aggregates.strength import (
    compressive_strength_kataoka2013,
    compressive_strength_tatsuuma2023,
    filling_factor_guettler2009,
    power_kataoka2013,
    power_tatsuuma2023,
    rolling_pressure,
    sound_speed_kataoka2013,
)
from ratd.base.materials import get_material
from ratd.base.measured import Measured, quotient
from ratd.base.statistics import mean_of
from ratd.experiments.compression.beside_lammps import of_box, of_dense, of_lammps
from ratd.experiments.compression.losses import WAYS, lost_from, overtakes, part_of_work, share_at, total_at
from ratd.experiments.compression.monomers import LENGTHS, predicted_pressures
from ratd.experiments.compression.pairs import BY_SIZE, HIGH, LOW_RANGE, SLOW_RATES, SMALL, of_pairs
from ratd.experiments.compression.repeats import near, of_repeats, parted
from ratd.experiments.compression.springs import of_springs
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
    compared,
    crosses_line,
    far_slope_of_structure,
    fit_power_law,
    fit_with_limit,
    led_by,
    measured,
    of_means,
    of_same_clusters,
    phi_at,
    power_at,
    ratio_at,
    scatter_at,
    several,
    slope_of_structure,
)
from ratd.experiments.compression.steps import STRAIN, longest_strain
from ratd.experiments.compression.tables import nearest_phi
from ratd.experiments.compression.tension_findings import of_spun, of_tension
from ratd.experiments.compression.verdicts import half_width, verdicts
from ratd.observables.energy import DISSIPATED

__all__ = ["findings"]

SLIDING = 1e-16
"""Energy [J] lost by sliding in a cluster at which it is said to begin: the least in the printed Fig. 8."""
AT = (0.002, 0.003, 0.005, 0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.48)
"""Filling factors at which numbers are told."""
HALF = 0.06
"""Filling factor that parts the range of the fit in two, equal in the logarithm."""
BESIDE_EXPLICIT = {
    "explicit": ("steps_0.1", "steps_1", "steps_3", "steps_10", "steps_30", "explicit_k_n_0", "explicit_k_n_10"),
    "explicit_silicate": ("silicate", "long_silicate"),
}
"""Sets of explicit steps, and the sets of the same clusters in other steps or with other damping beside them."""
STEPS_WAYS = ("dissipated_rolling", "dissipated_twisting", "dissipated_damping", "dissipated_made")
"""Losses that are compared between long steps and explicit ones."""
DAMPED = "dissipated_damping"
STEPS_AT = (0.01, 0.02, 0.05, 0.1)
"""Filling factors at which the pressure in long steps is compared with that in explicit ones."""
STEPS_END = 0.19
"""Filling factor up to which all of them go in long steps."""
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
        found[f"power_{phi:g}"] = measured(power_at(table, phi))
        found[f"contacts_{phi:g}"] = _contacts_at(table, phi)
        found[f"contacts_arakawa_{phi:g}"] = 1.0 + 4.69 * phi**1.62
        found[f"anisotropy_{phi:g}"] = measured(anisotropy_at(table, phi))
        found |= dict(zip((f"along_{axis}_{phi:g}" for axis in "xyz"), several(along_axes(table, phi)), strict=True))
        for way in WAYS:
            found[f"{way}_{phi:g}"] = measured(share_at(table, way, phi))
        work = np.nanmean(total_at(table, "work", phi))
        for mode in ("rolling", "twisting"):
            found[f"held_{mode}_{phi:g}"] = float(np.nanmean(total_at(table, f"stored_{mode}", phi)) / work)
        found[f"lost_rolling_{phi:g}"] = float(np.nanmean(total_at(table, "dissipated_rolling", phi)) / work)
        found[f"sliding_energy_{phi:g}"] = float(np.mean(total_at(table, "dissipated_sliding", phi)))
    if last * NEAR > FIT_RANGE[1]:
        exponent, at, ratio = several(fit_power_law(table))
        found |= {"exponent": exponent, "prefactor": at, "ratio": ratio}
        for half, part in (("first", (FIT_RANGE[0], HALF)), ("second", (HALF, FIT_RANGE[1]))):
            found[f"exponent_{half}"] = several(fit_power_law(table, *part))[0]
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
        k = nearest_phi(table["phi"].values, phi)
        found[f"residual_{phi:g}"] = float(np.nanmax(np.abs((missing / work)[:, table["phi"].values > phi])))
        found[f"untold_{phi:g}"] = Measured(*mean_of(-(missing / work)[:, k]))
        found[f"lacks_{phi:g}"] = float(abs(np.nansum(missing[:, k]) / np.nansum(work[:, k])))
        found[f"lacks_lost_{phi:g}"] = float(abs(np.nansum(missing[:, k]) / np.nansum(lost[:, k])))
    return found


def _with_limit(table, high):
    """The fit with a greatest filling factor, and what it and the recalled formula give, as ratio and as power."""
    found = dict(zip(("limit_c", "limit_phi"), several(fit_with_limit(table, high=high)), strict=True))
    for shorter in (0.3, 0.4):
        found[f"limit_phi_{shorter:g}"] = several(fit_with_limit(table, high=shorter))[1]
    limit = found["limit_phi"].value
    for phi in AT:
        found[f"tatsuuma_{phi:g}"] = float(compressive_strength_tatsuuma2023(phi, 1.0) / phi**3)
        fitted = compressive_strength_tatsuuma2023(phi, 1.0, limit)
        found[f"fitted_{phi:g}"] = float(found["limit_c"].value * fitted / phi**3)
        found[f"tatsuuma_power_{phi:g}"] = float(power_tatsuuma2023(phi))
        found[f"fitted_power_{phi:g}"] = float(power_tatsuuma2023(phi, limit))
    return found


def _solved(pressure, rolling_pressure):
    phi = np.linspace(0.01, 0.6, 5000)
    return float(np.interp(pressure, compressive_strength_tatsuuma2023(phi, rolling_pressure), phi))


def of_sizes(sets):
    """Fractal dimension of clusters of all sizes, and the power that Sect. 4 of the paper derives from one."""
    every = [sets[name] for name in (*BY_SIZE, "slow_65536") if name in sets]
    if len(every) < 3:
        return {}
    n, square, error = (
        np.array([table[name].item() for table in every])
        for name in ("n_monomers", "mean_square_gyration", "mean_square_gyration_error")
    )
    # N goes as the D-th power of the radius; r_g^2 as N^(2/D)
    (slope, _), cover = np.polyfit(np.log(n), np.log(square), 1, w=square / error, cov="unscaled")
    D = Measured(2.0 / slope, 2.0 / slope**2 * math.sqrt(cover[0, 0]))
    power = power_kataoka2013(D.value)
    return {"dimension": D, "derived_power": Measured(power, power**2 / 3.0 * D.error)}


def of_rates(sets, values):
    """How the clusters of Fig. 5 stand beside those at the usual rate, in errors, and the others at the usual rate.

    ``room`` is how far the pressure may differ, in 19 cases of 20, at the rate that differs most.
    """
    pairs = [values[f"rate_{rate}.paired"] for rate in SLOW_RATES if f"rate_{rate}.paired" in values]
    if not pairs:
        return {}
    off = [abs(own.value - 1.0) / own.error for own in pairs]
    found = {"rates.least": min(off), "rates.most": max(off)}
    n = sets[f"rate_{SLOW_RATES[0]}"].sizes["seed_number"]
    found["rates.room"] = max(abs(own.value - 1.0) + half_width(own, n) for own in pairs)
    few, base = sets[f"rate_{SLOW_RATES[0]}"], sets["base"]
    same = np.isin(base["seed"].values, few["seed"].values)
    for name, own in (("same", same), ("others", ~same)):
        if own.sum() > 1:
            found[f"rates.{name}"] = several(fit_power_law(base.isel(seed_number=own)))[2]
    again = [parted(sets[f"rate_{rate}"], base, 0.1) for rate in SLOW_RATES if f"rate_{rate}" in sets]
    return found | {"rates.again_least": min(again), "rates.again_most": max(again)}


def of_monomers(equal, tables):
    """P over what each length predicts, geometric mean over the range of the fit, over the same of equal monomers.

    ``of_derived`` is P over what the derived length predicts, not over that of equal monomers.
    """
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
        of_derived = found[f"{name}.over_derived"].value * reference.value
        parts = [own.error / own.value, *(float(part) for part in of_widths)]
        found[f"{name}.of_derived"] = Measured(of_derived, of_derived * math.hypot(*parts))
        found[f"{name}.length"] = math.sqrt(
            table["mean_square_gyration"].item() / equal["mean_square_gyration"].item()
        ) * (equal["monomer_radius"].item() / table["monomer_radius"].item())
        found[f"{name}.mean_over_volume"] = table["mean_radius"].item() / table["monomer_radius"].item()
    return found


def of_steps(tables, explicit):
    """Other steps or damping over explicit steps, of the same clusters.

    Geometric mean of the pressure over the range of the fit, work, contacts and losses up to `STEPS_END`, what is
    damped from the beginning of that range to there, and steps.

    Parameters
    ----------
    tables : dict of str to xarray.Dataset
    explicit : xarray.Dataset
    """
    found = {}
    for name, table in tables.items():
        pair = of_same_clusters([table, explicit])
        found[f"{name}.over_pressure"] = measured(compared(*pair))
        for column in ("n_contacts", "work", *STEPS_WAYS):
            found[f"{name}.over_{column}"] = _over(*(total_at(each, column, STEPS_END) for each in pair))
        damped = (total_at(each, DAMPED, STEPS_END) - total_at(each, DAMPED, FIT_RANGE[0]) for each in pair)
        found[f"{name}.over_damped_late"] = _over(*damped)
        for value in STEPS_AT:
            both = np.stack([near(each, value) for each in pair], axis=1)
            found[f"{name}.over_pressure_{value:g}"] = measured(of_means(both, lambda mean: mean[0] / mean[1]))
        found[f"{name}.again"] = parted(*pair, 0.1)
        found[f"{name}.over_steps"] = float(np.mean(pair[1]["steps"].values / pair[0]["steps"].values))
    return found


def _over(own, other):
    """Mean of the quotients of single clusters, `Measured`."""
    return Measured(*mean_of(own / other))


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
    # how far a long step pulls at a contact, over what it holds, goes with the inverse square of the strain allowed
    found["silicate_stiffer"] = (STRAIN / longest_strain(silicate, radius)) ** 2
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


def worst_balance(sets, values):
    """The worst balance of energy from 0.1 on of all sets with long steps, over the work."""
    long = [name for name, table in sets.items() if "SemiImplicit" in table.attrs["integrator"]]
    residuals = [values[f"{name}.residual_0.1"] for name in long if f"{name}.residual_0.1" in values]
    return {"long_steps.residual": max(residuals)} if residuals else {}


def findings(sets, entries, spun, lammps=None, box=None, dense=None, springs=None, repeats=None, pulled=None):
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
    springs : pandas.DataFrame, optional
        See `ratd.experiments.compression.springs.of_springs`.
    repeats : dict of str to xarray.Dataset, optional
        Sets that were made once more.
    pulled : xarray.Dataset, optional
        Pulls that were made once more.
    """
    values = {"fit_low": FIT_RANGE[0], "fit_high": FIT_RANGE[1]}
    values["guettler_300"] = float(filling_factor_guettler2009(300.0))
    for name, table in sets.items():
        values |= of_set(name, table)
    values |= of_pairs(sets)
    if repeats:
        values |= of_repeats(sets, repeats, entries, pulled)
    values |= worst_balance(sets, values)
    both = [name for name in (HIGH, BY_SIZE[-1]) if name in sets]
    if len(both) == 2:
        values[f"{HIGH}.over_all"] = quotient(*(values[f"{name}.ratio_0.1"] for name in both))
        values[f"{HIGH}.again"] = parted(*(sets[name] for name in both), 0.1)
    for name, k in LED:
        if name in sets:
            values[f"{name}.led_by_{k}"] = led_by(sets[name], 0.01, k)
    unequal = {name: table for name, table in sets.items() if name in ("lognormal", "mrn")}
    values |= of_monomers(sets.get("equal", sets["base"]), unequal)
    for explicit, names in BESIDE_EXPLICIT.items():
        if explicit in sets:
            values |= of_steps({name: sets[name] for name in names if name in sets}, sets[explicit])
    values |= of_sizes(sets)
    values |= of_rates(sets, values)
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
    if springs is not None:
        values |= of_springs(springs)
    if spun is not None:
        values |= of_spun(spun)
    return values | verdicts(values, sets)
