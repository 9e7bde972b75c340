"""Rows and tables of collisions, from a collision that is made up: what each number is, counted by hand."""

import numpy as np
import pytest
import xarray as xr

from ratd.base.materials import MATERIALS
from ratd.experiments.collision.files import collision_row
from ratd.experiments.collision.run import impact_energy
from ratd.experiments.collision.tables import EARLY, GRID, HALF, LATE, collision_table, mean_energy, threshold_error
from ratd.observables.energy import DISSIPATED, STORED

A, DENSITY, ENERGY = 1e-7, 2000.0, 4e-15
SPHERE = 4.0 / 3.0 * np.pi * DENSITY * A**3
"""Mass of a small sphere; a large one has eight of it."""
TIME = 0.5e-6 * np.arange(7)
MOVING = np.array([1.0, 0.5, 0.25, 0.2, 0.2, 0.2, 0.2])
SPINNING = np.array([0.0, 0.1, 0.1, 0.05, 0.05, 0.05, 0.05])
LOST = dict(zip(DISSIPATED, (0.3, 0.2, 0.1, 0.05, 0.02, 0.01), strict=True))
FIRST = np.array([10.0, 20.0, 16.0, 12.0, 11.0, 10.0, 10.0])
SECOND = np.array([10.0, 0.0, 4.0, 6.0, 7.0, 8.0, 8.0])


@pytest.fixture(scope="module")
def row():
    """A large and two small spheres meet as many: one cluster stays whole, the other falls into its spheres."""
    ramp = TIME / TIME[-1]
    held = np.zeros((7, len(STORED)))
    held[:, 0] = -ENERGY * np.array([0.01, 0.03, 0.9, 0.9, 0.9, 0.9, 0.9])
    run = xr.Dataset(
        {
            "time": ("record", TIME),
            "kinetic_translation": ("record", ENERGY * MOVING),
            "kinetic_spin": ("record", ENERGY * SPINNING),
            "stored": (("record", "storage"), held),
            "dissipated": (("record", "way"), ENERGY * ramp[:, None] * np.array(list(LOST.values()))),
            "residual": ("record", np.zeros(7)),
            "n_contacts": ("record", np.full(7, 2)),
            "n_pieces": ("record", np.full(7, 4)),
            "piece_mass": (("record", "rank"), SPHERE * np.column_stack([FIRST, SECOND])),
            "radius": ("monomer", A * np.array([2.0, 1.0, 1.0, 2.0, 1.0, 1.0])),
            "piece": ("monomer", [0, 0, 0, 1, 2, 3]),
            "cluster": ("monomer", [0, 0, 0, 1, 1, 1]),
        },
        coords={"storage": list(STORED), "way": list(DISSIPATED)},
        attrs={
            "material": "silica", "density": DENSITY, "seed": 3, "steps": 1000, "velocity": 20.0, "timestep": 2e-11,
            "impact_parameter": 0.0, "impact_energy": ENERGY, "balance": 0.001,
        },
    )  # fmt: skip
    names = {"law": "velocity", "cluster": "made up", "friction": "velocity", "source": "none"}
    return collision_row(run, sample=1, damping_time=5e-10, second_contact=0.5, **names)


def test_a_row_counts_spheres_and_masses(row):
    counted = {name: row[name].item() for name in ("n_monomers", "n_pieces", "n_single", "joined")}
    assert counted == {"n_monomers": 6, "n_pieces": 4, "n_single": 3, "joined": 0}
    assert row["mass"].item() == pytest.approx(20 * SPHERE) and row["single_mass"].item() == pytest.approx(10 * SPHERE)
    # 10 and 8 of 20 are in the two heaviest pieces
    assert (row["X"].item(), row["N_s"].item()) == pytest.approx((0.1, 0.1))
    # without the largest sphere of each cluster 2, 1 and 1 of 4
    assert (row["X_rest"].item(), row["N_s_rest"].item()) == pytest.approx((0.25, 0.25))
    assert row["mean_sphere_radius"].item() == pytest.approx(8 / 6 * A) and row["largest_share"].item() == 0.8
    assert row["dissipated_contacts"].values[-1] == pytest.approx(0.03 * ENERGY)
    assert (row["mass_2"].values / SPHERE).tolist() == pytest.approx(SECOND.tolist())


def test_a_table_has_parts_of_the_energy_and_of_the_mass(row):
    found = collision_table([(row, MATERIALS["silica"])]).iloc[0]
    assert found["energy_half"] == pytest.approx(0.6) and found["energy_end"] == pytest.approx(0.25)
    for way in ("damping", "sliding", "rolling", "twisting"):
        assert found[f"by_{way}"] == pytest.approx(LOST[way])
    assert (found["single_share"], found["large_share"]) == pytest.approx((0.5, 0.5))
    # the greatest up to half a microsecond: 0.03 of the impact is stored where 0.6 of it moves
    assert found["potential_share"] == pytest.approx(0.05)
    own = {name: np.interp(then, TIME, value) for name, then, value in (
        ("X_early", EARLY, (FIRST - SECOND) / 20), ("N_s_early", EARLY, 1 - (FIRST + SECOND) / 20),
        ("X_late", LATE, (FIRST - SECOND) / 20),
    )}  # fmt: skip
    assert {name: found[name] for name in own} == pytest.approx(own)


def test_what_ended_too_early_has_no_energy_of_later(row):
    short = row.isel(record=slice(None, 1))
    found = collision_table([(short, MATERIALS["silica"])]).iloc[0]
    assert TIME[0] < HALF and np.isnan(found[["energy_half", "X_early", "X_late"]].to_numpy(float)).all()


def test_the_mean_energy_counts_spins(row):
    series = {name: row[name].values for name in ("time", "kinetic_translation", "kinetic_spin")}
    one = ({"impact_energy": ENERGY, "sample": 1}, xr.Dataset({k: ("i", v) for k, v in series.items()}).to_dataframe())
    time, mean, _ = mean_energy([one, one])
    assert time.tolist() == TIME.tolist() and mean == pytest.approx(MOVING + SPINNING)


def test_the_energy_of_an_impact_is_that_in_the_frame_of_the_centre_of_mass():
    """Two masses of 3 and 1 that near each other at 4: with 1 and 3 in that frame, 3/2 + 9/2."""
    assert impact_energy(3.0, 1.0, 4.0) == pytest.approx(6.0)


def test_the_distance_of_tried_velocities_counts_in_the_error():
    assert threshold_error({"error": 3.0, "above": 30.0, "below": 10.0}) == pytest.approx(np.hypot(3.0, 20.0 * GRID))
    assert GRID == 0.2
