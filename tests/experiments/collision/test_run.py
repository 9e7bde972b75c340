"""`ratd.collide`: what comes back, what is refused, the same bits after a kill; two spheres and their solution."""

import math
import warnings

import numpy as np
import pytest
import xarray as xr

import ratd
from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.experiments import intervals
from ratd.experiments.collision.approach import approach, first_touch
from ratd.experiments.collision.files import collision_row
from ratd.experiments.collision.laws import balance_of, longest_step, step_of
from ratd.experiments.collision.run import at_rest, collide
from ratd.experiments.collision.sticking import breaking_energy_of, parting_velocity, sticking_velocity
from ratd.experiments.evolve import evolve
from ratd.laws.derjaguin_muller_toporov import adhesion_force, equilibrium_overlap, hertz_stiffness
from ratd.laws.dmt_with_friction import viscous_time_of
from ratd.laws.johnson_kendall_roberts import viscoelastic_damping

SILICA = MATERIALS["silica"]
SMALL = ratd.build_cluster(np.full(14, 0.3e-6), 1.1e-6, second_contact=0.5, seed=1)
MIXED = ratd.build_cluster(np.linspace(0.5e-6, 0.2e-6, 10), 1.3e-6, seed=2)
QUICK = {"duration": 3e-7, "records": 6, "snapshot_every": 3}


@pytest.fixture(scope="module")
def run():
    return collide(SMALL, SMALL, 4.0, seed=3, **QUICK)


def test_what_a_run_holds(run):
    assert run.sizes["record"] == 7 and run.sizes["snapshot"] == 3 and run.sizes["monomer"] == 28
    assert run.n_pieces[0] == 2 and run.n_contacts[0] == 2 * SMALL.n_contacts and run.n_contacts[-1] > run.n_contacts[0]
    mass = SMALL.mass.sum()
    assert run.attrs["impact_energy"] == pytest.approx(mass * 4.0**2 / 4, rel=1e-12)
    assert float(run.kinetic_translation[0]) == pytest.approx(run.attrs["impact_energy"], rel=1e-9)
    assert run.attrs["balance"] <= 0.01 and run.attrs["balance"] == pytest.approx(
        np.abs(run.residual.values).max() / run.attrs["impact_energy"]
    )
    np.testing.assert_allclose(run.snapshot_time, run.time.values[[0, 3, 6]])
    assert np.array_equal(run.snapshot_position[-1], run.position) and np.array_equal(run.snapshot_piece[-1], run.piece)
    found = ratd.fragmentation(run)
    masses = run.piece_mass.values[-1]
    assert float(found["X"]) == pytest.approx((masses[0] - masses[1]) / (2 * mass))
    for name in ("momentum", "angular_momentum"):
        scale = mass * 4.0 * (1.0 if name == "momentum" else 2e-6)
        assert np.abs(run[name].values - run[name].values[0]).max() < 1e-11 * scale


def test_a_run_goes_on_after_a_kill_with_the_same_bits(run, tmp_path, monkeypatch):
    monkeypatch.setattr(intervals, "CHECKPOINT", 0.0)
    monkeypatch.setattr(intervals, "PROGRESS", 0.0)
    told = []

    def kill(time, pieces, energy_left, to_go):
        told.append((time, pieces, energy_left))
        if time > 1.4e-7:
            raise KeyboardInterrupt

    how = QUICK | {"checkpoint": tmp_path / "run.npz"}
    with pytest.raises(KeyboardInterrupt):
        collide(SMALL, SMALL, 4.0, seed=3, **how, progress=kill)
    assert len(told) == 3 and told[0][1] >= 1 and 0.0 < told[-1][2] <= 1.0
    again = collide(SMALL, SMALL, 4.0, seed=3, **how, progress=lambda *words: told.append(words))
    assert len(told) == 6
    xr.testing.assert_identical(again, run)


def test_two_different_clusters_and_the_other_law():
    run = collide(SMALL, MIXED, 2.0, 0.2, seed=1, law="jkr", duration=1e-7, records=2, snapshot_every=0)
    assert "JKR" in run.attrs["law"] and "snapshot_time" not in run
    assert run.cluster.values.tolist() == [0] * 14 + [1] * 10
    masses = SMALL.mass.sum(), MIXED.mass.sum()
    assert run.attrs["impact_energy"] == pytest.approx(0.5 * masses[0] * masses[1] / sum(masses) * 4.0)
    assert run.n_contacts[-1] > run.n_contacts[0]
    # the largest sphere of all is in the second cluster, and its part is that of this one's mass
    row = collision_row(run)
    assert row["largest_radius"].item() == MIXED.radius.max()
    assert row["largest_share"].item() == pytest.approx(MIXED.mass.max() / masses[1], rel=1e-12)


def test_built_clusters_are_at_rest_and_others_come_to_rest():
    apart = np.linalg.norm(SMALL.position[:, None] - SMALL.position[None], axis=2)
    rested = at_rest(SMALL).position
    np.testing.assert_allclose(np.linalg.norm(rested[:, None] - rested[None], axis=2), apart, atol=1e-16)
    # under the other law spheres rest at another overlap
    other = at_rest(SMALL, "jkr")
    moved = np.linalg.norm(other.position[:, None] - other.position[None], axis=2) - apart
    i, j = SMALL.contacts.T
    assert (moved[i, j] > 0.0).all() and moved[i, j].max() < 1e-9


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"velocity": 0.0}, "velocity is 0.0; it must be a number above 0"),
        ({"velocity": -3.0}, "velocity is -3.0"),
        ({"velocity": np.nan}, "velocity is nan"),
        (
            {"velocity": 1e5, "timestep": 1e-12},
            r"velocity is 100000 m/s: in a timestep of .* take a timestep of at most",
        ),
        ({"law": "hertz"}, "law is 'hertz'; allowed are 'dmt', 'jkr'"),
        ({"law": 3}, "law is 3; allowed are"),
        ({"impact_parameter": 1.0}, "impact_parameter is 1.0"),
        ({"seed": -1}, "seed is -1"),
        ({"relaxed": "no"}, "relaxed is 'no'; it must be True or False"),
        ({"gap": -1e-9}, "gap is -1e-09; .* may not overlap"),
        ({"gap": 1.0}, "gap is 1 m; the clusters are .* m wide, and it must be at most 100 times as much"),
        ({"timestep": 1e-9}, r"timestep is 1e-09 s; the smallest sphere, 3e-07 m, allows at most \d"),
        ({"b": "cluster"}, "b is of type str; it must be a ratd.Grain"),
        ({"b": ratd.build_cluster([1e-7] * 3, 1e-6, "q-S")}, "are of 'silica' and of 'q-S'; they must be of one"),
        ({"records": 0}, "records is 0"),
        ({"snapshot_every": -1}, "snapshot_every is -1"),
        ({"duration": 0.0}, "duration is 0.0"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(arguments, words):
    with pytest.raises(InputError, match=words) as caught:
        collide(**{"a": SMALL, "b": SMALL, "velocity": 1.0, "relaxed": True} | QUICK | arguments)
    assert "\n" not in str(caught.value)


def test_a_collision_that_leaves_the_balance_ends_with_an_error(monkeypatch):
    monkeypatch.setattr("ratd.experiments.collision.run.balance_of", lambda law: 1e-9)
    with pytest.raises(RuntimeError, match="the balance of energy is off by .* allowed are 0.0% of"):
        collide(SMALL, SMALL, 5.0, relaxed=True, duration=3e-8, records=3, snapshot_every=0)


def test_steps_and_balances_that_are_allowed():
    """The limit of `longest_step` is a quarter of the time of the damping."""
    radius = np.array([50e-9, 1e-6])
    law = ratd.laws.dmt()
    assert step_of(radius, SILICA, law, 10.0) < longest_step(radius, SILICA, law)
    # about 1 ps, as the paper has for spheres of 50 nm, and less with more damping
    assert step_of(radius, SILICA, law, 10.0) == pytest.approx(1e-12, rel=0.35)
    assert step_of(radius, SILICA, ratd.laws.dmt(viscous_time=1e-9), 10.0) == pytest.approx(0.5e-12, rel=0.35)
    assert balance_of(law) == 0.01 and balance_of(ratd.laws.dmt(friction="spring")) == 0.03
    slow = ratd.laws.dmt(friction_time=1e-13)
    assert step_of(radius, SILICA, slow, 10.0) == pytest.approx(1e-13 / 15)


def test_a_large_partner_shortens_the_step_of_a_small_sphere():
    """The time of the damping, m/(K A sqrt(delta_eq)), with K and delta_eq of the pair."""
    small, large, viscous = 50e-9, 1e-6, 1e-9
    steps = []
    for other in (small, large):
        r = small * other / (small + other)
        hertz = hertz_stiffness(r, SILICA.reduced_modulus)
        overlap = equilibrium_overlap(hertz, adhesion_force(r, SILICA.surface_energy))
        mass = SILICA.density * 4.0 / 3.0 * np.pi * small**3
        steps.append(mass / (hertz * viscous * np.sqrt(overlap)) / 16.0)
    law = ratd.laws.dmt(viscous_time=viscous)
    assert step_of(np.array([small]), SILICA, law, 10.0) == pytest.approx(steps[0], rel=1e-6)
    assert step_of(np.array([large, small]), SILICA, law, 10.0) == pytest.approx(steps[1], rel=1e-6)


def test_the_faster_the_shorter_the_step():
    radius, jkr = np.array([0.5e-6, 1e-6]), ratd.laws.jkr()
    slow, fast = (step_of(radius, SILICA, jkr, velocity) for velocity in (10.0, 320.0))
    # the time of an impact goes with the velocity to the power of -1/5
    assert slow == pytest.approx(2.0 * fast, rel=1e-9)
    # no farther than 2 % of the smallest radius
    for law in (jkr, ratd.laws.dmt()):
        assert step_of(radius, SILICA, law, 1e6) == pytest.approx(1e-14, rel=1e-9)


def test_hard_impacts_of_large_spheres_keep_their_energy_under_jkr():
    """With the step of a contact at rest this run would end with spheres that fly away at kilometres a second."""
    cluster = ratd.grow_bcca(16, "q-S", radius=1e-6, seed=2)
    run = ratd.collide(cluster, cluster, velocity=50.0, law="jkr", duration=8e-7, records=10)
    assert run.attrs["balance"] < 2e-3 and run.n_pieces.values[-1] > 20


def meet(velocity, a_i=0.3e-6, a_j=0.57e-6, *, aside=0.0, spin=None, law=None, duration=4e-8):
    """Two spheres that meet, a little apart at the start."""
    position = np.array([[0.0, 0.0, 0.0], [a_i + a_j + 1e-11, aside, 0.0]])
    law = ratd.laws.dmt(friction="none") if law is None else law
    return evolve(
        position, [a_i, a_j], [[velocity, 0, 0], [0, 0, 0]], spin, "silica", law=law, duration=duration,
        timestep=2e-13, damping="explicit", records=1, balance=None,
    )  # fmt: skip


@pytest.mark.parametrize("velocity", [1.5, 3.0, 10.0])
def test_restitution_of_unequal_spheres(velocity):
    """Against the equation of motion of the overlap, integrated by an independent method."""
    run = meet(velocity)
    parted = run.velocity.values[1, 0] - run.velocity.values[0, 0]
    assert run.n_contacts[-1] == 0
    assert parted == pytest.approx(parting_velocity(velocity, 0.3e-6, 0.57e-6, SILICA, 0.5e-9), rel=2e-3)


def test_sticking_velocity():
    """Table of collision.md, Sect. 1, and the engine on both sides of it."""
    table = {0.396e-6: 0.750, 0.57e-6: 0.356}
    for radius, wanted in table.items():
        assert sticking_velocity(radius, radius, SILICA, 0.5e-9) == pytest.approx(wanted, rel=3e-3)
    assert sticking_velocity(0.05e-6, 0.05e-6, SILICA, 0.5e-9) == np.inf
    assert sticking_velocity(0.57e-6, 0.57e-6, SILICA, 0.0) == 0.0
    assert breaking_energy_of(0.57e-6, 0.57e-6, SILICA) == pytest.approx(1.47e-17, rel=5e-3)
    unequal = sticking_velocity(0.3e-6, 0.57e-6, SILICA, 0.5e-9)
    assert meet(0.98 * unequal).n_contacts[-1] == 1 and meet(1.02 * unequal).n_contacts[-1] == 0


@pytest.mark.parametrize(("a_i", "a_j"), [(50e-9, 0.5e-6), (50e-9, 0.1e-6), (70e-9, 0.3e-6)])
def test_the_longest_step_of_the_document_does_for_two_spheres(a_i, a_j):
    """3.5 ps, a sixth to a fifth of the time of the damping: what single impacts keep is that of a step of 0.25 ps."""
    left = []
    for timestep in (3.5e-12, 0.25e-12):
        for part in (0.1, 0.4, 0.7, 0.9):
            aside = part * (a_i + a_j)
            position = [[0.0, 0.0, 0.0], [math.sqrt((a_i + a_j) ** 2 - aside**2) + 1e-11, aside, 0.0]]
            run = evolve(
                position, [a_i, a_j], [[20.0, 0, 0], [0, 0, 0]], None, "silica", law=ratd.laws.dmt(), duration=5e-9,
                timestep=timestep, damping="explicit", records=1, balance=None,
            )  # fmt: skip
            energy = (run["kinetic_translation"] + run["kinetic_spin"]).values
            left.append(energy[-1] / energy[0])
    assert np.ptp(left[:4]) > 0.1
    np.testing.assert_allclose(left[:4], left[4:], atol=1e-5)


@pytest.mark.parametrize("friction", ["velocity", "spring"])
def test_momenta_with_unequal_radii_and_spins(friction):
    spin = [[3e6, -2e6, 1e6], [-1e6, 4e6, 2e6]]
    run = meet(2.0, aside=0.2e-6, spin=spin, law=ratd.laws.dmt(friction=friction), duration=2e-8)
    assert run.n_contacts[-1] in (0, 1) and float(run.dissipated[-1].sum()) > 0.0
    for name in ("momentum", "angular_momentum"):
        first, last = run[name].values
        assert np.abs(last - first).max() < 1e-11 * np.abs(first).max()


def test_two_that_do_not_meet_are_warned_of():
    with pytest.warns(UserWarning, match=r"do not meet: they begin 2e-08 m apart with 0.01 m/s; take at least 4e-06 s"):
        run = collide(SMALL, SMALL, 0.01, relaxed=True, **QUICK)
    assert run["n_pieces"].values[-1] == 2


@pytest.mark.parametrize("seed", range(3))
def test_own_spheres_that_only_touch_come_to_rest_in_one_piece(seed):
    """At exactly a_i + a_j, as files of other programs have them; under DMT nothing pulls beyond touch."""
    rng = np.random.default_rng(seed)
    position = [np.zeros(3)]
    while len(position) < 10:
        direction = rng.normal(size=3)
        place = position[rng.integers(len(position))] + 2e-7 * direction / np.linalg.norm(direction)
        if min(np.linalg.norm(place - other) for other in position) > 1.999e-7:
            position.append(place)
    grain = ratd.Grain(np.array(position), np.full(10, 1e-7), "q-S")
    rested = at_rest(grain)
    assert len(rested.contacts) == len(grain.contacts) == 9
    distance = np.linalg.norm(rested.position[rested.contacts[:, 0]] - rested.position[rested.contacts[:, 1]], axis=1)
    assert (distance < 2e-7).all()


def test_two_that_pass_within_the_gap_do_not_meet():
    """They come within 20 nm of each other on straight lines, and do not touch."""
    passed = 0
    for seed in range(60):
        how = {"impact_parameter": 0.8, "seed": seed, "relaxed": True, "duration": 3e-7, "records": 3}
        near = [approach(SMALL, SMALL, 10.0, 0.8, gap, seed)[2] for gap in (20e-9, 1e-12)]
        assert near[0] == near[1]
        if not near[0] and np.isfinite(reach_of(seed)):
            with pytest.warns(UserWarning, match="the two pass each other"):
                run = collide(SMALL, SMALL, 10.0, **how)
            assert (run["n_contacts"].values == 2 * SMALL.n_contacts).all()
            passed += 1
            break
    assert passed == 1


def reach_of(seed):
    """Shift at which the two of a seed are 20 nm apart; infinite where they pass by more."""
    position, *_ = approach(SMALL, SMALL, 10.0, 0.8, 20e-9, seed)
    first, other = np.split(position, 2)
    return first_touch(first, SMALL.radius, other, SMALL.radius, 20e-9)


def test_an_early_state_of_a_collision_is_told():
    with pytest.warns(UserWarning, match="after 2e-08 s the two still fly at each other"):
        collide(SMALL, SMALL, 10.0, relaxed=True, duration=2e-8, records=3, snapshot_every=0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        collide(SMALL, SMALL, 1.0, relaxed=True, duration=1.5e-6, records=3, snapshot_every=0)


def test_the_damping_is_that_of_the_material():
    """As of JKR at the same radius of the contact; for silica the 0.5 ns that is recalled of the paper's authors."""
    assert viscous_time_of(ratd.laws.dmt(), SILICA) == pytest.approx(0.5e-9, rel=1e-3)
    assert viscous_time_of(ratd.laws.dmt(viscous_time=1e-9), SILICA) == 1e-9
    ice = MATERIALS["ice"]
    time = viscous_time_of(ratd.laws.dmt(), ice)
    radius, overlap = 50e-9, 1e-9
    of_dmt = hertz_stiffness(radius, ice.reduced_modulus) * time * math.sqrt(overlap)
    viscosity = ice.viscous_time / ice.poisson_number**2
    assert of_dmt == pytest.approx(viscoelastic_damping(math.sqrt(radius * overlap), ice.reduced_modulus, viscosity))
    pair = ratd.Grain([[0, 0, 0], [2e-7 - 1e-9, 0, 0]], [1e-7, 1e-7], ice)
    how = {"relaxed": True, "duration": 3e-9, "records": 3, "snapshot_every": 0, "timestep": 1e-13}
    told, own = (collide(pair, pair, 20.0, law=ratd.laws.dmt(**law), **how) for law in ({"viscous_time": time}, {}))
    np.testing.assert_array_equal(told["position"], own["position"])
    soft = collide(pair, pair, 20.0, law=ratd.laws.dmt(viscous_time=0.5e-9), **how)
    assert np.abs(soft["position"] - own["position"]).max() > 1e-11
