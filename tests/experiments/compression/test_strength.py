"""Fits of the compressive strength to data that are known."""

import warnings

import numpy as np
import pytest
import xarray as xr

import ratd
from ratd.base.materials import MATERIALS
from ratd.experiments.compression import losses, pairs, strength
from ratd.experiments.compression.monomers import derived_pressure
from ratd.experiments.compression.strain import LABELS
from ratd.experiments.compression.tables import BIN, bins, in_bins, mean_rolling_energy

P_0 = 5e5


def table_of(law, seeds=5, scatter=0.0, last=0.5):
    """A table with pressures after a law of phi, each seed off by a factor of its own."""
    phi = BIN ** (np.arange(bins(0.004), bins(last)) + 0.5)
    factor = np.exp(scatter * np.random.default_rng(0).normal(size=seeds))
    table = xr.Dataset({"phi": ("phi_bin", phi)})
    table["pressure"] = (("seed_number", "phi_bin"), factor[:, None] * law(phi))
    table["rolling_pressure"] = ("seed_number", np.full(seeds, P_0))
    return table


def test_the_power_law_is_found_with_its_error():
    fit = strength.fit_power_law(table_of(lambda phi: 0.8 * P_0 * phi**3.2 * 0.1**-0.2))
    assert fit.value[:2] == pytest.approx([3.2, 0.8]) and fit.error == pytest.approx([0, 0, 0], abs=1e-12)
    scattered = strength.fit_power_law(table_of(lambda phi: P_0 * phi**3, seeds=400, scatter=0.2))
    assert scattered.value[0] == pytest.approx(3.0)
    assert scattered.value[2] == pytest.approx(np.exp(0.02), rel=0.03)
    # of a lognormal factor: sigma e^(sigma^2/2)/sqrt(n), nearly
    assert scattered.error[2] == pytest.approx(0.2 / 20, rel=0.15)


def test_a_single_seed_has_no_error():
    fit = strength.fit_power_law(table_of(lambda phi: P_0 * phi**3, seeds=1))
    assert np.isnan(fit.error).all() and fit.n == 1


def test_the_greatest_filling_factor_is_found():
    fit = strength.fit_with_limit(table_of(lambda phi: 0.6 * P_0 * (1 / phi - 1 / 0.7) ** -3))
    assert fit.value == pytest.approx([0.6, 0.7])


def test_the_filling_factor_at_a_pressure_is_found():
    table = table_of(lambda phi: P_0 * phi**3)
    assert strength.phi_at(table, P_0 * 0.2**3).value == pytest.approx([0.2])
    # beyond both ends of what is known
    assert all(np.isnan(strength.phi_at(table, P_0 * phi**3).value).all() for phi in (0.03, 0.6))
    assert strength.ratio_at(table, 0.1).value == pytest.approx([1.0])
    # also at the end of a table, where there are no bins above
    steep = table_of(lambda phi: P_0 * phi**3 * (1.0 + 5.0 * np.log(phi)))
    end = steep["phi"].values[-1] / 1.02
    assert strength.ratio_at(steep, end).value == pytest.approx([1.0 + 5.0 * np.log(end)])
    # where it bends, a straight line through the bins within 11 % would be 2 % too high
    bent = table_of(lambda phi: P_0 * phi**3 * (phi / 0.3) ** 3.3)
    assert strength.ratio_at(bent, 0.3).value == pytest.approx([1.0], rel=2e-3)
    scatter = strength.scatter_at(table_of(lambda phi: P_0 * phi**3, 500, 0.1), 0.1)
    assert scatter.value == pytest.approx(0.1, rel=0.15)
    # of a normal distribution it is known to 1/sqrt(2 n)
    assert scatter.error == pytest.approx(0.1 / np.sqrt(1000), rel=0.3)


def test_from_where_on_the_pressure_is_above_the_line():
    table = table_of(lambda phi: P_0 * phi**3 * (phi / 0.14) ** 0.5)
    assert strength.crosses_line(table, 0.3).value == pytest.approx([0.14], rel=1e-3)
    for factor in (0.5, 2.0):
        assert np.isnan(strength.crosses_line(table_of(lambda phi, f=factor: f * P_0 * phi**3), 0.3).value)


def test_the_local_power_of_a_curve_that_bends_is_found():
    """d ln P/d ln phi of (1/phi - 1/0.6)^-3 is 3/(1 - phi/0.6)."""
    bent = table_of(lambda phi: P_0 * (1.0 / phi - 1.0 / 0.6) ** -3)
    for phi in (0.1, 0.3, 0.4):
        assert strength.power_at(bent, phi).value == pytest.approx([3.0 / (1.0 - phi / 0.6)], rel=1e-2)
    assert np.isnan(strength.power_at(table_of(lambda phi: phi - 0.1), 0.1).value).all()


def test_what_is_lost_up_to_a_filling_factor_is_read_there_and_not_at_the_next_bin():
    table = table_of(lambda phi: P_0 * phi**3, seeds=2)
    x = np.log(table["phi"].values)
    table["dissipated_rolling"] = (("seed_number", "phi_bin"), np.array([x, np.where(x < np.log(0.1), x, np.nan)]))
    assert losses.total_at(table, "dissipated_rolling", 0.0501)[0] == pytest.approx(np.log(0.0501))
    assert np.isnan(losses.total_at(table, "dissipated_rolling", 0.2)).tolist() == [False, True]
    assert np.isnan([losses.total_at(table, "dissipated_rolling", phi) for phi in (0.001, 0.7)]).all()


def test_from_where_on_an_energy_is_lost():
    table = table_of(lambda phi: P_0 * phi**3)
    table["dissipated_sliding"] = (("seed_number", "phi_bin"), np.tile(1e-13 * table["phi"].values ** 5, (5, 1)))
    assert losses.lost_from(table, "sliding", 1e-13 * 0.2**5).value == pytest.approx([0.2])
    assert losses.lost_from(table, "sliding", 1e-13 * 0.2**5).error == pytest.approx([0.0], abs=1e-12)
    assert np.isnan(losses.lost_from(table, "sliding", 1.0).value).all()


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        ([], "run is an empty list; it must be what ratd.compress returned"),
        (5, "run is of type int; it must be"),
        (xr.Dataset(), "run is the Dataset of something else; it must be"),
    ],
)
def test_what_is_no_compression_has_no_strength(runs, said):
    with pytest.raises(ratd.InputError, match=said):
        ratd.compressive_strength(runs)


def test_runs_of_several_materials_are_not_one_set():
    runs = [of_one(P, rolling_pressure=P) for P in (P_0, 2 * P_0)]
    with pytest.raises(
        ratd.InputError, match="the runs have P_0 from 5e.05 to 1e.06 Pa; they may differ in their seeds"
    ):
        ratd.compressive_strength(runs)


def of_one(pressure, **attrs):
    """A run whose pressure is a number times phi^3."""
    phi = np.geomspace(0.02, 0.2, 60)
    values = {"phi": phi, "phi_mean": phi, "pressure": pressure * phi**3}
    values = {name: ("record", numbers) for name, numbers in values.items()}
    values["pressure_tensor"] = (("record", "component"), np.zeros((60, 6)))
    return xr.Dataset(values, attrs={"rolling_pressure": P_0, "strain_rate": 1e-6, "n_monomers": 64} | attrs)


@pytest.mark.parametrize(("name", "value"), [("strain_rate", 1e-3), ("n_monomers", 128), ("law", "dmt()")])
def test_runs_that_differ_in_more_than_their_seeds_are_not_one_set(name, value):
    both = [of_one(P_0, law="jkr()"), of_one(0.9 * P_0, **{"law": "jkr()", name: value})]
    with pytest.raises(ratd.InputError, match=f"the runs have {name} .* they may differ in their seeds alone"):
        ratd.compressive_strength(both)


def test_a_run_without_records_has_no_strength():
    with pytest.raises(ratd.InputError, match="run has no records: it ended before the first one"):
        ratd.compressive_strength(of_one(P_0).isel(record=slice(0, 0)))


def test_a_run_counts_once():
    runs = [of_one(P_0), of_one(0.9 * P_0), of_one(P_0)]
    with pytest.raises(ratd.InputError, match="the runs 0 and 2 are the same one; each may be given once"):
        ratd.compressive_strength(runs)


def test_clusters_of_unequal_monomers_have_each_their_own_rolling_pressure():
    with pytest.warns(UserWarning, match="inertia dominates"):
        run = ratd.compress(ratd.grow_bcca(64, seed=1), 1e-3, 0.15, balance=False)
    other = run.assign(pressure=0.9 * 1.05 * run["pressure"])
    other = other.assign_attrs(rolling_pressure=1.05 * run.attrs["rolling_pressure"])
    alone = ratd.compressive_strength(run)["ratio"]
    assert ratd.compressive_strength([run, other])["ratio"] == pytest.approx(0.95 * alone)


def test_runs_that_begin_later_count_as_nothing_or_not_at_all():
    table = table_of(lambda phi: P_0 * phi**3, seeds=2)
    table["pressure"].values[0, :10] = np.nan
    mean, error = strength.mean_pressure(table)
    assert np.isnan(mean[:10]).all() and np.isfinite(mean[10:]).all()
    alone, _ = strength.mean_pressure(table, alone=True)
    assert alone[:10] == pytest.approx(0.5 * table["pressure"].values[1, :10])
    assert error[10:] == pytest.approx(np.zeros(len(error) - 10))


def test_who_overtakes_whom():
    table = table_of(lambda phi: P_0 * phi**3)
    phi = table["phi"].values
    for way, energy in (("sliding", phi**6), ("rolling", phi**3 * 0.5 * 0.2**3)):
        table[f"dissipated_{way}"] = (("seed_number", "phi_bin"), np.tile(energy, (5, 1)))
    # 6 phi^6 = 1.5 phi^3 0.2^3
    found = losses.overtakes(table, "sliding", "rolling")
    assert found.value == pytest.approx(0.2 * 0.25 ** (1 / 3), rel=0.01)
    assert found.error == pytest.approx(0.0, abs=1e-12)
    assert np.isnan(losses.overtakes(table, "rolling", "sliding").value)
    # of clusters that cross at other filling factors
    scale = np.exp(np.random.default_rng(0).normal(0.0, 0.1, 5))[:, None]
    table["dissipated_sliding"] = (("seed_number", "phi_bin"), scale * phi**6)
    found = losses.overtakes(table, "sliding", "rolling")
    # 2 phi^3 = 0.5 0.2^3/scale: phi goes with the cube root of the mean scale
    expected = 0.2 * (0.25 / scale.mean()) ** (1 / 3)
    assert found.value == pytest.approx(expected, rel=0.01)
    assert found.error == pytest.approx(found.value / 3 * scale.std(ddof=1) / np.sqrt(5) / scale.mean(), rel=0.3)


def test_a_range_without_data_is_one_sentence():
    with pytest.raises(ratd.InputError, match="no run covers the filling factors from 0.1 to 0.5"):
        strength.fit_with_limit(table_of(lambda phi: phi, last=0.2))


def test_means_over_bins_are_those_of_the_records():
    phi = 0.01 * 1.01 ** np.arange(400)
    run = xr.Dataset({"phi": ("record", phi * 1.005), "phi_mean": ("record", phi), "pressure": ("record", phi**3)})
    run["pressure_tensor"] = (("record", "component"), phi[:, None] * np.arange(1.0, 7.0))
    for name in ("n_contacts", "work", "energy_residual", "stored_normal", "dissipated_rolling"):
        run[name] = ("record", phi)
    first, last = bins(0.01), bins(0.5)
    binned = in_bins(run, first, last)
    for k, number in enumerate(range(first, last + 1)):
        inside = (phi >= BIN**number) & (phi < BIN ** (number + 1))
        assert binned["pressure"][k] == pytest.approx(np.mean(phi[inside] ** 3))
        assert binned["work"][k] == pytest.approx(BIN ** (number + 0.5), rel=0.011)
        along = [binned[f"pressure_{name}"][k] for name in LABELS["component"]]
        assert along == pytest.approx(np.mean(phi[inside]) * np.arange(1.0, 7.0))


def test_the_rolling_energy_of_unequal_spheres_goes_with_their_reduced_radius():
    """12 pi^2 gamma R xi_c, R = 75 nm of spheres of 100 and 300 nm; of equal ones 6 pi^2 gamma r_0 xi_c."""
    ice = MATERIALS["ice"]
    pair = ratd.Grain(np.array([[0, 0, 0], [4e-7, 0, 0]]), np.array([1e-7, 3e-7]), "ice")
    expected = 12 * np.pi**2 * ice.surface_energy * 7.5e-8 * ice.critical_rolling_displacement
    assert mean_rolling_energy(pair) == pytest.approx(expected, rel=1e-6)


def test_compressive_strength_of_runs():
    runs = [ratd.compress(ratd.grow_bcca(64, seed=seed), 3e-5, 0.25) for seed in (0, 1)]
    found = ratd.compressive_strength(runs)
    assert found["n"] == 2 and 0.1 < found["ratio"] < 10.0 and found["ratio_error"] > 0.0
    alone = ratd.compressive_strength(runs[0], 0.05, 0.2)
    assert alone["n"] == 1 and np.isnan(alone["exponent_error"])


def test_a_range_that_no_run_covers_has_no_strength():
    phi = np.geomspace(0.1, 0.5, 400)
    run = xr.Dataset({name: ("record", phi) for name in ("phi", "phi_mean")}, attrs={"rolling_pressure": P_0})
    run["pressure"] = ("record", P_0 * phi**3)
    run["pressure_tensor"] = (("record", "component"), np.zeros((400, 6)))
    for name in ("n_contacts", "work", "energy_residual", "stored_normal", "dissipated_rolling"):
        run[name] = ("record", phi)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = ratd.compressive_strength(run.assign_attrs(static_from=0.12), 0.12, 0.4)
    assert found["exponent"] == pytest.approx(3.0, rel=1e-3)
    with pytest.warns(UserWarning, match="static from phi = 0.2 on: between low = 0.12 and there inertia presses"):
        ratd.compressive_strength(run.assign_attrs(static_from=0.2), 0.12, 0.4)
    for low, high, said in (
        (0.03, 0.12, "no run covers the filling factors from 0.03 to 0.12"),
        (0.12, 0.6, "no run covers"),
        (0.12, 0.125, "a power law needs 3 at least"),
        (0.3, 0.2, "the lower one first"),
        ("a", 0.2, "must be numbers above 0"),
    ):
        with pytest.raises(ratd.InputError, match=said):
            ratd.compressive_strength(run, low, high)


def test_equal_monomers_are_a_case_of_unequal_ones():
    E_roll, r_0 = 4.7e-16, 1e-7
    assert derived_pressure(E_roll, r_0, r_0**3) == pytest.approx(E_roll / r_0**3)


def test_sets_are_compared_on_the_clusters_that_both_have():
    """The scatter that clusters share drops out; seeds of one set alone do not count."""
    table = table_of(lambda phi: 0.8 * P_0 * phi**3.2 * 0.1**-0.2, seeds=4, scatter=0.5)
    other = table_of(lambda phi: P_0 * phi**3, seeds=6, scatter=0.5)
    table["seed"], other["seed"] = ("seed_number", [0, 1, 2, 3]), ("seed_number", range(6))
    found = strength.compared(table, other)
    alone = strength.fit_power_law(table_of(lambda phi: 0.8 * P_0 * phi**3.2 * 0.1**-0.2)).value
    assert found.n == 4 and found.value == pytest.approx([alone[2], 0.2])
    assert found.error == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_cluster_counts_where_both_of_its_runs_reach_all_of_the_range():
    """Whichever each set lacks, and in whatever order and bins they stand, a cluster stands beside itself."""
    table, other = (table_of(lambda phi, f=f: f * P_0 * phi**3, seeds=6, scatter=0.5) for f in (0.8, 1.0))
    table["seed"] = other["seed"] = ("seed_number", range(6))
    table["pressure"][0, -50:], other["pressure"][3, -50:] = np.nan, np.nan
    fewer = other.copy(deep=True)
    fewer["pressure"][4, -50:] = np.nan
    turned = other.isel(seed_number=[5, 3, 4, 1, 2, 0], phi_bin=slice(53, None))
    for own, n in ((other, 4), (fewer, 3), (turned, 4)):
        found = strength.compared(table, own)
        assert found.n == n and found.value == pytest.approx([0.8, 0.0], abs=1e-9)
        assert found.error == pytest.approx([0.0, 0.0], abs=1e-9)
    with pytest.raises(ratd.InputError, match="no run covers the filling factors from 0.03 to 0.12"):
        strength.compared(table.isel(seed_number=[0, 3]), other.isel(seed_number=[0, 3]))


def test_pressures_along_the_axes_and_their_spread():
    table = table_of(lambda phi: P_0 * phi**3)
    for name, part in (("xx", 1.2), ("yy", 1.0), ("zz", 0.8)):
        table[f"pressure_{name}"] = part * table["pressure"]
    assert strength.anisotropy(table) == pytest.approx(np.full(table.sizes["phi_bin"], 0.2))
    assert strength.along_axes(table, 0.1).value == pytest.approx([1.2, 1.0, 0.8])


def test_shares_are_of_all_that_is_lost():
    table = table_of(lambda phi: P_0 * phi**3, seeds=3)
    for part, way in enumerate(losses.DISSIPATED):
        table[f"dissipated_{way}"] = part * table["pressure"]
    shares = [losses.share_at(table, way, 0.1).value[0] for way in losses.DISSIPATED]
    assert shares == pytest.approx(np.arange(6) / 15)


def test_the_slope_far_away_ends_at_half_of_the_monomers():
    distance = np.geomspace(2.0, 200.0, 30)
    number = np.minimum(0.5 * distance**3, 1000.0)
    table = xr.Dataset({"distance": ("distance_number", distance), "n_monomers": ((), 1000)})
    table["number_within"] = (("seed_number", "snapshot", "distance_number"), np.tile(number, (2, 1, 1)))
    assert strength.far_slope_of_structure(table, 0).value == pytest.approx([3.0])
    assert strength.log_slope(distance, np.tile(number, (2, 1))).value[0] < 2.5


def test_few_clusters_may_bear_the_pressure_of_a_set():
    table = table_of(lambda phi: P_0 * phi**3, seeds=4)
    table["pressure"] = table["pressure"] * xr.DataArray([1.0, 5.0, 0.0, 4.0], dims="seed_number")
    assert [strength.led_by(table, 0.01, k) for k in (1, 2, 3)] == pytest.approx([0.5, 0.9, 1.0])


def test_the_part_of_the_work_that_goes_one_way_is_that_between_two_filling_factors():
    table = table_of(lambda phi: P_0 * phi**3, seeds=3)
    x = np.log(table["phi"].values)
    of_seed = np.array([1.0, 2.0, 3.0])[:, None]
    table["work"] = (("seed_number", "phi_bin"), 7.0 + of_seed * x)
    table["dissipated_rolling"] = (("seed_number", "phi_bin"), 0.25 * of_seed * x + [[0.0], [1.0], [5.0]])
    fit = losses.part_of_work(table, "rolling", 0.01, 0.02)
    assert fit.value == pytest.approx([0.25]) and fit.error == pytest.approx([0.0], abs=1e-9)


def test_clusters_that_met_copies_stand_beside_those_that_met_others():
    """Means over each other, and what the mean of ten single ones is known to."""
    others = table_of(lambda phi: 0.8 * P_0 * phi**3, seeds=5)
    copies = table_of(lambda phi: P_0 * phi**3, seeds=400, scatter=0.5)
    found = pairs._of_copies({"copies_4096": copies, "rate_1e-6": others})
    mean, spread = np.exp(0.125), np.sqrt(np.exp(0.25) - 1.0)
    assert found["copies_4096.over_others_0.05"].value == pytest.approx(mean / 0.8, rel=0.06)
    assert found["copies_4096.over_others_0.05"].error == pytest.approx(mean * spread / 20 / 0.8, rel=0.15)
    assert found["copies_4096.of_ten_0.05"] == pytest.approx(spread / 10**0.5, rel=0.15)
    assert pairs._of_copies({"copies_4096": copies}) == {}
