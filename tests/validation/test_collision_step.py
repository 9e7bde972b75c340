"""Collisions of small clusters with two steps, and what the page makes of them."""

import numpy as np
import pandas as pd

from ratd.validation import collision_step, findings

TINY = {
    "number": 60, "largest": 200e-9, "filling_factor": 0.2, "second_contact": 0.5, "sample": 0, "velocity": 30.0,
    "rotation": 0, "timestep": [3.5e-12, 1.75e-12], "duration": 1e-8, "early": 5e-9,
}  # fmt: skip


def test_the_same_collision_is_computed_with_each_step():
    said = []
    rows = collision_step.compute(TINY, said.append)
    assert [row["timestep"] for row in rows] == TINY["timestep"] and len(said) == 2
    assert all(row.keys() == collision_step.COLUMNS.keys() for row in rows)
    one, other = rows
    assert one["n_monomers"] == 60 and 0.0 < one["energy_late"] < one["energy_early"] < 1.0
    # before chaos has had time
    assert abs(one["energy_early"] - other["energy_early"]) < 1e-3 and one["energy_early"] != other["energy_early"]


def table(change):
    """Rows of 4 clusters, in which half the step adds `change` to N_s, and noise of 0.01."""
    noise = np.random.default_rng(0).normal(scale=0.01, size=(4, 6))
    shared = {"material": "silica", "type": "cluster", "a_eff": 1e-6, "velocity": 30.0, "X": 0.1}
    shared |= {"energy_early": 0.2, "energy_late": 0.1}
    return pd.DataFrame(
        shared
        | {"seed": seed, "rotation": rotation, "timestep": step, "N_s": 0.3 + half * (change + noise[seed, rotation])}
        for seed in range(4)
        for rotation in range(6)
        for half, step in enumerate((3.5e-12, 1.75e-12))
    )


def test_the_change_and_its_error_are_those_of_the_clusters():
    found = findings.of_collision_step(table(0.02))
    assert found["collision_step.pairs"] == 24 and found["collision_step.clusters"] == 4
    assert abs(found["collision_step.N_s"].value - 0.02) < 0.01 and 0.0 < found["collision_step.N_s"].error < 0.01
    assert found["collision_step.X"].value == 0.0 and found["collision_step.verdict"] == "met"
    assert findings.of_collision_step(table(0.05))["collision_step.verdict"] == "open"
    assert findings.of_collision_step(table(0.2))["collision_step.verdict"] == "missed"
