"""Small compressions and pulls, whose numbers are counted once more by slow and obvious means."""

import warnings

import numpy as np
import pytest

import ratd
from ratd.experiments.compression.monomers import derived_pressure
from ratd.experiments.compression.run import balance_check
from ratd.experiments.compression.tables import DISTANCES, set_of

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
    check = balance_check({0.0: 0.2, 0.3: 0.002}, {0.0: 0.2, 0.3: 0.1})
    row = zero | {"work": 1.0, "energy_residual": 0.05}
    check(row, zero, False)
    check(row | {"phi": 0.4}, zero, True)
    # what was lost counts too
    check(zero | {"dissipated_damping": 1.0, "energy_residual": 0.05}, zero, False)
    for wrong, long in ((row | {"phi": 0.4}, False), (row | {"phi": 0.4, "energy_residual": 0.15}, True)):
        with pytest.raises(RuntimeError):
            check(wrong, zero, long)
