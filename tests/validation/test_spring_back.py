"""A squeezed cluster whose box grows again gives back what its springs held, and not what friction took."""

import numpy as np
import pandas as pd
import pytest

from ratd.experiments.compression.springs import of_springs
from ratd.pipeline import io
from ratd.validation import spring_back
from ratd.validation.tables import as_dataset

SMALL = {
    "material": "ice", "n": 256, "seed": 1, "strain_rate": 1e-5, "until_phi": 0.1, "timestep_factor": 0.14
}  # fmt: skip


@pytest.fixture(scope="module")
def rows():
    return spring_back.compute(SMALL)


def test_no_more_comes_back_than_the_springs_held(rows):
    found = of_springs(pd.DataFrame(rows))
    back, held = (found[f"springs.{name}_0.1"].value for name in ("back", "held"))
    assert 0.0 < back < held < 0.2
    assert found["springs.of_held_0.1"].value == pytest.approx(back / held)
    # the box did more than half of its work since half the filling factor
    assert back < found["springs.last_0.1"].value < 2.0 * back
    assert 0.8 < found["springs.until_0.1"].value < 1.0
    assert found["springs.n_0.1"] == 1


def test_the_box_turns_where_the_squeeze_ended(rows):
    table = pd.DataFrame(rows)
    into, out = (table[table["way"] == way] for way in ("in", "out"))
    assert into["phi"].is_monotonic_increasing and out["phi"].is_monotonic_decreasing
    assert into["phi"].iloc[-1] == pytest.approx(0.1, rel=1e-3)
    assert out["phi"].iloc[0] == pytest.approx(0.1 * np.exp(-3.0 * spring_back.RECORD), rel=1e-3)
    # work is pressure times volume, in both ways: E_roll/r_0^3 times the volume of the monomers over phi
    for part in (into, out):
        part = part[part["phi"] > 0.093]
        size = 4.0 / 3.0 * np.pi * 256 / part["phi"].to_numpy() / 4.737e5
        done = -np.sum(part["pressure"].to_numpy()[1:] * np.diff(size))
        assert done == pytest.approx(part["work"].iloc[-1] - part["work"].iloc[0], rel=0.02)


def test_nothing_presses_any_more_when_no_work_has_come_back_for_long():
    falls = -np.arange(50.0)
    assert not spring_back.over(falls[:5]) and not spring_back.over(falls)
    turned = np.concatenate([falls, falls[::-1]])
    assert not spring_back.over(turned[: 49 + spring_back.GONE]) and spring_back.over(turned[: 52 + spring_back.GONE])


def test_rows_make_a_file_of_the_check(rows, tmp_path):
    io.write(tmp_path / "a.nc", as_dataset(rows, spring_back.KIND), spring_back.KIND)
    assert io.read(tmp_path / "a.nc", spring_back.KIND).sizes["case"] == len(rows)


def test_a_spring_gives_back_all_and_friction_nothing():
    """Two clusters whose springs gave back a half of what they held, of as much work; friction took a tenth of that."""
    rows = []
    for seed, size in ((0, 1.0), (1, 3.0)):
        own = {"seed": seed, "until_phi": 0.1}
        into = [(0.04, 0.1, 0.1), (0.051, 1.0, 0.9), (0.1, 2.0, 2.0)]
        out = [(0.09, -0.5, 1.4, 0.02), (0.08, -1.0, 0.9, 0.1), (0.07, -0.8, 1.1, 0.2)]
        for phi, work, held in into:
            rows.append(own | dict(way="in", phi=phi, work=size * work, rolling=size * held, twisting=0.0, lost=0.0))
        for phi, work, held, lost in out:
            springs = dict(rolling=0.0, twisting=size * held)
            rows.append(own | dict(way="out", phi=phi, work=size * work, lost=size * lost) | springs)
    found = {name.removeprefix("springs."): value for name, value in of_springs(pd.DataFrame(rows)).items()}
    assert found.pop("n_0.1") == 2
    wanted = {"back": 0.5, "of_held": 0.5, "held": 1.0, "last": 1.0, "friction": 0.1, "kept": 0.45, "until": 0.8}
    for name, value in wanted.items():
        assert found[f"{name}_0.1"] == pytest.approx((value, 0.0), abs=1e-12), name
