"""`evolve` as a user meets it: what is refused, what comes back, in which order, after a kill, and free bodies."""

import warnings
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.engine import checkpoint as checkpoints
from ratd.engine.layout import CONTACTS, DT, FASTEST, SCALARS
from ratd.experiments import evolve as module
from ratd.experiments import intervals
from ratd.experiments.evolve import RECORDS, evolve
from ratd.geometry.box import periodic
from ratd.laws import dmt, jkr
from ratd.laws.contact_constants import equilibrium_compression
from systems import clusters, tree

A = 30e-9
PAIR = np.array([[0.0, 0, 0], [59.95e-9, 0, 0]])
GOOD = {"position": PAIR, "radius": [A, A], "material": "q-S", "duration": 1e-10, "records": 2}
NAN = np.array([[0.0, 0, 0], [np.nan, 0, 0]])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"radius": [A]}, r"position has the shape \(2, 3\); it must be \(1, 3\) finite numbers"),
        ({"radius": [A, -A]}, "radius of sphere 1 is .*; it must be a number above 0"),
        ({"radius": [[A, A]]}, "radius has the shape"),
        ({"radius": [], "position": np.zeros((0, 3))}, "n at least 1"),
        ({"radius": [A, np.inf]}, "radius of sphere 1 is inf"),
        ({"position": None}, "position is None"),
        ({"position": NAN}, "position of sphere . is .*; it must be finite numbers"),
        ({"position": PAIR[:, :2]}, r"position has the shape \(2, 2\)"),
        ({"position": "far"}, "position is not an array of numbers"),
        ({"velocity": NAN}, "velocity of sphere . is"),
        ({"box": 1e-6}, r"box is 1e-06; it must be ratd.periodic\(edge\)"),
        ({"timestep_factor": "a"}, "timestep_factor is 'a'"),
        ({"spin": [1.0, 2.0]}, r"spin has the shape \(2,\)"),
        ({"material": "cheese"}, "The material is 'cheese'; allowed are"),
        ({"material": ["q-S"]}, "material is a list of 1"),
        ({"drag": 1e9, "box": periodic(1e-6)}, "drag is for open space"),
        ({"drag": -1.0}, "drag is -1.0"),
        ({"duration": 0.0}, "duration is 0.0; it must be a number above 0"),
        ({"duration": np.nan}, "duration is nan"),
        ({"duration": "long"}, "duration is 'long'"),
        ({"records": 0}, "records is 0"),
        ({"records": 2.5}, "records is 2.5; it must be a whole number"),
        ({"timestep": -1e-12}, "timestep is -1e-12"),
        ({"timestep_factor": 2.0}, "timestep_factor is 2.0"),
        ({"damping": "none"}, "damping is 'none'; allowed are implicit, explicit"),
        ({"contacts": [[0, 2]]}, r"contacts must be pairs \(k, 2\) .* from 0 to 1"),
        ({"contacts": [[0, 0]]}, "contacts must be pairs"),
        ({"contacts": [0, 1]}, "contacts must be pairs"),
        ({"contacts": [[0.0, 1.0]]}, "contacts must be pairs"),
        ({"contacts": [[0, 1], [1, 0]]}, "contacts names the pair 0, 1 more than once"),
        (
            {"contacts": [[0, 0, 1, -1, 0], [0, 0, -1, 1, 0]], "box": periodic(1e-6)},
            "contacts names the pair 0, 0 more than once",
        ),
        ({"balance": "x"}, "balance is 'x'; it must be a number above 0, or None"),
        ({"balance": np.nan}, "balance is nan"),
        ({"balance": True}, "balance is True"),
        (
            {"contacts": [[0, 1]], "position": PAIR * 1.2},
            "the pair 0, 1, but they are apart by 0.4 of the smaller radius; .* numbered from 0 in the order of pos",
        ),
        (
            {"contacts": [[1, 0]], "position": [[0.0, 0, 0], [9e-8, 0, 0]], "box": periodic(1.5e-7)},
            r"apart by 1 of the smaller radius; .* through the wall of the box needs its image too, \(k, 5\)",
        ),
        ({"position": PAIR * 0.0}, "spheres 0 and 1 overlap by 2 of the smaller radius; at most 0.5 is allowed"),
        ({"position": PAIR * 0.7}, "spheres 0 and 1 overlap by 0.6 of"),
        (
            {"box": periodic(1e-10)},
            "box has an edge of 1e-10 m; with spheres of up to 3e-08 m .* at least 4.5e-08",
        ),
        ({"box": periodic(8e-8)}, "spheres 0 and 1 of a neighbouring box overlap by 1.3 of"),
        ({"position": [[0.0, 0, 0]], "radius": [A]}, "timestep is not given; a single sphere needs one"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(InputError, match=words) as caught:
        evolve(**GOOD | arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("law", "arguments", "words"),
    [
        (jkr, {"damping": "strong"}, "damping is 'strong'; allowed are viscoelastic, constant, none"),
        (jkr, {"friction": "velocity"}, "friction is 'velocity'; allowed are springs, none"),
        (jkr, {"sliding_stiffness": 0.0}, "sliding_stiffness is 0.0; it must be a number above 0"),
        (jkr, {"constant_damping": -1.0}, "constant_damping is -1.0"),
        (dmt, {"friction": "springs"}, "friction is 'springs'; allowed are none, velocity, spring"),
        (dmt, {"viscous_time": np.nan}, "viscous_time is nan; it must be a number of at least 0"),
        (dmt, {"rolling_limit": -1.0}, "rolling_limit is -1.0"),
    ],
)
def test_bad_options_of_laws_are_refused(law, arguments, words):
    with pytest.raises(InputError, match=words):
        law(**arguments)


@pytest.mark.parametrize("material", ["ice", "q-S", "silica"])
def test_a_pair_that_starts_off_its_distance_may_vibrate(material):
    """What it stores at the start is what moves; over all its balance is kept."""
    pair = np.array([[0.0, 0.0, 0.0], [2e-7 - 1e-11, 0.0, 0.0]])
    found = evolve(pair, [1e-7, 1e-7], material=material, duration=1e-8)
    stored = found["stored"].values.sum(axis=1)
    assert np.abs(stored - stored[0]).max() > 0.0
    with pytest.raises(RuntimeError, match="take a smaller time step") as ended:
        evolve(pair, [1e-7, 1e-7], material=material, duration=1e-8, balance=1e-4)
    so_far = ended.value.run
    assert 1 < so_far.sizes["record"] <= found.sizes["record"]
    xr.testing.assert_equal(so_far["stored"], found["stored"][: so_far.sizes["record"]])


def run(**options):
    """Two clusters that meet."""
    position, radius, velocity = clusters(10.0)
    return evolve(position, radius, velocity, **{"material": "q-S", "duration": 1e-8, "records": 8} | options)


@pytest.fixture(scope="module")
def whole():
    return run()


def test_records(whole):
    assert set(RECORDS) <= set(whole)
    np.testing.assert_allclose(whole.time, np.linspace(0, 1e-8, 9), rtol=0, atol=2 * whole.attrs["timestep"])
    for name in whole.data_vars:
        assert whole[name].attrs["units"] and whole[name].attrs["long_name"]
    assert whole.n_contacts[0] == 14 and whole.n_contacts[-1] > 14
    assert whole.n_pieces[0] == 2 and whole.n_pieces[-1] == 1
    mass = 4 / 3 * np.pi * MATERIALS["q-S"].density * (whole.radius.values**3)
    assert whole.piece_mass.values[0] == pytest.approx([mass[:8].sum()] * 2, rel=1e-12)
    assert whole.piece_mass.values[-1] == pytest.approx([mass.sum(), 0.0], rel=1e-12)
    assert (whole.piece == 0).all() and (whole.box_length == 0.0).all() and (whole.box_work == 0.0).all()


def test_output_is_in_the_order_of_the_input(whole):
    """Radii tell who is who; and a shuffled input gives the same, shuffled."""
    position, radius, velocity = clusters(10.0)
    np.testing.assert_array_equal(whole.radius, radius)
    materials = np.array(["q-S", "a-C"])[np.arange(16) % 2]
    first = evolve(position, radius, velocity, material=list(materials), duration=2e-10, records=1)
    order = np.random.default_rng(0).permutation(16)
    second = evolve(
        position[order], radius[order], velocity[order], material=list(materials[order]), duration=2e-10, records=1
    )
    for name in ("position", "velocity", "spin", "radius"):
        scale = np.abs(first[name].values).max()
        np.testing.assert_allclose(second[name].values, first[name].values[order], rtol=0, atol=1e-9 * scale)
    assert np.linalg.norm(first.position.values - position, axis=1).max() < 20e-9


def test_a_run_goes_on_after_a_kill_with_the_same_bits(whole, tmp_path, monkeypatch):
    path = tmp_path / "run.npz"
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)

    def kill(done, to_go, row):
        if done > 0.4:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(checkpoint=path, progress=kill)
    parts = []
    again = run(checkpoint=path, progress=lambda done, *_: parts.append(done))
    assert len(parts) == 4 and parts[0] > 0.5
    xr.testing.assert_identical(again, whole)
    # that of other input is not used
    other = run(checkpoint=path, law=jkr(damping="constant"), progress=lambda done, *_: parts.append(done))
    assert len(parts) == 12 and not other.identical(whole)
    # nor that of another source
    run(checkpoint=path, law=jkr(damping="constant"), progress=lambda done, *_: parts.append(done))
    assert len(parts) < 20
    monkeypatch.setattr(checkpoints, "_source", lambda module: "of yesterday")
    before = len(parts)
    run(checkpoint=path, law=jkr(damping="constant"), progress=lambda done, *_: parts.append(done))
    assert len(parts) == before + 8


def test_a_run_that_goes_on_judges_its_steps_by_the_first_one(whole, tmp_path, monkeypatch):
    """The step may have become short before the kill."""
    firsts = []
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    monkeypatch.setattr(module, "CALL", 10)
    monkeypatch.setattr(module, "_check_pace", lambda state, first_step: firsts.append(first_step))

    def kill(done, to_go, row):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(checkpoint=tmp_path / "run.npz", progress=kill)
    before, load = firsts[:], checkpoints.load

    def shortened(path, key):
        state, tables = load(path, key)
        state.scalar[DT] *= 0.5
        return state, tables

    monkeypatch.setattr(checkpoints, "load", shortened)
    run(checkpoint=tmp_path / "run.npz")
    assert before and len(firsts) > len(before) and len(set(firsts)) == 1


@pytest.mark.parametrize("speed", [1.0, 10.0, 50.0])
@pytest.mark.parametrize("records", [1, 100, 400])
def test_two_spheres_that_meet_keep_the_balance_with_the_default_step(speed, records):
    """In the first step of a contact the damping takes a tenth of the energy, of which a record knows half a step."""
    position, velocity = [[0, 0, 0], [0, 60e-9, 0]], [[0, 0, 0], [0, -speed, 0]]
    run = evolve(position, [2e-8, 2e-8], velocity, duration=1e-7 / speed, records=records)
    assert run["n_contacts"][-1] == 1
    assert abs(run["residual"][-1]) < 0.05 * run["kinetic_translation"][0]


def test_a_balance_is_judged_by_a_whole_vibration_however_close_the_records():
    """The pair is let go off its distance: in its first steps it has moved little of what it will."""
    run = evolve([[0, 0, 0], [0, 0, 39.9e-9]], [2e-8, 2e-8], duration=1e-10, records=100)
    moved = np.ptp(run["stored"].sum("storage").values)
    first = run.isel(record=run["time"].values < 1.5 * run.attrs["timestep"])
    assert abs(first["residual"]).max() > 0.05 * np.ptp(first["stored"].sum("storage").values)
    assert abs(run["residual"]).max() < 0.05 * moved


def test_a_record_that_no_step_parts_from_the_last_one_repeats_it():
    box = periodic([79.8e-9, 1e-7, 1e-7])
    run = evolve([[0, 0, 0], [39.9e-9, 0, 0]], [2e-8, 2e-8], box=box, duration=2e-11, records=100, balance=None)
    same = np.diff(run["time"].values) == 0.0
    assert same.any() and not same.all()
    pressure = run["pressure_tensor"].values[:, 0]
    assert (np.diff(pressure)[same] == 0.0).all() and (pressure[1:] != 0.0).all()


def test_an_error_leaves_the_contacts_that_the_run_had_by_then():
    """Spheres that come into contact need more room than they had at the start; then a step is far too long."""
    grid = 39.9e-9 * np.stack(np.meshgrid(*[np.arange(8)] * 3, indexing="ij"), -1).reshape(-1, 3)
    with pytest.raises(RuntimeError, match="a velocity is no finite number") as caught:
        evolve(grid, np.full(512, 2e-8), contacts=[], timestep=1e160, duration=1e161, records=1, balance=None)
    state = caught.value.state
    assert state.counter[CONTACTS] <= len(state.pair_i)
    assert caught.value.run.sizes["monomer"] == 512


@pytest.mark.parametrize("speed", [5.0, 20.0, 50.0])
@pytest.mark.parametrize("stretched", [0.6, 0.8])
def test_a_stretched_pair_that_is_pushed_together_does_not_explode(speed, stretched):
    """Near the end of its branch a contact may spring back by half of delta_0 in one step of the default length."""
    radius, material = 50e-9, MATERIALS["q-S"]
    delta_0 = equilibrium_compression(0.5 * radius, material.surface_energy, material.reduced_modulus)
    run = evolve(
        [[0, 0, 0], [2 * radius + stretched * delta_0, 0, 0]], [radius] * 2, [[speed, 0, 0], [0, 0, 0]],
        material=material, contacts=[[0, 1]], duration=1e-9, balance=None,
    )  # fmt: skip
    assert run["kinetic_translation"].max() < 1.01 * run["kinetic_translation"][0]


def test_velocity_and_spin_of_the_same_numbers_are_told_apart(tmp_path, monkeypatch):
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    options = GOOD | {"checkpoint": tmp_path / "run.npz", "balance": None}
    motion = np.array([[0.0, 0, 1.0], [0, 0, -1.0]])
    moving = evolve(**options, velocity=motion)
    spinning = evolve(**options, spin=motion)
    assert moving.kinetic_translation[0] > 0.0 and spinning.kinetic_translation[0] == 0.0


def test_contacts_can_be_chosen():
    """Spheres that overlap are in contact, unless contacts are given."""
    near = np.array([[0.0, 0, 0], [60.02e-9, 0, 0]])
    options = GOOD | {"position": near, "timestep": 1e-13}
    assert evolve(**options).n_contacts[0] == 0
    given = evolve(**options | {"contacts": [[1, 0]]})
    # a hair beyond touch it still holds, and pulls
    assert given.n_contacts[0] == 1 and given.velocity[1, 0] < 0.0
    assert evolve(**GOOD | {"contacts": [], "balance": None}).n_contacts[-1] == 1


def test_two_free_bodies_keep_their_momenta_and_places():
    """Nothing moves the origin: one goes right, one up, and they never meet."""
    radius = np.full(10, A)
    position = np.concatenate([tree(radius[:5], "q-S", 1), tree(radius[5:], "q-S", 2) + [0, 400e-9, 0]])
    velocity = np.zeros((10, 3))
    velocity[:5, 0], velocity[5:, 1] = 3.0, 5.0
    velocity += [0.7, -0.2, 0.1]
    end = evolve(position, radius, velocity, material="q-S", duration=3e-8, records=3)
    assert (end.n_pieces == 2).all()
    for name in ("momentum", "angular_momentum"):
        drift = end[name].values - end[name].values[0]
        assert np.abs(drift).max() < 1e-12 * np.abs(end[name].values[0]).max()
    time = float(end.time[-1])
    for body in (slice(0, 5), slice(5, 10)):
        wanted = position[body].mean(axis=0) + velocity[body].mean(axis=0) * time
        np.testing.assert_allclose(end.position.values[body].mean(axis=0), wanted, rtol=0, atol=1e-16)


def test_drag_brings_to_rest():
    """A pair that moves and turns about its line of centres as a whole."""
    velocity, spin = [[0, 0, 1.0]] * 2, [[1e7, 0, 0]] * 2
    end = evolve(**GOOD | {"velocity": velocity, "spin": spin, "drag": 2e10, "duration": 1e-10, "timestep": 1e-13})
    time = float(end.time[-1])
    np.testing.assert_allclose(end.velocity.values[:, 2], np.exp(-2e10 * time), rtol=2e-3)
    np.testing.assert_allclose(end.spin.values[:, 0], 1e7 * np.exp(-2e10 * time), rtol=2e-3)


def test_spheres_that_do_not_touch_have_a_time_step():
    """That of a contact between the two smallest."""
    apart = np.array([[0.0, 0, 0], [70e-9, 0, 0], [0, 80e-9, 0]])
    radius = [A, A, 1.2 * A]
    free = evolve(apart, radius, material="q-S", duration=1e-10, records=1, timestep_factor=0.1)
    held = evolve(PAIR, [A, A], material="q-S", duration=1e-10, records=1, timestep_factor=0.1)
    assert free.attrs["timestep"] == pytest.approx(held.attrs["timestep"], rel=1e-12)
    assert free.n_contacts[-1] == 0


@pytest.mark.parametrize("duration", [1e-10, 1e-9, 1e-8])
def test_a_pair_near_rest_keeps_its_balance_whatever_the_records(duration):
    run = evolve([[0, 0, 0], [0, 0, 39.95e-9]], [20e-9] * 2, material="q-S", duration=duration)
    stored = np.abs(run["stored"].values[-1]).sum()
    assert np.abs(run["residual"].values).max() < 1e-4 * stored


def test_a_long_record_is_made_in_calls(tmp_path, monkeypatch):
    """So that it can be stopped, and goes on, in its middle."""
    how = {"material": "q-S", "duration": 2e-9, "records": 1}
    pair = [[0, 0, 0], [0, 0, 39.9e-9]], [20e-9] * 2
    monkeypatch.setattr(module, "CALL", 100)
    whole = evolve(*pair, **how)
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    parts = []

    def stop(part, to_go, row):
        parts.append(part)
        if len(parts) == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        evolve(*pair, **how, checkpoint=tmp_path / "evolve", progress=stop)
    assert 0.0 < parts[0] < parts[-1] < 1.0
    xr.testing.assert_identical(evolve(*pair, **how, checkpoint=tmp_path / "evolve"), whole)


def test_a_run_of_days_is_warned_of_once(monkeypatch):
    """As one whose duration was meant in ns is: in one call of the engine 1e5 of 4e12 steps are made."""

    class Stopped(Exception):
        pass

    calls = []

    def stopping(*arguments):
        calls.append(arguments)
        if len(calls) == 4:
            raise Stopped
        return run(*arguments)

    run = module.run
    monkeypatch.setattr(module, "run", stopping)
    monkeypatch.setattr(intervals, "FORECAST", 0.0)
    with pytest.warns(UserWarning, match=r"duration is 10 s, .* steps of .* s: this takes some .* days") as found:
        with pytest.raises(Stopped):
            evolve(**GOOD | {"duration": 10.0})
    assert len(found) == 1
    monkeypatch.setattr(module, "run", run)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        evolve(**GOOD)


def test_spheres_that_may_pass_through_each_other_are_warned_of():
    fast = {"position": [[0, 0, 0], [42e-9, 0, 0]], "radius": [20e-9] * 2, "velocity": [[5.0, 0, 0], [-5.0, 0, 0]]}
    with pytest.warns(UserWarning, match="meet at 10 m/s come nearer by 1e-07 m in a step of 1e-08 s"):
        evolve(**fast, duration=2e-8, timestep=1e-8)


def test_spheres_that_fly_at_each_other_meet_however_fast():
    """The first step too is so short that none moves by more than a part of its radius."""
    fast = {"position": [[0, 0, 0], [0, 0, 2.5 * A]], "radius": [A, A], "velocity": [[0, 0, 1e4], [0, 0, -1e4]]}
    run = evolve(**fast, material="q-S", duration=0.01 * A / 1e4, records=1, balance=None, timestep_factor=0.125)
    assert run["position"][0, 2].item() == pytest.approx(0.125 * A, rel=1e-6)
    run = evolve(**fast, material="q-S", duration=0.4 * A / 1e4, records=8, balance=None)
    assert run["n_contacts"].values.max() == 1


def test_a_run_that_has_blown_up_ends_before_its_next_record():
    """Its balance is looked at only there, and its steps become so short that it would never come to it."""
    state = SimpleNamespace(scalar=np.zeros(len(SCALARS)))
    state.scalar[DT], state.scalar[FASTEST] = 2e-15, 1e9
    module._check_pace(state, 1e-12)
    with pytest.raises(
        RuntimeError, match=r"moves at 1e\+09 m/s, .* 1e-11 s at the start, is down to 2e-15 s: the run has"
    ):
        module._check_pace(state, 1e-11)


def test_pieces_are_numbered_by_their_mass():
    """A sphere alone, given first, beside a pair."""
    position = [[0, 0, 0], [1e-6, 0, 0], [1e-6 + 1.99e-8, 0, 0]]
    run = evolve(position, np.full(3, 1e-8), duration=1e-11, records=2, snapshot_every=1)
    assert run["piece"].values.tolist() == [1, 0, 0] and (run["snapshot_piece"] == run["piece"]).all()


def test_the_last_record_has_a_snapshot_whatever_lies_between_two():
    run = evolve([[0, 0, 0], [1e-6, 0, 0]], [1e-8] * 2, duration=1e-10, timestep=1e-12, records=3, snapshot_every=2)
    assert run["snapshot_time"].values.tolist() == run["time"].values[[0, 2, 3]].tolist()
