"""Grains that are looked at on their way to the break: the looks, the queue, and what is told of them."""

import numpy as np
import pandas as pd
import pytest

import ratd
from ratd.base.units import NM
from ratd.experiments.spin_up import plan as plans
from ratd.experiments.spin_up import shapes
from ratd.experiments.spin_up.findings.shapes import of_shapes, scatter_ratio
from ratd.geometry.shape import Shape
from ratd.pipeline.queue import work


@pytest.fixture(scope="module")
def grain():
    return ratd.grow("BA", 130 * NM, "q-S", 2)


@pytest.fixture(scope="module")
def run(grain):
    return ratd.spin_up(grain, epsilon=0.3, snapshot_every=1)


def test_a_look_tells_the_shape_of_what_is_left_at_that_record(grain, run):
    found = shapes.looks(run)
    assert list(found) == list(shapes.LOOKS)
    assert found["disruption"]["omega"] == ratd.disruption(run)["omega_disr"].item()
    for when, look in found.items():
        (record,) = np.flatnonzero(run["omega"].values == look["omega"])
        picture = run.isel(snapshot=np.flatnonzero(run["snapshot_omega"].values == look["omega"])[0])
        largest = picture["snapshot_fragment"].values == 0
        assert largest.sum() == run["n_monomers"].values[record]
        position = np.stack([picture[f"snapshot_{axis}"].values[largest] for axis in "xyz"], axis=1)
        own = Shape.measure(position, grain.radius[largest], grain.material.density, 0)
        assert look["porosity"] == pytest.approx(own.porosity, rel=1e-9)
        np.testing.assert_allclose(look["fractal_dimension"], own.fractal_dimension)
        assert look["mass_fraction"] == pytest.approx(grain.mass[largest].sum() / grain.mass.sum()), when


def test_the_look_before_the_loss_is_the_last_of_the_whole_grain(run):
    look = shapes.looks(run)["before loss"]
    whole = run["mass"].values >= run.attrs["initial_mass"] * (1.0 - 1e-9)
    assert look["mass_fraction"] == pytest.approx(1.0) and look["omega"] == run["omega"].values[whole].max()
    assert shapes.looks(run)["rest"]["omega"] == 0.0


def test_rows_of_the_queue_are_read_as_a_table(tmp_path, monkeypatch):
    monkeypatch.setattr(shapes, "TYPES", ("BA", "BAM2"))
    monkeypatch.setattr(shapes, "SIZES_NM", (60,))
    monkeypatch.setattr(shapes, "SEEDS", range(1))
    plan, said = plans.load(*shapes.CONFIG), []
    assert work(shapes.tasks(plan, tmp_path), say=said.append) == 0 and len(said) == 2
    assert work(shapes.tasks(plan, tmp_path), say=said.append) == 0 and len(said) == 2
    table = shapes.read_shapes(tmp_path)
    assert table["type"].unique().tolist() == ["BA", "BAM2"] and set(table["when"]) <= set(shapes.LOOKS)
    assert (table.loc[table["when"] == "rest", "omega"] == 0.0).all()
    with pytest.raises(ratd.InputError, match="holds no shapes"):
        shapes.read_shapes(tmp_path / "nothing")


def test_what_is_told_is_of_the_same_grains():
    """The dimension of BA rises by 0.5 in those grains that have one at the break, and scatters twice as much."""
    rng = np.random.default_rng(3)
    rows = []
    for kind in ("BA", "BAM1", "BAM2"):
        for seed in range(200):
            start = rng.normal(2.2, 0.1)
            end = 2.0 * (start - 2.2) + 2.7 if kind == "BA" else start + rng.normal(0.0, 0.02)
            for when, value in (("rest", start), ("before loss", start + rng.normal(0.0, 0.02)), ("disruption", end)):
                about = {"type": kind, "seed": seed, "a_eff": 450 * NM, "when": when}
                about["fractal_dimension"] = np.nan if when == "disruption" and seed < 20 else value
                about["mass_fraction"] = 0.6 if when == "disruption" else 1.0
                about["porosity"] = rng.normal(0.81 if when != "rest" and kind == "BAM1" else 0.8, 0.01)
                rows.append(about)
    values = of_shapes(pd.DataFrame(rows))
    assert values["shapes.grains"] == 600 and values["shapes.fewest"] == 200 and values["shapes.size"] == 450
    assert values["shapes.BA dimension change disruption"].value == pytest.approx(0.5, abs=0.03)
    assert values["shapes.BA dimension scatter rest"] == pytest.approx(0.1, rel=0.2)
    assert values["shapes.BA dimension scatter ratio"].value == pytest.approx(2.0)
    assert values["shapes.BAM1 porosity change before loss"].value == pytest.approx(1.0, abs=0.3)
    assert [values[f"shapes.{kind} rises"] for kind in ("BA", "BAM1", "BAM2")] == ["may rise", "rises", "may rise"]
    assert values["shapes.BA falls"] == "may fall" and values["shapes.BAM keep"] == "keep"
    assert values["shapes.BA left"] == pytest.approx(0.6)
    assert values["shapes.scatter ratio"].value == pytest.approx(2.0 ** (1 / 3), rel=0.03)
    assert values["shapes.scatter grows"] == "grows"


def test_error_of_the_ratio_of_scatters_is_that_of_a_repeated_experiment():
    rng = np.random.default_rng(1)
    found = [scatter_ratio(2.0 * rng.normal(size=20), rng.normal(size=20)) for _ in range(400)]
    ratio, error = np.array(found).T
    assert np.median(ratio) == pytest.approx(2.0, rel=0.05)
    assert np.sqrt(np.mean(error**2)) == pytest.approx(ratio.std(), rel=0.25)
