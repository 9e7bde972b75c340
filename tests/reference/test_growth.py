"""The plain generator keeps its own rules, and gives the table that the growth of ratd is compared with."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from reference.growth import grow, porosity

TABLE = Path(__file__).parents[2] / "docs/validation/data/growth_reference.csv"
CONTACTS = {"BA": 1, "BAM1": 2, "BAM2": 3}


def test_a_solid_sphere_has_no_porosity():
    assert porosity(np.zeros((1, 3))) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("kind", CONTACTS)
def test_spheres_touch_as_often_as_their_type_asks_for_and_none_overlaps(kind):
    centres = grow(kind, 60, np.random.default_rng(5))
    distance = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    earlier = np.tril(np.abs(distance - 2.0) < 1e-7, -1).sum(axis=1)
    assert (earlier >= np.minimum(CONTACTS[kind], np.arange(60))).all()
    assert distance[np.tril_indices(60, -1)].min() > 2.0 - 1e-9


def test_the_table_is_what_it_gives():
    row = pd.read_csv(TABLE).set_index(["type", "n_monomers"]).loc[("BAM2", 32)]
    rng = np.random.default_rng(int(row["seed"]))
    found = [porosity(grow("BAM2", 32, rng)) for _ in range(int(row["aggregates"]))]
    assert np.mean(found) == pytest.approx(row["porosity"], abs=1e-4)
