"""Small compressions and pulls, whose numbers are counted once more by slow and obvious means."""

import warnings
from dataclasses import asdict

import numpy as np
import pytest

import ratd
from ratd.base.materials import MATERIALS
from ratd.experiments.compression import tables
from ratd.experiments.compression.monomers import derived_pressure
from ratd.experiments.compression.run import balance_check
from ratd.experiments.compression.tables import DISTANCES, gyration, joined, set_of, typed

RADIUS = 1e-7


@pytest.fixture(scope="module")
def grains():
    return [ratd.grow_bcca(64, seed=seed) for seed in (0, 1)]


@pytest.fixture(scope="module")
def runs(grains):
    return [ratd.compress(grain, 3e-5, 0.25) for grain in grains]


def test_a_table_counts_the_neighbours_of_each_snapshot(grains, runs):
    """Of all images within reach, one by one; no farther than a box and a half."""
    table = set_of(runs, grains)
    steps = np.stack(np.meshgrid(*[np.arange(-4, 5)] * 3, indexing="ij"), -1).reshape(-1, 1, 1, 3)
    for k, run in enumerate(runs):
        for s in range(2):
            position, edge = (run[f"snapshot_{name}"].values[s] / RADIUS for name in ("position", "box_length"))
            apart = position[:, None] - position
            for at in (3, 10):
                within = sum((np.linalg.norm(apart + edge * step, axis=2) <= DISTANCES[at]).sum() for step in steps)
                assert table["number_within"].values[k, s, at] == pytest.approx(within / 64)
            there = np.isfinite(table["number_within"].values[k, s])
            assert DISTANCES[there].max() < 1.5 * edge <= DISTANCES[~there].min()


def test_a_snapshot_is_that_of_the_first_record_beyond_what_was_asked(runs):
    phi = runs[0]["phi"].values
    for k, asked in enumerate((0.03, 0.1)):
        assert runs[0]["snapshot_phi"].values[k] == phi[np.searchsorted(phi, asked)]
    assert runs[0]["phi_mean"].values[1:] == pytest.approx(np.sqrt(phi[1:] * phi[:-1]), rel=1e-12)


def test_radii_come_back_in_the_order_of_the_grain():
    grain = ratd.grow("BA", a_eff=150e-9, material="q-S", seed=1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = ratd.compress(grain, 1e-4, 0.3, balance=False)
    assert (run["radius"].values == grain.radius).all() and len(np.unique(grain.radius)) > 3


def test_the_strength_of_a_pull_is_where_its_mean_of_four_records_is_greatest(runs):
    pulled = ratd.stretch(runs[0], 3e-5)
    best = np.argmax(np.convolve(pulled["tension"], np.full(4, 0.25), "valid"))
    assert pulled.attrs["phi_strength"] == pytest.approx(pulled["phi_mean"].values[best : best + 4].mean())
    # a pull counts its own losses
    assert pulled["dissipated_rolling"].values[0] < 0.1 * runs[0]["dissipated_rolling"].values[-1]


def test_a_pull_along_all_axes_has_equal_edges_and_the_mean_tension(runs):
    pulled = ratd.stretch(runs[0], 3e-5, axes="xyz")
    edges = pulled["box_length"].values
    assert edges == pytest.approx(np.tile(edges[:, :1], 3)) and (np.diff(edges[:, 0]) > 0).all()
    assert pulled["tension"].values == pytest.approx(-pulled["pressure_tensor"].values[:, :3].mean(axis=1))


def test_the_derived_pressure_goes_with_the_sixth_power_of_the_length():
    """E l^6/v^3 for l^3 = 8 v: 64 E/v."""
    assert derived_pressure(1e-16, 2e-7, 1e-21) == pytest.approx(64 * 1e-16 / 1e-21)


def test_dense_clusters_are_held_to_a_stricter_balance_and_long_steps_to_a_milder_one():
    zero = {"phi": 0.1, "work": 0.0, "energy_residual": 0.0, "n_contacts": 10.0, "dissipated_damping": 0.0}
    zero |= {"stored_normal": 0.0}
    check = balance_check({0.0: 0.2, 0.3: 0.002}, {0.0: 0.2, 0.3: 0.1}, "take other steps")
    row = zero | {"work": 1.0, "energy_residual": 0.05}
    check(row, zero, False)
    check(row | {"phi": 0.4}, zero, True)
    # what was lost counts too
    check(zero | {"dissipated_damping": 1.0, "energy_residual": 0.05}, zero, False)
    for wrong, long in ((row | {"phi": 0.4}, False), (row | {"phi": 0.4, "energy_residual": 0.15}, True)):
        with pytest.raises(RuntimeError, match="that the box worked or friction took: take other steps"):
            check(wrong, zero, long)


def test_tables_of_some_seeds_join_to_that_of_all(grains, runs):
    """Runs that begin and end in other bins."""
    later = runs[1].isel(record=slice(3, -4))
    whole = typed(set_of([runs[0], later], grains).assign(mean_square_gyration=1.0, mean_square_gyration_error=0.1))
    parts = [
        typed(set_of([run], [grain]).assign(mean_square_gyration=1.0, mean_square_gyration_error=0.1))
        for run, grain in zip((runs[0], later), grains, strict=True)
    ]
    table = joined(*parts)
    assert set(table.variables) == set(whole.variables) and table.attrs["law"] == whole.attrs["law"]
    for name in whole.variables:
        # means of the radii are of the first table
        if name not in ("mean_radius", "mean_square_radius"):
            np.testing.assert_allclose(table[name].values, whole[name].values, rtol=1e-12, err_msg=name)
    assert joined(*parts[::-1])["seed"].values.tolist() == [0, 1]
    with pytest.raises(ratd.InputError, match="both tables have the seed 1; each seed may be in one of them"):
        joined(parts[1], whole)
    with pytest.raises(ratd.InputError, match="they differ in scheme, strain_rate"):
        other = parts[1].assign(strain_rate=2.0 * parts[1]["strain_rate"]).assign_attrs(scheme="as_printed")
        joined(parts[0], other)


def test_the_radius_of_gyration_of_a_set_is_that_of_many_clusters(monkeypatch):
    monkeypatch.setattr(tables, "GYRATION_SEEDS", 3)
    settings = {"material": asdict(MATERIALS["ice"]), "n": 64, "radius": 1e-7, "radii": None, "copies": False}
    squares = []
    for seed in range(3):
        position = ratd.grow_bcca(64, seed=seed).position
        apart = position[:, None] - position
        squares.append((apart**2).sum() / (2 * 64**2))
    mean, error = gyration(settings)
    assert mean == pytest.approx(np.mean(squares)) and error == pytest.approx(np.std(squares, ddof=1) / 3**0.5)
