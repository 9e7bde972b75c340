"""Clusters that are compressed and pulled: balance, work, restart, and what is refused."""

import warnings
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import ratd
from ratd.aggregates.strength import rolling_pressure, sound_speed_kataoka2013
from ratd.base.materials import MATERIALS
from ratd.experiments import intervals
from ratd.experiments.command import several
from ratd.experiments.compression import pull
from ratd.experiments.compression.files import run_row, stretched_row
from ratd.experiments.compression.pull import pressed, pulled
from ratd.experiments.compression.run import Cluster
from ratd.experiments.compression.static import (
    box_rate,
    face_speed,
    filling_factor_bcca,
    inertial_tension,
    slower_than_sound_from,
    static_from,
    time_unit,
)
from ratd.experiments.compression.steps import STRAIN, longest_strain
from ratd.experiments.compression.strain import strain_dataset
from ratd.experiments.compression.stretch_command import show
from ratd.laws.contact_constants import equilibrium_compression, pull_off_force
from ratd.pipeline import blocks, io
from ratd.pipeline.provenance import provenance

HOW = {"strain_rate": 3e-5, "until_phi": 0.25}


@pytest.fixture(scope="module")
def cluster():
    return ratd.grow_bcca(64, seed=0)


@pytest.fixture(scope="module")
def run(cluster):
    return ratd.compress(cluster, **HOW)


def test_records_go_up_to_the_filling_factor_wanted(run, cluster):
    phi = run["phi"].values
    assert (np.diff(phi) > 0.0).all() and phi[-1] == pytest.approx(0.25, rel=1e-3)
    assert np.diff(np.log(phi)).max() < 0.011
    assert phi == pytest.approx(64 * 4 / 3 * np.pi * 1e-21 / np.prod(run["box_length"].values, axis=1))
    assert run["snapshot_phi"].values == pytest.approx([0.03, 0.1], rel=0.011) and run.sizes["snapshot"] == 2
    assert run["snapshot_position"].shape == (2, 64, 3)
    assert run["n_contacts"].values[-1] > 64 >= run["n_contacts"].values[0] - 2


def test_the_work_is_that_of_the_pressure(run):
    volume = np.prod(run["box_length"].values, axis=1)
    first = 64 * 4 / 3 * np.pi * 1e-21 / run.attrs["phi_start"]
    work = -np.cumsum(run["pressure"].values * np.diff(np.append(first, volume)))
    assert work[-1] == pytest.approx(run["work"].values[-1], rel=2e-3)
    tensor = run["pressure_tensor"].values
    assert run["pressure"].values == pytest.approx(tensor[:, :3].mean(axis=1))


def test_energy_balances(cluster, run):
    high = run["phi"].values > 0.15
    off = np.abs(run["energy_residual"] / run["work"]).values[high].max()
    assert off < 0.004
    explicit = ratd.compress(cluster, **HOW, long_steps=None)
    assert np.abs(explicit["energy_residual"] / explicit["work"]).values[high].max() < 2e-3
    gone = sum(
        run[f"dissipated_{way}"].values for way in ("damping", "sliding", "rolling", "twisting", "made", "broken")
    )
    held = sum(run[f"stored_{mode}"].values for mode in ("normal", "sliding", "rolling", "twisting"))
    moving = run["kinetic_translation"].values + run["kinetic_spin"].values
    # with the first record in place of the start
    balance = gone + held + moving - run["work"].values
    assert np.ptp(balance) < 0.01 * run["work"].values[-1]


def test_an_unbalanced_run_ends_with_an_error(cluster, monkeypatch):
    for name in ("BALANCE", "LONG_BALANCE"):
        with monkeypatch.context() as changed, pytest.raises(RuntimeError, match="off by .* allowed are 0.0% of the"):
            changed.setattr(f"ratd.experiments.compression.run.{name}", {0.1: 1e-9})
            ratd.compress(cluster, **HOW)
    assert ratd.compress(cluster, **HOW, balance=False).sizes["record"] > 100


def test_a_killed_run_goes_on_with_the_same_bits(cluster, run, tmp_path, monkeypatch):
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    seen = []

    def stop(phi, pressure, seconds_to_go):
        seen.append(phi)
        if phi > 0.08:
            raise KeyboardInterrupt

    path = tmp_path / "checkpoint"
    with pytest.raises(KeyboardInterrupt):
        ratd.compress(cluster, **HOW, checkpoint=path, progress=stop)
    went_on = []
    again = ratd.compress(cluster, **HOW, checkpoint=path, progress=lambda phi, *_: went_on.append(phi))
    assert went_on[0] > 0.079 and seen[0] < 0.02
    assert again.equals(run)


def test_long_steps_give_the_same_as_explicit_ones(cluster, run):
    """At the same filling factors; single clusters are chaotic later on."""
    explicit = ratd.compress(cluster, **HOW, long_steps=None)
    assert run.attrs["steps"] < 0.5 * explicit.attrs["steps"]
    assert "Leapfrog" in run.attrs["integrator"] and "SemiImplicit" not in explicit.attrs["integrator"]
    phi = run["phi"].values
    assert explicit["phi"].values == pytest.approx(phi, rel=1e-3)
    for limit, off in ((0.1, 0.02), (0.2, 0.1)):
        at = int(np.searchsorted(phi, limit))
        assert run["n_contacts"].values[at] == pytest.approx(explicit["n_contacts"].values[at], rel=off)
        work = [float(one["work"].values[at]) for one in (run, explicit)]
        assert work[0] == pytest.approx(work[1], rel=0.2)


@pytest.mark.filterwarnings("ignore:the box shrinks so fast that inertia dominates")
def test_long_steps_do_not_pull_at_a_loose_cluster():
    """One that has not met its copies: it has the pressure of its inertia alone, and only too long steps miss it."""
    loose = ratd.grow_bcca(128, material="silicate", seed=1)
    how = {"strain_rate": 3e-6, "until_phi": 0.02, "snapshots": (), "balance": False}
    exact = ratd.compress(loose, **how, long_steps=None)
    assert exact["n_contacts"].values[-1] == 127
    late = exact["phi_mean"].values > 0.015
    off = []
    for strain in (STRAIN, 6e-5):
        run = ratd.compress(loose, **how, long_steps=ratd.LongSteps(strain=strain))
        off.append(
            np.mean((run["pressure"] - exact["pressure"]).values[late]) / np.abs(exact["pressure"]).mean().item()
        )
    assert abs(off[0]) < 0.03 and off[1] < -0.2, off


@pytest.mark.filterwarnings("ignore:the box shrinks so fast that inertia dominates")
def test_long_steps_are_shorter_for_stiff_monomers_since_they_add_energy():
    """Silicate that only turns and rolls: steps that are good for ice add a good part of the energy of its motion."""
    material = MATERIALS["silicate"]
    assert longest_strain(material, 6e-7) == pytest.approx(1e-6, rel=0.02)
    assert longest_strain(MATERIALS["ice"], 1e-7 * (1.0 + 1e-12)) == STRAIN
    soft = replace(MATERIALS["ice"], name="soft", youngs_modulus=1e8)
    assert longest_strain(soft, 1e-7) == STRAIN
    loose = ratd.grow_bcca(64, material="silicate", seed=1)
    # squeezed fast they would be no longer than explicit ones
    for steps, integrator in ((ratd.LongSteps(), "Leapfrog"), (ratd.LongSteps(strain=STRAIN), "SemiImplicit")):
        run = ratd.compress(loose, 1e-5, 0.023, snapshots=(), long_steps=steps)
        assert run.attrs["integrator"].startswith(integrator)
    how = {"strain_rate": 1e-6, "until_phi": 0.04, "snapshots": (), "balance": False}
    exact, own, of_ice = (
        ratd.compress(loose, **how, long_steps=steps)
        for steps in (None, ratd.LongSteps(), ratd.LongSteps(strain=STRAIN))
    )
    moving = exact["kinetic_translation"].max().item()
    off = [(run["dissipated_damping"][-1] - exact["dissipated_damping"][-1]).item() / moving for run in (own, of_ice)]
    assert -0.07 < off[0] < 0.0 and off[1] < -0.12, off


def test_a_run_is_handed_over_to_explicit_steps(cluster, run):
    steps = ratd.LongSteps(until_phi=0.1)
    early = ratd.compress(cluster, **HOW, long_steps=steps)
    assert early.attrs["timestep"] < 0.3 * early.attrs["time_unit"]
    before = early["phi"].values < 0.1
    for name in ("pressure", "n_contacts", "energy_residual"):
        assert (early[name].values[before][:-1] == run[name].values[before][:-1]).all()
    # with explicit steps the balance holds
    work, off = early["work"].values, early["energy_residual"].values
    at = np.flatnonzero(~before)[1]
    assert np.abs((off[-10:] - off[at]) / (work[-10:] - work[at])).max() < 2e-3


@pytest.mark.parametrize(
    ("steps", "said"), [("long", "must be a ratd.LongSteps"), (ratd.LongSteps(strain=-1.0), "long_steps.strain is")]
)
def test_wrong_steps_are_refused(cluster, steps, said):
    with pytest.raises(ratd.InputError, match=said):
        ratd.compress(cluster, **HOW, long_steps=steps)


def test_own_aggregates_of_unequal_monomers_are_compressed():
    grain = ratd.grow("BA", a_eff=150e-9, material="q-S", seed=1)
    material = ratd.Material("own", 0.05, 1e10, 0.2, 2000.0, 1e-9)
    run = ratd.compress(grain, 1e-4, 0.3, material=material)
    assert run.attrs["material"] == "own" and run.attrs["surface_energy"] == 0.05
    mean = np.mean(grain.radius**3) ** (1 / 3)
    assert run.attrs["rolling_pressure"] == pytest.approx(rolling_pressure(0.05, 1e-9, mean))
    assert run.attrs["time_unit"] == pytest.approx(time_unit(material, mean))
    assert run["pressure"].values[-1] > 0.0


def test_a_cluster_of_softer_contacts_is_to_be_grown_anew(cluster):
    with pytest.raises(ratd.InputError, match="material is 'q-S', in which contacts as deep .* of 'ice' .* grow it"):
        ratd.compress(cluster, 1e-4, 0.3, material="q-S")


def test_speeds_and_the_filling_factor_of_a_cluster_are_as_printed():
    """Eqs. 24, 26 and 28 of Kataoka et al. (2013), for ice."""
    ice = MATERIALS["ice"]
    rate = box_rate(3e-7, time_unit(ice, 1e-7))
    found = [100.0 * face_speed(rate, 16384, 1e-7, phi) for phi in (1e-3, 1e-2, 1e-1)]
    assert found == pytest.approx([12.7, 5.9, 2.7], rel=0.02)
    assert filling_factor_bcca(16384) == pytest.approx(3e-3, rel=0.25)


def test_faces_are_slower_than_sound_from_where_the_paper_says():
    """3.4e-2 for silicate (Kataoka et al. 2013, text to Fig. 12); and there one speed is that part of the other."""
    silicate, ice = MATERIALS["silicate"], MATERIALS["ice"]
    P_0 = rolling_pressure(silicate.surface_energy, silicate.critical_rolling_displacement, 6e-7)
    rate = box_rate(3e-7, time_unit(silicate, 6e-7))
    assert slower_than_sound_from(rate, 16384, 6e-7, silicate.density, P_0) == pytest.approx(0.034, rel=0.03)
    P_0 = rolling_pressure(ice.surface_energy, ice.critical_rolling_displacement, 1e-7)
    rate = box_rate(1e-6, time_unit(ice, 1e-7))
    phi = slower_than_sound_from(rate, 1024, 1e-7, ice.density, P_0, 0.2)
    sound = float(sound_speed_kataoka2013(phi, P_0, ice.density))
    assert face_speed(rate, 1024, 1e-7, phi) == pytest.approx(0.2 * sound)


def test_static_is_what_the_specification_says():
    ice, silicate = MATERIALS["ice"], MATERIALS["silicate"]
    for material, radius, expected in ((ice, 1e-7, (2.6e-3, 3.7e-3, 5.3e-3)), (silicate, 6e-7, (0.014, 0.020, 0.028))):
        rate = box_rate(3e-7, time_unit(material, radius))
        P_0 = rolling_pressure(material.surface_energy, material.critical_rolling_displacement, radius)
        found = [static_from(rate, n, radius, material.density, P_0) for n in (1024, 4096, 16384)]
        assert found == pytest.approx(expected, rel=0.03)
        faster = static_from(10 * rate, 1024, radius, material.density, P_0)
        assert faster / found[0] == pytest.approx(10**0.75)


def test_no_pressure_is_0_where_marks_are_closer_than_a_step(cluster):
    """At the greatest rate some records have no step of their own; they repeat the last one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        run = ratd.compress(cluster, 1e-2, 0.3, long_steps=None, balance=False)
    assert (np.diff(run["time"].values) == 0.0).any()
    assert (run["pressure"].values != 0.0).all()


def test_a_compression_that_is_too_fast_is_warned_of(cluster):
    with pytest.warns(UserWarning, match="inertia dominates: the compression is static from phi = 0.[0-9]+ on"):
        ratd.compress(cluster, 1e-3, 0.03)
    # static from 0.03 on, which the run does not reach
    with pytest.warns(UserWarning, match="inertia dominates: the compression is static from phi = 0.0[0-9]+ on"):
        ratd.compress(cluster, 2e-5, 0.02)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"strain_rate": 0}, "strain_rate is 0; it must be a number above 0"),
        ({"strain_rate": float("nan")}, "strain_rate is nan; it must be a number above 0"),
        ({"strain_rate": 100}, "strain_rate is 100; it must be above 0 and at most 0.01"),
        ({"box_length": 3000.0}, "box_length is 3000 m; it must be at most 6.* of which the cluster fills 1e-06"),
        ({"balance": "no"}, "balance is 'no'; it must be True or False"),
        ({"timestep_factor": 0.7}, "timestep_factor is 0.7; it must be above 0 and at most 0.5"),
        ({"until_phi": 0.9}, "until_phi is 0.9; it must be above .* and at most 0.64"),
        ({"until_phi": 1e-4}, "until_phi is 0.0001; it must be above"),
        ({"box_length": 1e-7}, "box_length is 1e-07 m; it must be at least 2e-07 m, a monomer"),
        ({"box_length": 5e-7}, "box_length is 5e-07 m; it must be at least .* the greatest extent of the cluster"),
        ({"snapshots": 0.1}, "snapshots is 0.1; it must be a sequence of numbers above 0"),
        ({"snapshots": [0.1, "x"]}, "snapshots is .* must be a sequence of numbers above 0"),
        ({"scheme": "other"}, "scheme is 'other'; allowed are homogeneous, as_printed"),
        ({"material": "x"}, "x"),
        ({"timestep_factor": "a"}, "timestep_factor is 'a'; it must be above 0"),
        ({"checkpoint": 5}, "checkpoint is 5; it must be the path of a file"),
    ],
)
def test_bad_input_is_one_sentence(cluster, arguments, said):
    with pytest.raises(ratd.InputError, match=said):
        ratd.compress(cluster, **arguments)


def test_a_run_is_no_cluster(run):
    with pytest.raises(
        ratd.InputError, match="cannot be squeezed further: compress the ratd.Grain again with a higher"
    ):
        ratd.compress(run)


def test_snapshots_are_those_of_the_records_whatever_their_order(cluster):
    how = {"strain_rate": 1e-4, "until_phi": 0.03}
    found = ratd.compress(cluster, **how, snapshots=(0.025, 0.02, 0.02001, 0.02501))
    assert found.sizes["snapshot"] == 2 and (np.diff(found["snapshot_phi"]) > 0).all()
    alone = ratd.compress(cluster, **how, snapshots=(0.02,))
    xr.testing.assert_equal(found["snapshot_position"][0], alone["snapshot_position"][0])


def test_a_step_that_bursts_the_cluster_is_an_error_also_while_it_is_loose(cluster):
    with pytest.raises(RuntimeError, match="at phi = 0.0[0-9]+ the balance of energy is off by") as ended:
        ratd.compress(cluster, 1e-4, 0.09, timestep_factor=0.5, long_steps=None, snapshots=(0.0157, 0.089))
    found = ended.value.run
    assert (np.diff(found["phi"]) > 0).all() and f"phi = {found['phi'].values[-1]:.3g} " in str(ended.value)
    whole = ratd.compress(cluster, 1e-4, 0.09, timestep_factor=0.5, long_steps=None, snapshots=(0.0157,), balance=False)
    xr.testing.assert_equal(found["pressure"], whole["pressure"][: found.sizes["record"]])
    assert 0 < found.sizes["record"] < whole.sizes["record"]
    assert found.sizes["snapshot"] == 1 and set(found.attrs) == set(whole.attrs)


def test_a_checkpoint_of_another_run_is_warned_of_and_another_file_is_kept(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    path = tmp_path / "run"
    how = {"until_phi": 0.03, "checkpoint": path}
    ratd.compress(cluster, 1e-4, **how)
    with pytest.warns(UserWarning, match="run: is the checkpoint of a run with other arguments, or of another version"):
        ratd.compress(cluster, 2e-4, **how)
    path.write_text("x,y,z,r")
    with pytest.raises(ratd.FileError, match="run: holds something else than a checkpoint; allowed: the name of a new"):
        ratd.compress(cluster, 2e-4, **how)
    assert path.read_text() == "x,y,z,r"
    with open(path, "wb") as file:
        np.savez(file, important=np.arange(5.0))
    with pytest.raises(ratd.FileError, match="run: holds something else than a checkpoint"):
        ratd.compress(cluster, 2e-4, **how)
    path.write_text("")
    ratd.compress(cluster, 2e-4, **how)


def test_where_no_checkpoint_can_be_written_is_said_before_the_run(cluster, tmp_path):
    with pytest.raises(ratd.FileError, match="is a folder; allowed: the name of a file for the checkpoint"):
        ratd.compress(cluster, checkpoint=tmp_path)
    (tmp_path / "file").write_text("")
    with pytest.raises(ratd.FileError, match="no checkpoint can be written below .*file"):
        ratd.compress(cluster, checkpoint=tmp_path / "file" / "run")


def test_what_is_no_aggregate_in_one_piece_is_refused(cluster):
    with pytest.raises(ratd.InputError, match="the cluster is of type list; it must be a ratd.Grain"):
        ratd.compress([cluster])
    two = np.vstack([cluster.position, cluster.position + [1e-5, 0, 0]])
    with pytest.raises(ratd.InputError, match="piece"):
        ratd.Grain(two, np.tile(cluster.radius, 2), "ice")
    with pytest.raises(ratd.InputError, match="overlap"):
        ratd.Grain([[0, 0, 0], [1e-7, 0, 0]], [1e-7, 1e-7], "ice")


def test_compressions_and_pulls_come_back_from_their_files_as_they_were(run, tmp_path):
    pulled = ratd.stretch(run, 3e-5)
    for kind, row, made in (("compression", run_row, run), ("stretched", stretched_row, pulled)):
        file = tmp_path / f"{kind}.nc"
        io.write(file, blocks.block([row(made)], kind, MATERIALS["ice"]), kind)
        (read,) = ratd.read_runs(file)
        lacking = {name for name in made.variables if name not in read.variables}
        # the state at the end, with its positions and, in pulls, radii, mass and step
        assert all(name.startswith("state_") or name in ("position", "radius") for name in lacking)
        for name in read.variables:
            np.testing.assert_equal(read[name].values, made[name].values)
        assert read["pressure_tensor"].sel(component="xx").equals(read["pressure_tensor"][:, 0])
        different = {name for name, value in made.attrs.items() if read.attrs.get(name) != value}
        assert different <= {"timestep", "mass"}, different
    assert ratd.read_runs(tmp_path / "compression.nc")[0].attrs["mass"] == pytest.approx(run.attrs["mass"], rel=1e-12)


def test_a_pulled_cluster_comes_apart(run):
    pulled = ratd.stretch(run, 3e-5)
    tension = pulled["tension"].values
    assert pulled.attrs["tensile_strength"] == pytest.approx(np.convolve(tension, np.full(4, 0.25), "valid").max())
    assert 0.0 < pulled.attrs["tensile_strength"] < 0.1 / 1e-7
    assert tension == pytest.approx(-pulled["pressure_tensor"].values[:, 0])
    edges = pulled["box_length"].values
    assert (np.diff(edges[:, 0]) > 0.0).all() and (edges[:, 1:] == run["box_length"].values[-1, 1:]).all()
    assert pulled.attrs["phi_strength"] < pulled.attrs["phi_start"] == run["phi"].values[-1]
    # the tension falls once the cluster parts
    assert tension[-4:].mean() < 0.5 * pulled.attrs["tensile_strength"]


def test_a_pull_that_leaves_the_balance_keeps_its_records(run, monkeypatch):
    monkeypatch.setattr("ratd.experiments.compression.stretch.BALANCE", -1.0)
    monkeypatch.setattr("ratd.experiments.compression.stretch.LONG_BALANCE", -1.0)
    with pytest.raises(RuntimeError, match="the balance of energy is off by") as ended:
        ratd.stretch(run, 3e-5)
    assert ended.value.run.sizes["record"] == 1 and "tensile_strength" not in ended.value.run.attrs


def test_the_inertia_of_a_pull_that_holds_nothing_is_warned_of(run):
    """This cluster does not hold to its copies: what it shows is that it takes back what the box carries along."""
    loose = ratd.compress(ratd.grow_bcca(32, material="ice", seed=1), 1e-4, 0.1)
    place = loose["position"].values[:, 0]
    for strain_rate in (5e-6, 2e-5):
        with pytest.warns(UserWarning, match="is not well above the .* Pa by which the inertia of the aggregate"):
            pulled = ratd.stretch(loose, strain_rate)
        edge, strain = loose["box_length"].values[-1, 0], 0.005 * pulled.sizes["record"]
        rate = -box_rate(strain_rate, loose.attrs["time_unit"])
        uniform = inertial_tension(rate, edge, 1000.0 * pulled.attrs["phi_start"], strain)
        # that of these monomers, which do not fill the box evenly
        expected = uniform * 12.0 * np.var(place) / edge**2
        assert float(pulled["tension"].mean()) == pytest.approx(expected, rel=0.15)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ratd.stretch(run, 3e-5)


def test_a_dense_cluster_that_still_presses_on_its_box_is_pulled_until_it_parts():
    """At the beginning of the pull there is no tension yet."""
    pressed = ratd.compress(ratd.grow_bcca(16, material="ice", seed=2), 1e-4, 0.6)
    pulled = ratd.stretch(pressed, 1e-4)
    tension = pulled["tension"].values
    assert tension[:3].max() < 0.0 < pulled.attrs["tensile_strength"]
    assert tension[-4:].mean() < 0.5 * pulled.attrs["tensile_strength"]
    # a pull goes on from another one
    again = ratd.stretch(pulled, 1e-4)
    assert again.attrs["phi_start"] == pytest.approx(pulled["phi"].values[-1])


def test_a_pull_without_tension_is_a_row_of_its_files(run, tmp_path, monkeypatch):
    """It has a strength of 0, and no filling factor where it is."""
    loose = ratd.stretch(run, 3e-5).assign_attrs(tensile_strength=0.0, phi_strength=np.nan)
    monkeypatch.setattr(pull, "stretch", lambda *_, **__: loose)
    settings = {"k_n": 0.01, "timestep_factor": 0.14, "pull": {"strain_rate": 3e-5, "axes": "x", "unload": False}}
    io.write(tmp_path / "entry.nc", pulled(pressed(run), settings), "tension_set")
    assert np.isnan(io.read(tmp_path / "entry.nc", "tension_set")["phi_strength"].item())
    made_with = provenance("code", settings)
    several(tmp_path / "a.nc", "stretched", MATERIALS["ice"], made_with, 1, lambda *_: stretched_row(loose))
    said = show(tmp_path / "a.nc", tmp_path / "a")
    assert "tensile strength = 0 Pa" in said[1] and said[2] == "phi at the greatest tension: unknown, no start shows it"


def test_a_pull_goes_on_from_a_file_of_whole_numbers_of_half_the_length(run, tmp_path):
    run.to_netcdf(tmp_path / "run.nc", engine="scipy")
    classic = xr.load_dataset(tmp_path / "run.nc", engine="scipy")
    assert classic["state_counter"].dtype != run["state_counter"].dtype
    assert ratd.stretch(classic, 3e-5)["tension"].equals(ratd.stretch(run, 3e-5)["tension"])


def test_a_box_lets_go_of_a_cluster_before_it_is_pulled(cluster):
    pressed = ratd.compress(cluster, 1e-5, 0.25)
    loaded, free = (ratd.stretch(pressed, 1e-5, unload=unload).attrs for unload in (False, True))
    assert abs(free["residual_pressure"]) < 0.3 * loaded["residual_pressure"]
    # it takes little room to do so
    assert 0.95 * loaded["phi_start"] < free["phi_start"] < loaded["phi_start"]
    assert free["tensile_strength"] == pytest.approx(loaded["tensile_strength"], rel=0.5)


@pytest.mark.parametrize("unload", [False, True])
def test_a_killed_pull_goes_on_with_the_same_bits(run, tmp_path, monkeypatch, unload):
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    how = {"strain_rate": 3e-5, "unload": unload}
    whole = ratd.stretch(run, **how)
    seen = []

    def stop(phi, tension, seconds_to_go):
        seen.append(phi)
        if len(seen) == 30:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        ratd.stretch(run, **how, checkpoint=tmp_path / "pull", progress=stop)
    went_on = []
    again = ratd.stretch(run, **how, checkpoint=tmp_path / "pull", progress=lambda phi, *_: went_on.append(phi))
    assert went_on[0] < seen[-2]
    assert again.equals(whole) and again.attrs == whole.attrs


def test_a_pull_goes_on_from_the_file_of_a_compression_and_after_a_kill_with_the_same_bits(run, tmp_path, monkeypatch):
    settings = {"k_n": 0.01, "timestep_factor": 0.14, "pull": {"strain_rate": 3e-5, "axes": "x", "unload": False}}
    whole = pulled(run, settings)
    io.write(tmp_path / "pressed.nc", pressed(run), "pressed")
    kept = io.read(tmp_path / "pressed.nc", "pressed")
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    seen = []

    def kill(phi, *_):
        seen.append(phi)
        if len(seen) == 30:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        pulled(kept, settings, progress=kill, checkpoint=tmp_path / "checkpoint")
    went_on = []
    how = {"progress": lambda phi, *_: went_on.append(phi), "checkpoint": tmp_path / "checkpoint"}
    assert pulled(kept, settings, **how).equals(whole)
    assert went_on[0] < seen[-2]


def test_an_aggregate_that_fills_a_box_is_pulled_as_the_compression_is(run):
    """The same spheres without their history: what they slid and rolled is forgotten, so only nearly the same."""
    cluster = ratd.Grain(run["position"].values, run["radius"].values, "ice")
    edge = float(run["box_length"].values[-1, 0])
    pulled, beside = ratd.stretch(cluster, 3e-5, box_length=edge), ratd.stretch(run, 3e-5)
    assert pulled.attrs["phi_start"] == pytest.approx(beside.attrs["phi_start"], rel=1e-9)
    assert pulled.attrs["tensile_strength"] == pytest.approx(beside.attrs["tensile_strength"], rel=0.5)
    with pytest.raises(ratd.InputError, match="box_length belongs to a ratd.Grain"):
        ratd.stretch(run, box_length=edge)
    with pytest.raises(ratd.InputError, match="box_length is missing; a ratd.Grain needs that of the periodic box"):
        ratd.stretch(cluster)
    with pytest.raises(
        ratd.InputError, match=r"box_length is .* m, in which compressed, .* m long, does not touch its"
    ):
        ratd.stretch(cluster, box_length=10.0 * edge)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"axes": "y"}, "axes is 'y'; allowed are x, xyz"),
        ({"axes": ["x"]}, "axes is \\['x'\\]; allowed are x, xyz"),
        ({"unload": 1}, "unload is 1; it must be True or False"),
        ({"strain_rate": -1}, "strain_rate is -1; it must be a number above 0"),
    ],
)
def test_bad_input_of_a_pull_is_one_sentence(run, arguments, said):
    with pytest.raises(ratd.InputError, match=said):
        ratd.stretch(run, **arguments)
    with pytest.raises(ratd.InputError, match="compressed must be a ratd.Grain, or what ratd.compress returned"):
        ratd.stretch(run[["phi"]])
    with pytest.raises(ratd.InputError, match="compressed must be a ratd.Grain, or what ratd.compress returned"):
        ratd.stretch(None)
    with pytest.raises(ratd.InputError, match="compressed must be a ratd.Grain, or what ratd.compress returned"):
        ratd.stretch(run.isel(record=slice(0, 0)))


def test_the_state_of_a_run_can_be_taken_up(run):
    from ratd.experiments.compression.strain import Parts, state_of

    state = state_of(run)
    again = strain_dataset(state, np.zeros((1, 60)), Parts(None, None, None))
    assert (again["position"].values == run["position"].values).all()
    assert Cluster(ratd.grow_bcca(64, seed=0)).volume == pytest.approx(64 * 4 / 3 * np.pi * 1e-21)


def lattice(along_x):
    """64 spheres of ice at rest against each other along y and z, with a gap along x [m], and the edges of a box."""
    ice = MATERIALS["ice"]
    rest = equilibrium_compression(0.5e-7, ice.surface_energy, ice.reduced_modulus)
    step = np.array([2e-7 + along_x, 2e-7 - rest, 2e-7 - rest])
    places = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return ratd.Grain(places * step, np.full(64, 1e-7), ice), 4 * step


@pytest.mark.parametrize("along_x", [0.0, 1e-12])
def test_spheres_a_hair_apart_hold_as_those_that_touch(along_x):
    """The tension of 8/9 of the pull-off force, at first touch, on each contact across a face."""
    grain, edges = lattice(along_x)
    assert grain.n_contacts == 144
    pulled = ratd.stretch(grain, 5e-5, box_length=edges)
    at_touch = 8.0 / 9.0 * pull_off_force(0.5e-7, 0.1) * 16 / (edges[1] * edges[2])
    assert -pulled.attrs["residual_pressure"] == pytest.approx(at_touch, rel=0.02)
    # never below what it holds at rest
    assert pulled.attrs["tensile_strength"] == pytest.approx(at_touch, rel=0.02)
    assert pulled.attrs["phi_strength"] == pulled.attrs["phi_start"]


def test_a_tension_that_peaks_within_the_mean_is_told(tmp_path):
    """Contacts that all part at once, at 1.19 MPa, in 0.9 % of the length."""
    ice = MATERIALS["ice"]
    grain, edges = lattice(-equilibrium_compression(0.5e-7, ice.surface_energy, ice.reduced_modulus))
    with pytest.warns(UserWarning, match="the tension peaks in less than 2 %"):
        pulled = ratd.stretch(grain, 1e-4, box_length=edges)
    exact = pull_off_force(0.5e-7, 0.1) * 16 / (edges[1] * edges[2])
    assert pulled.attrs["tensile_strength"] < 0.5 * exact < pulled.attrs["greatest_record"] < exact
    # the file of the command says so too, whenever it is read
    several(
        tmp_path / "a.nc",
        "stretched",
        ice,
        provenance("code", {}),
        1,
        lambda *_: stretched_row(pulled.assign_attrs(seed=0)),
    )
    assert any(line.startswith("but the tension peaks") for line in show(tmp_path / "a.nc", tmp_path / "a"))


def test_a_box_shrinks_with_the_touching_spheres_that_fill_it():
    places = np.stack(np.meshgrid(*[np.arange(4)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    grain = ratd.Grain(places * 2e-7, np.full(64, 1e-7), "ice")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pulled = ratd.stretch(grain, 1e-4, box_length=8e-7)
    rest = equilibrium_compression(0.5e-7, 0.1, MATERIALS["ice"].reduced_modulus)
    assert pulled["box_length"].values[0, 1] == pytest.approx(8e-7 - 4 * rest, rel=1e-9)
    assert pulled["n_contacts"].values[0] == 192


def test_a_straight_chain_that_cannot_give_way_is_told_of():
    places = np.outer(np.arange(40), [2e-7, 0.0, 0.0])
    with pytest.warns(UserWarning, match="at the end monomers overlap by up to .* a perfectly straight or regular"):
        ratd.compress(ratd.Grain(places, np.full(40, 1e-7), "ice"), 1e-3, 0.2, balance=False)


def test_runs_of_one_aggregate_have_no_error():
    grain = ratd.grow_bcca(64, seed=0)
    moved = grain.position + 1e-12 * np.random.default_rng(0).normal(size=(64, 3))
    runs = [ratd.compress(each, 3e-5, 0.25) for each in (grain, ratd.Grain(moved, grain.radius, "ice"))]
    with pytest.warns(UserWarning, match="the 2 runs are of one aggregate"):
        found = ratd.compressive_strength(runs, 0.06, 0.2)
    assert found["n"] == 2 and np.isnan(found["ratio_error"]) and found["ratio"] > 0.0
