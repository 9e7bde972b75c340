"""Which equal spheres a cluster is like: made-up curves whose answer is known."""

import numpy as np
import pandas as pd
import pytest

from ratd.experiments.collision.likeness import likeness, likeness_table, of_equal_spheres

RADII = np.array([0.3e-6, 0.4e-6, 0.5e-6])
SPEEDS = [10.0, 20.0]


def rows(value, rng, number=20, scatter=0.01, velocities=SPEEDS):
    table = [(v, value(v) + scatter * rng.normal()) for v in velocities for _ in range(number)]
    return pd.DataFrame(table, columns=["velocity", "X"])


def curve(radius):
    """Linear in ln r, as the interpolation is."""
    return lambda v: 0.5 + 0.4 * np.log(radius / RADII[0]) + 0.01 * v


def test_a_known_radius_is_found():
    rng = np.random.default_rng(1)
    equal = {radius: rows(curve(radius), rng) for radius in RADII}
    found = likeness(rows(curve(0.44e-6), rng), equal, "X", samples=100)
    assert found["velocities"] == 2 and found["at_end"] == 0.0 and found["misfit"] < 0.01
    assert found["radius_low"] <= found["radius"] <= found["radius_high"]
    assert found["radius"] == pytest.approx(0.44e-6, abs=3 * (found["radius_high"] - found["radius_low"]))
    assert found["radius_high"] - found["radius_low"] < 0.03e-6


def test_equal_spheres_are_those_of_the_usual_contacts():
    table = pd.DataFrame(
        {"largest_radius": [1.0, 1, 1, 2], "mean_sphere_radius": 1.0, "second_contact": [0.3, 0.3, 0.5, 0.3]}
    )
    assert list(of_equal_spheres(table).index) == [0, 1]
    assert of_equal_spheres(table[:0]).empty


def test_what_lies_beyond_all_radii_is_told():
    rng = np.random.default_rng(2)
    equal = {radius: rows(curve(radius), rng) for radius in RADII}
    found = likeness(rows(lambda v: 3.0, rng), equal, "X", samples=20)
    assert found["at_end"] == 1.0 and found["radius"] == pytest.approx(RADII[-1]) and found["misfit"] > 1.0


def test_without_a_common_velocity_there_is_no_answer():
    rng = np.random.default_rng(3)
    equal = {radius: rows(curve(radius), rng) for radius in RADII}
    found = likeness(rows(curve(0.4e-6), rng, velocities=[11.0]), equal, "X")
    assert found["velocities"] == 0 and np.isnan(found["radius"])


def test_table():
    rng = np.random.default_rng(4)
    parts = []
    for radius in (*RADII, 0.42e-6):
        own = rows(curve(radius), rng)
        mixed = radius == 0.42e-6
        parts.append(
            own.assign(
                law="velocity", cluster="mrn" if mixed else f"{radius:g}", impact_parameter=0.0, second_contact=0.5,
                largest_radius=1e-6 if mixed else radius, mean_sphere_radius=radius, N_s=1 - own["X"],
                energy_half=own["X"] / 2,
            )
        )  # fmt: skip
    found = likeness_table(pd.concat(parts, ignore_index=True), samples=20)
    assert found["quantity"].tolist() == ["X", "N_s", "energy_half"] and (found["cluster"] == "mrn").all()
    np.testing.assert_allclose(found["radius"], 0.42e-6, rtol=0.05)


def test_without_unequal_spheres_the_table_has_no_rows_and_its_types():
    rng = np.random.default_rng(5)
    own = rows(curve(RADII[0]), rng).assign(
        law="velocity", cluster="a", impact_parameter=0.0, second_contact=0.5, largest_radius=RADII[0],
        mean_sphere_radius=RADII[0], N_s=0.0, energy_half=0.0,
    )  # fmt: skip
    found = likeness_table(own, samples=20)
    assert len(found) == 0 and found["velocities"].dtype == found["radius"].dtype == float
