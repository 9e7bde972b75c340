"""Pairs of monomers that part, as figure 10 shows them."""

import numpy as np
import pandas as pd
import pytest

from ratd.base.materials import MATERIALS, sphere_mass
from ratd.experiments.spin_up.figures.figure10 import figure10, relative_error
from ratd.experiments.spin_up.pairs import PAIR_COLUMNS, force_controlled_omega, holding_omega, pairs
from ratd.pipeline import io

HOW = {"damped": {"epsilon": 0.02, "timestep_factor": 0.05}, "undamped": {"epsilon": 0.05, "timestep_factor": 0.05}}


@pytest.fixture(scope="module")
def table():
    return pd.DataFrame([row for name in ("q-S", "co-S") for row in pairs(MATERIALS[name], 3, 1, 10e-9, 100e-9, **HOW)])


def test_pairs_part_near_the_reference_of_their_start(table):
    error = pd.Series(relative_error(table)).groupby(table["start"])
    assert (np.abs(relative_error(table)) < 0.05).all() and (error.count() == 6).all()
    assert (table["parting_omega"] > table["eq35_omega"])[table["start"] == "damped"].all()
    np.testing.assert_allclose(table["eq35_omega"] / table["force_controlled_omega"], np.sqrt(5) / 3)


def test_the_same_radii_for_every_material_within_the_limits(table):
    radii = [part["monomer_radius"].to_numpy() for _, part in table.groupby(["material", "start"])]
    assert all(np.array_equal(radii[0], other) for other in radii[1:])
    assert (radii[0] > 10e-9).all() and (radii[0] < 100e-9).all() and len(set(radii[0])) == 3


def test_holding_omega_of_a_load():
    assert holding_omega(8e-9, 1e-18, 2e-7) == pytest.approx(2e8)
    equal = force_controlled_omega(40e-9, 40e-9, MATERIALS["q-S"])
    assert equal > force_controlled_omega(40e-9, 80e-9, MATERIALS["q-S"]) > 0


def test_a_speck_on_a_large_sphere_is_held_against_the_force_on_its_own_mass():
    own, large, speck = MATERIALS["q-S"], 1e-6, 1e-9
    expected = np.sqrt(3 * np.pi * own.surface_energy * speck / (sphere_mass(speck, own.density) * large))
    assert force_controlled_omega(speck, large, own) == pytest.approx(expected, rel=2e-3)
    assert force_controlled_omega(speck, large, own) == force_controlled_omega(large, speck, own)


def test_pairs_can_be_written_and_read(table, tmp_path):
    part = table[table["material"] == "q-S"].reset_index(drop=True)
    io.write(tmp_path / "a.nc", part.rename_axis("entry").to_xarray().drop_vars("entry"), "pairs")
    back = io.read(tmp_path / "a.nc", "pairs").to_dataframe()
    names = list(PAIR_COLUMNS)
    pd.testing.assert_frame_equal(back[names], part[names], check_dtype=False, check_names=False)


def test_figure10_shows_both_starts_and_their_errors(table):
    lost = table.copy()
    lost.loc[lost.index[0], "parting_omega"] = np.nan
    panels = figure10(lost).axes
    assert [axes.get_title() for axes in panels[:2]] == ["q-S", "co-S"]
    assert [text.get_text() for text in panels[0].texts] == ["never parted: 1"] and not panels[1].texts
    (blue,) = [line for line in panels[3].get_lines() if line.get_marker() == "o"]
    here = table[(table["material"] == "co-S") & (table["start"] == "damped")]
    expected = 100 * (here["parting_omega"] / here["force_controlled_omega"] - 1)
    np.testing.assert_allclose(blue.get_ydata(), expected)
    assert "over its line" in panels[2].get_ylabel()
