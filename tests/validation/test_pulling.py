"""The queue of grains that are pulled: what a row holds, what the squeezing does, and what is told of the table."""

import numpy as np
import pandas as pd
import pytest

import ratd
from ratd.aggregates.strength import midplane_tension
from ratd.base.materials import get_material
from ratd.base.units import NM
from ratd.engine.layout import MASS, X
from ratd.engine.state import monomer_rows
from ratd.experiments.relax import relax
from ratd.experiments.spin_up import pulled as told
from ratd.experiments.spin_up.figures.pulled import pulled as drawn
from ratd.experiments.spin_up.figures.style import TYPE_MARKER
from ratd.experiments.spin_up.findings.pulled import of_pulled
from ratd.experiments.spin_up.plan import load
from ratd.pipeline.queue import work
from ratd.validation import pulling

ONE_OF_EACH = {"usual": pulling.BOX["usual"] | {"squeeze_rate": 2e-5, "strain_rate": 2e-5}}


@pytest.fixture(scope="module")
def grain():
    return ratd.grow("BAM1", 130e-9, "q-S", 2)


def test_lengthwise_the_longest_axis_lies_along_x_and_contacts_stay(grain):
    turned = pulling.lengthwise(grain)
    np.testing.assert_array_equal(turned.contacts, grain.contacts)
    centred = turned.position - turned.mass @ turned.position / turned.mass.sum()
    spread = np.sqrt(turned.mass @ centred**2)
    assert np.argmax(spread) == 0


def test_names_of_the_axes_are_those_of_a_relaxed_grain(grain):
    rows = monomer_rows(relax(grain))
    spread = rows[:, MASS] @ rows[:, X : X + 3] ** 2
    assert [pulling._AXIS[name] for name in told.AXES] == np.argsort(spread).tolist()


def test_the_box_squeezes_to_the_filling_factor_of_the_grain(grain):
    (pull,) = pulling.in_the_box(grain, ONE_OF_EACH)
    assert pull["phi"] == pytest.approx(grain.shape.filling_factor, rel=0.01)
    assert 0.3 < pull["kept"] <= 1.0 and pull["new"] >= 0.0 and pull["strength"] > 0.0
    assert pull["peak"] >= pull["strength"]


def test_too_large_and_too_dense_grains_are_left_out(grain):
    small = {"usual": ONE_OF_EACH["usual"] | {"up_to_nm": 80}}
    dense = {"usual": ONE_OF_EACH["usual"] | {"part": 1.01 * pulling.DENSEST / grain.shape.filling_factor}}
    assert pulling.in_the_box(grain, small) == [] and pulling.in_the_box(grain, dense) == []


def test_nothing_becomes_of_the_contacts_of_a_grain_that_is_hardly_squeezed(grain):
    turned = pulling.lengthwise(grain)
    ends = (turned.position + sign * turned.radius[:, None] for sign in (1, -1))
    spread = 1.2 * (next(ends).max(axis=0) - next(ends).min(axis=0)).max()
    start = 4 / 3 * np.pi * (turned.radius**3).sum() / spread**3
    squeezed = ratd.compress(turned, 1e-5, 1.05 * start, box_length=spread, snapshots=(), balance=False)
    assert pulling.became(turned, squeezed) == {"kept": 1.0, "new": 0.0, "across": 0.0}


def test_omega_by_the_ends_is_that_of_the_force(grain):
    pulls = pulling.by_its_ends(grain, {"usual": pulling.ENDS["usual"]})
    assert [pull["axis"] for pull in pulls] == list(told.AXES)
    state = relax(grain)
    rows = monomer_rows(state)
    outer = told.outer_radius(grain.a_eff, grain.shape.filling_factor)
    for pull, axis in zip(pulls, (2, 0, 1), strict=True):
        right = rows[:, X + axis] > 0.0
        half = rows[right, MASS] @ rows[right, X + axis]
        assert pull["omega"] ** 2 * half == pytest.approx(pull["strength"] * np.pi * outer**2, rel=1e-6)


def test_rows_of_the_queue_are_read_as_a_table(tmp_path, monkeypatch):
    monkeypatch.setattr(pulling, "MATERIALS", ("q-S",))
    monkeypatch.setattr(pulling, "TYPES", ("BA", "BAM1"))
    monkeypatch.setattr(pulling, "SIZES_NM", (70,))
    monkeypatch.setattr(pulling, "SEEDS", range(1))
    monkeypatch.setattr(pulling, "ENDS", {name: pulling.ENDS[name] for name in ("usual", "slow")})
    made = pulling.in_the_box, pulling.by_its_ends
    monkeypatch.setattr(pulling, "in_the_box", lambda grain: made[0](grain, ONE_OF_EACH))
    monkeypatch.setattr(pulling, "by_its_ends", lambda grain: made[1](grain, pulling.ENDS))
    wanted = pulling.tasks(load(*pulling.CONFIG), tmp_path)
    said = []
    assert work(wanted, say=said.append) == 0 and len(said) == 2
    assert work(pulling.tasks(load(*pulling.CONFIG), tmp_path), say=said.append) == 0 and len(said) == 2
    table = told.read_pulled(tmp_path)
    assert len(table) == 2 * (1 + 3 + 1) and set(table["way"]) == set(told.WAYS)
    gamma = get_material("q-S").surface_energy
    np.testing.assert_allclose(
        table["ratio"], table["strength"] * table["mean_monomer_radius"] / (gamma * table["phi"] ** 1.8)
    )
    assert len(told.usual(table)) == 4


def test_every_task_of_the_queue_is_another_row(tmp_path):
    wanted = pulling.tasks(load(*pulling.CONFIG), tmp_path)
    assert len({(task.table.path, task.key) for task in wanted}) == len(wanted)
    assert len(wanted) == len(pulling.MATERIALS) * len(pulling.TYPES) * len(pulling.SIZES_NM) * len(pulling.SEEDS)


def test_an_empty_folder_is_one_sentence(tmp_path):
    with pytest.raises(ratd.InputError, match="holds no pulled grains"):
        told.read_pulled(tmp_path)


def made_up(box_over_spin=2.0, ends_over_spin=3.0, seeds=3):
    """A table of pulls and one of spin-ups with known ratios."""
    material = get_material("q-S")
    pulls, spun = [], []
    for kind, scatter in (("BA", 1.0), ("BAM1", 1.2)):
        for size in (200, 300):
            for seed in range(seeds):
                phi, omega = 0.2 + 0.01 * seed, 1e7
                a_eff = size * NM
                grain = {
                    "material": "q-S", "type": kind, "a_eff": a_eff, "seed": seed, "filling_factor": phi,
                    "mean_monomer_radius": 25e-9, "n_monomers": 100 + seed, "n_contacts": 99,
                    "surface_energy": material.surface_energy, "density": material.density,
                }  # fmt: skip
                tension = midplane_tension(omega, material.density, phi, told.outer_radius(a_eff, phi))
                noise = scatter ** (seed - 1)
                spun.append({**{name: grain[name] for name in ("material", "type", "a_eff", "seed")},
                             "omega_mass_75": omega, "omega_first_loss": 0.5 * omega})  # fmt: skip
                pull = grain | dict.fromkeys(told._PULL, 0.0) | {"phi": phi, "axis": "longest", "variant": "usual"}
                box = pull | {"way": "box", "strength": box_over_spin * tension * noise, "kept": 0.8, "peak": 1.0}
                ends = pull | {"way": "ends", "strength": ends_over_spin * tension, "omega": 1.5 * omega, "peak": 1.0}
                slow = ends | {"variant": "slow", "strength": 0.9 * ends["strength"]}
                pulls += [box, ends, slow]
    table = pd.DataFrame(pulls)
    table["ratio"] = told._ratio(table["strength"], table, table["phi"])
    return table, pd.DataFrame(spun)


def test_findings_are_geometric_means_of_the_same_grains():
    found = of_pulled(*made_up())
    assert found["pulled.grains"] == 12 and found["pulled.beside"] == 12
    for kind in ("BA", "BAM1", "all"):
        assert found[f"pulled.{kind} over spin"].value == pytest.approx(2.0)
        assert found[f"pulled.{kind} over spin first"].value == pytest.approx(8.0)
        assert found[f"pulled.{kind} ends over spin"] == pytest.approx((3.0, 0.0), abs=1e-12)
        assert found[f"pulled.{kind} omega"].value == pytest.approx(1.5)
        assert found[f"pulled.{kind} ends slow"].value == pytest.approx(0.9)
        assert found[f"pulled.{kind} kept"].value == pytest.approx(0.8)
    # three grains a cell that differ by 1.2 each, two cells
    assert found["pulled.BAM1 over spin"].error == pytest.approx(2.0 * np.log(1.2) / np.sqrt(3) / np.sqrt(2))


def test_a_grain_that_was_not_spun_up_has_no_tension():
    table, spun = made_up()
    found = of_pulled(table, spun[spun["seed"] > 0])
    assert found["pulled.grains"] == 12 and found["pulled.beside"] == 8
    assert found["pulled.BA over spin"].value == pytest.approx(2.0)


def test_figure_has_three_panels_with_all_grains():
    figure = drawn(*made_up())
    panels = figure.axes
    assert len(panels) == 3 and "12 grains" in figure.get_suptitle()
    for axes in panels:
        points = [line for line in axes.lines if line.get_label() in ("BA", "BAM1")]
        assert [len(line.get_xdata()) for line in points] == [6, 6]
        means = [c[0] for c in axes.containers if len(c[0].get_xdata())]
        assert [mean.get_marker() for mean in means] == [TYPE_MARKER["BA"], TYPE_MARKER["BAM1"]]
        assert {mean.get_markerfacecolor() for mean in means} == {"white"}
    assert panels[0].get_ylabel() and all(axes.get_xlabel() for axes in panels)
