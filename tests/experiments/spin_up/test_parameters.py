"""Grains spun up with other rolling displacements and viscous times, as figure 9 shows them."""

import logging
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from ratd.aggregates.growth import grow
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.figures.figure9 import figure9
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.parameters import PARAMETER_COLUMNS, effect, parameter_table, ways
from ratd.experiments.spin_up.plan import load
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.same_grains import of_material, spin_up_ways, steps_to, way_material
from ratd.pictures.style import GREY
from ratd.pipeline import blocks, io
from ratd.pipeline.jobs import Job

PACE = {"epsilon": 0.2, "timestep_factor": 0.1}
VALUES = {"xi_c": [0.2e-9, 6.4e-9], "T_vis": [1e-12, 5e-12]}


def marks_of(seeds, **changed):
    grains = [of_material(grow("BAM2", 50e-9, "a-C", seed), **changed) for seed in seeds]
    return [disruption(spin_up(grain, **PACE)) for grain in grains]


@pytest.fixture(scope="module")
def table():
    own = MATERIALS["a-C"]
    return parameter_table(
        [(name, replace(own, **changed), marks_of((0, 1, 2), **changed)) for name, changed in ways(own, VALUES)]
    )


def test_the_own_value_is_run_once_and_one_constant_is_changed_at_a_time():
    found = ways(MATERIALS["a-C"], VALUES)
    assert found == [
        ("none", {}),
        ("xi_c", {"critical_rolling_displacement": 6.4e-9}),
        ("T_vis", {"viscous_time": 1e-12}),
    ]


def test_ratios_are_to_the_same_grain_as_it_is(table):
    assert list(table) == list(PARAMETER_COLUMNS) and len(table) == 9
    own = table[table["parameter"] == "none"].set_index("seed")
    assert (own[["omega_disr_ratio", "omega_mass_75_ratio"]].stack() == 1.0).all()
    other = table[table["parameter"] == "T_vis"].set_index("seed")
    np.testing.assert_allclose(other["omega_disr_ratio"], other["omega_disr"] / own["omega_disr"])
    assert (other["viscous_time"] == 1e-12).all() and (other["critical_rolling_displacement"] == 0.2e-9).all()
    # the constant reaches the engine
    assert (other["omega_disr"] != own["omega_disr"]).any()


def test_a_grain_that_was_not_spun_up_as_it_is_is_named(table):
    with pytest.raises(InputError, match="BAM2.* was not spun up with its material as it is"):
        parameter_table([("xi_c", MATERIALS["a-C"], marks_of((0,)))])


def test_effect_is_the_median_over_the_grains(table):
    found = effect(table, "T_vis", "omega_mass_75")
    assert list(found["value"]) == [1e-12, 5e-12] and list(found["n"]) == [3, 3]
    part = table[table["parameter"] == "T_vis"]["omega_mass_75_ratio"]
    assert found["median"][0] == np.median(part) and found["median"][1] == 1.0


def test_the_table_can_be_written_and_read(table, tmp_path):
    io.write(tmp_path / "a.nc", table.rename_axis("entry").to_xarray().drop_vars("entry"), "parameters")
    back = io.read(tmp_path / "a.nc", "parameters").to_dataframe()
    assert (back[list(table)].to_numpy() == table.to_numpy()).all()


def test_figure9_shows_medians_with_their_errors_on_one_axis(table):
    larger = table.assign(a_eff=2 * table["a_eff"], omega_disr_ratio=1.01 * table["omega_disr_ratio"])
    every = pd.concat([table, larger])
    figure = figure9(every)
    rolling, viscous = figure.axes
    assert rolling.get_ylim() == viscous.get_ylim() and "paper's value" in rolling.get_ylabel()
    found = effect(every, "xi_c", "omega_disr")
    found = found[~np.isclose(found["value"], 0.2e-9, atol=0.0)]  # the paper's value, where it is 1 by definition
    points, _, (bars,) = rolling.containers[0]
    np.testing.assert_allclose(points.get_ydata(), found["median"])
    ends = np.array([segment[:, 1] for segment in bars.get_segments()])
    np.testing.assert_allclose(ends.T, [found["median"] - found["error"], found["median"] + found["error"]])
    assert (ends > rolling.get_ylim()[0]).all() and (ends < rolling.get_ylim()[1]).all()
    assert "50, 100 nm" in figure.get_suptitle()
    with pytest.raises(InputError, match="at least one run"):
        figure9(table[:0])


def test_figure9_names_the_paper_and_what_its_markers_mean(table):
    figure = figure9(table)
    assert [axes.get_xlabel().split()[0] for axes in figure.axes] == ["critical", "viscous"]
    assert "paper: 0.2" in figure.axes[0].get_xlabel() and "paper: 5" in figure.axes[1].get_xlabel()
    assert "paper, BAM2" in [text.get_text() for text in figure.axes[1].texts]
    assert "50 nm" in figure.get_suptitle() and not any(axes.get_legend() for axes in figure.axes)
    (legend,) = figure.legends
    assert {"BAM2", "25 % of the mass lost"} < {text.get_text() for text in legend.texts}
    # filled and open markers of one value stand side by side
    places = [line.get_xdata()[0] for line in figure.axes[1].get_lines() if line.get_marker() == "^"]
    assert len(places) == len(set(places)) == 2


def test_figure9_has_one_mark_at_the_values_of_the_paper_and_no_point(table):
    for axes, own in zip(figure9(table).axes, (0.2, 5.0), strict=True):
        (mark,) = [line for line in axes.get_lines() if line.get_color() == GREY]
        np.testing.assert_allclose(mark.get_xydata(), [[own, 1.0]])
        assert mark.get_markerfacecolor() == "white"
        assert "1 by definition" in [text.get_text() for text in axes.texts]
        points = np.concatenate([container[0].get_xdata() for container in axes.containers])
        assert len(points) == 2 and not np.isclose(points, own, rtol=0.1).any()


def test_a_run_ends_where_it_is_told_to():
    grain = grow("BAM2", 50e-9, "q-S", 0)
    spin = {"drive": "literal", "angular_acceleration": 1e17, "timestep_factor": 0.05}
    run = spin_up(grain, **spin, max_steps=steps_to(grain, 0.1, 1e17, 0.05))
    assert float(run["omega"][-1]) == pytest.approx(0.1 * (1e17 / run.attrs["timestep"]) ** (1 / 3), rel=0.02)


class Killed(Exception):
    """Ends a job."""


@pytest.fixture
def job():
    """A job without Snakemake around it."""
    job = object.__new__(Job)
    job._task = {"function": "of the test", "writes": ["disruption"]}
    job.log, job.provenance_of = logging.getLogger("test"), lambda settings, inputs: {"settings": repr(settings)}
    return job


def test_ways_are_files_and_a_killed_job_keeps_its_finished_grains(job, tmp_path):
    plan = load("config/config.yaml", "config/spin_up.yaml", "config/quick.yaml")
    changes = ({}, {"viscous_time": 1e-12})
    spin = {"drive": "prescribed", **PACE}
    how = [
        {"grain": plan.grow("a-C", "BAM2", "50"), "changed": changed, "seeds": [3, 4], "spin_up": spin}
        for changed in changes
    ]
    targets = [tmp_path / f"{k}.nc" for k in range(2)]
    calls = []

    def failing(run):
        calls.append(run.attrs["seed"])
        if len(calls) == 3:
            raise Killed
        return disruption(run)

    def broken(run):
        calls.append(run.attrs["seed"])
        if len(calls) == 4:
            raise RuntimeError("the integration failed")
        return disruption(run)

    with pytest.raises(Killed):
        spin_up_ways(job, targets, how, "disruption", failing)
    assert not any(path.exists() for path in targets)
    with pytest.raises(InputError, match="1 of 2 grains failed, the others are kept: .*the integration failed"):
        spin_up_ways(job, targets, how, "disruption", broken)
    spin_up_ways(job, targets, how, "disruption", failing)
    # two were kept; what fails when it is made again leaves the fourth to be made
    assert calls == [3, 4, 3, 3, 4, 3]
    for path, way in zip(targets, how, strict=True):
        file = io.read(path, "disruption")
        assert list(file["seed"].values) == [3, 4]
        assert blocks.material_of(file) == way_material(way)
    direct = disruption(spin_up(of_material(grow("BAM2", 50e-9, "a-C", 4), viscous_time=1e-12), **PACE))
    assert float(file["omega_disr"][1]) == float(direct["omega_disr"])
