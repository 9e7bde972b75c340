"""Forces and torques of the laws: derivatives of their own potential, momenta, and the independent slow reference."""

import numpy as np
import pytest

from ratd.base.materials import Material
from ratd.engine.contacts import contact_start
from ratd.engine.layout import DT_DRIFT
from ratd.geometry.box import open_space
from ratd.laws import dmt, jkr
from ratd.laws import dmt_with_friction as dmt_fields
from ratd.laws import jkr_with_springs as jkr_fields
from ratd.laws.contact_fields import E_ROLL, E_SLIDE, E_TWIST
from reference import contact as reference
from systems import field, forces, moved, pair_state, set_fields, unit

BOX = open_space()
SILICA = Material("silica", *reference.SILICA[:5], 5e-12)
ICE = Material("ice", *reference.ICE)
RADII = [(1e-7, 1e-7), (1e-7, 0.6e-7), (2e-8, 1e-6)]
NORMAL = unit(-1.0, -0.4, -0.3)  # the first sphere comes first on the Z-curve as well
JKR = {
    "viscoelastic": (jkr(), reference.JKR()),
    "constant": (jkr(damping="constant", constant_damping=0.3), reference.JKR("constant", 0.3)),
    "none": (jkr(damping="none"), reference.JKR("none")),
    "no friction": (jkr(friction="none"), reference.JKR(friction=False)),
    "DMT normal force": (jkr(normal_force="DMT"), reference.JKRWithDMT()),
}
DMT = {
    friction: (dmt(viscous_time=0.5e-9, friction=friction), reference.DMT(0.5e-9, friction))
    for friction in dmt_fields.FRICTIONS
}


def strained(law, radii, part, compression=1.1, still=False):
    """State of a pair whose displacements are `part` of their limits, and the same for the reference."""
    is_jkr = type(law).__name__ == "JKR"
    material, other = (ICE, reference.ICE) if is_jkr else (SILICA, reference.SILICA)
    pair = reference.Pair(other, *radii)
    rest = pair.delta_0 if is_jkr else pair.delta_eq
    distance = sum(radii) - compression * rest
    rng = np.random.default_rng(7)
    motion = np.zeros((2, 2, 3)) if still else rng.normal(size=(2, 2, 3))
    speed = 0.1 * rest / pair.period
    state = pair_state(
        law, BOX, radii, material, distance, NORMAL, velocity=motion[0] * speed, spin=motion[1] * speed / min(radii)
    )  # fmt: skip
    across = [unit(*reference.across(rng.normal(size=3), NORMAL)) for _ in range(2)]
    if is_jkr:
        limits = reference.JKR().constants(pair)
        w = part * limits["sliding"][1] * across[0] / sum(radii)
        xi = part * limits["rolling"][1] * across[1] / pair.R
        # a_i n_i - a_j n_j along w, n_i + n_j = xi
        n_i = unit(*(-NORMAL + w + xi * radii[1] / sum(radii)))
        n_j = unit(*(NORMAL - w + xi * radii[0] / sum(radii)))
        phi = part * limits["twisting"][1]
        names = ("NIX", "NIY", "NIZ", "NJX", "NJY", "NJZ", "PHI")
        set_fields(state, [getattr(jkr_fields, name) for name in names], [*n_i, *n_j, phi])
        own = {"n_i": n_i, "n_j": n_j, "phi": phi}
    else:
        limits = reference.DMT(0.5e-9, "spring").constants(pair, compression * rest)
        zeta = part * limits["sliding"][1] * across[0]
        roll = part * limits["rolling"][1] * across[1]
        phi = part * limits["twisting"][1]
        own = reference.DMT().start(pair, NORMAL)
        if law.friction == dmt_fields.SPRING:
            names = ("ZETA_X", "ZETA_Y", "ZETA_Z", "ROLL_X", "ROLL_Y", "ROLL_Z", "PHI")
            set_fields(state, [getattr(dmt_fields, name) for name in names], [*zeta, *roll / pair.R, phi])
            own = {"sliding": zeta, "rolling": roll, "twisting": phi}
    for _ in range(8):  # Newton's steps for the contact radius arrive
        forces(state, law, BOX)
    return state, pair, own, motion * np.array([speed, speed / min(radii)])[:, None, None]


def energies(state, law):
    return np.array(law.energies(state.contact, contact_start(law, 0)))


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("law, theirs", [*JKR.values(), *DMT.values()], ids=[*JKR, *DMT])
def test_forces_are_those_of_the_slow_reference(law, theirs, radii):
    for part, compression in ((0.0, 0.2), (0.4, 1.1), (0.9, 2.5)):
        state, pair, own, (v, w) = strained(law, radii, part, compression)
        if law == JKR["constant"][0]:
            # t0 for unequal spheres: of one of radius 2 R with the mass 2 m_red (the reference: with the density rho)
            density = 2 * pair.m_red / (4 / 3 * np.pi * (2 * pair.R) ** 3)
            theirs = reference.JKR("constant", 0.3 * np.sqrt(pair.rho / density))
        force, torque = forces(state, law, BOX)
        rest = pair.delta_0 if "JKR" in repr(law) else pair.delta_eq
        wanted, t_i, t_j, _ = theirs.force(pair, own, compression * rest, NORMAL, v[0] - v[1], *w)
        # 1e-16 of the positions is what rounding leaves of the overlap
        error = 1e-10 + 1e-14 * sum(radii) / rest
        np.testing.assert_allclose(force[0], wanted, rtol=0, atol=error * np.linalg.norm(wanted))
        scale = max(np.linalg.norm(t_i), np.linalg.norm(t_j), np.linalg.norm(wanted) * pair.delta_0)
        rounding = 1e-15 * pair.E_star * pair.r0 * max(radii) ** 2  # k_s a zeta, where zeta is 0
        np.testing.assert_allclose(torque, [t_i, t_j], rtol=0, atol=error * scale + rounding)
        held = theirs.potential(pair, own, compression * rest, NORMAL)
        wanted = [held[mode] for mode in reference.MODES]
        np.testing.assert_allclose(energies(state, law), wanted, rtol=10 * error, atol=1e-12 * abs(wanted[0]))


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("law", [law for law, _ in (*JKR.values(), *DMT.values())], ids=[*JKR, *DMT])
def test_both_momenta_are_conserved(law, radii):
    """Also while contacts slip: forces and torques are opposite, with levers that meet."""
    for part in (0.9, 3.0):
        state, pair, _, _ = strained(law, radii, part)
        force, torque = forces(state, law, BOX, dt_drift=1e-13, dt=1e-13)
        assert np.abs(force).max() > 0.01 * pair.F_C
        assert np.abs(force.sum(axis=0)).max() == 0.0
        d = state.monomer[:3] - state.monomer[16:19]
        lever = np.linalg.norm(d) * np.linalg.norm(force[0])
        assert np.abs(np.cross(d, force[0]) + torque.sum(axis=0)).max() < 1e-12 * lever


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("name", ["jkr", "dmt"])
def test_forces_are_derivatives_of_the_potential(name, radii):
    """Every direction and turn of either sphere, with springs at half of their limits.

    DMT: not along the normal, since its springs follow the contact radius without a force that pays for it; that
    direction without friction."""
    laws = {
        "jkr": [jkr(damping="none"), jkr(damping="none", normal_force="DMT")],
        "dmt": [dmt(viscous_time=0.0, friction=f) for f in ("spring", "none")],
    }
    for law in laws[name]:
        state, pair, _, _ = strained(law, radii, 0.5, still=True)
        force, torque = forces(state, law, BOX)
        rest = pair.delta_0
        directions = [NORMAL, unit(*np.cross(NORMAL, [0, 0, 1.0]))]
        directions.append(np.cross(*directions))
        step = {"shift": 1e-3 * rest, "turn": 1e-3 * rest / max(radii)}

        def change(kind, k, e, size, law=law, state=state, step=step):
            """Potential after a move of sphere k by size * step."""
            shift, turn = np.zeros((2, 3)), np.zeros((2, 3))
            (shift if kind == "shift" else turn)[k] = e
            there = moved(state, shift, turn, size * step[kind])
            forces(there, law, BOX, dt_drift=size * step[kind])
            return energies(there, law).sum()

        for k in range(2):
            for kind, exact in (("shift", force), ("turn", torque)):
                for axis, e in enumerate(directions):
                    if name == "dmt" and axis == 0 and kind == "shift" and law.friction == dmt_fields.SPRING:
                        continue
                    h = step[kind]
                    slopes = [(change(kind, k, e, s) - change(kind, k, e, -s)) / (2 * s * h) for s in (1, 2)]
                    slope = (4 * slopes[0] - slopes[1]) / 3
                    scale = pair.F_C if kind == "shift" else np.abs(torque).max() + pair.F_C * rest
                    assert slope == pytest.approx(-exact[k] @ e, abs=2e-5 * scale), (kind, k, axis)


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("law, theirs", [JKR["none"], DMT["spring"]], ids=["jkr", "dmt"])
def test_beyond_the_limits_displacements_are_cut_back_and_energy_is_lost(law, theirs, radii):
    """Limit times excess, and what is left is the limit; as the reference cuts it."""
    state, pair, own, _ = strained(law, radii, 0.9, still=True)
    fields = jkr_fields if theirs.__class__.__name__ == "JKR" else dmt_fields
    delta = 1.1 * (pair.delta_0 if fields is jkr_fields else pair.delta_eq)
    held = energies(state, law)
    # twice: 0.9 is 1.8 of the limit
    if fields is jkr_fields:
        state, pair, own, _ = strained_without_rounds(law, radii, 1.8)
    else:
        names = [getattr(fields, n) for n in ("ZETA_X", "ZETA_Y", "ZETA_Z", "ROLL_X", "ROLL_Y", "ROLL_Z", "PHI")]
        set_fields(state, names, 2.0 * field(state, *names))
        own = {mode: 2.0 * value for mode, value in own.items()}
    lost = theirs.advance(pair, own, delta, delta, NORMAL, NORMAL, np.zeros(3), np.zeros(3), np.zeros(3), 1.0)
    force, torque = forces(state, law, BOX)
    wanted, t_i, t_j, _ = theirs.force(pair, own, delta, NORMAL, np.zeros(3), np.zeros(3), np.zeros(3))
    # pointers, cut back, are made unit vectors again: of second order in the rolling angle
    error = 1e-6 + (4 * (pair.xi_c / pair.R) ** 2 if fields is jkr_fields else 0.0)
    np.testing.assert_allclose(force[0], wanted, rtol=0, atol=error * np.linalg.norm(wanted))
    np.testing.assert_allclose(torque, [t_i, t_j], rtol=0, atol=error * np.abs(torque).max())
    found = field(state, E_SLIDE, E_ROLL, E_TWIST)[0]
    modes = reference.MODES[1:]
    np.testing.assert_allclose(found, [lost[mode] for mode in modes], rtol=1e-5 + error)
    # limit x excess at 1.8 of the limit is 1.6 times the energy held at the limit
    np.testing.assert_allclose(found, 1.6 * held[1:] / 0.9**2, rtol=1e-3 + 4 * error)


def strained_without_rounds(law, radii, part):
    """As `strained`, beyond the limits: the forces have not been computed since, so nothing has slipped."""
    state, pair, own, motion = strained(law, radii, 0.0, still=True)
    _, _, own, _ = strained(law, radii, part, still=True)
    names = ("NIX", "NIY", "NIZ", "NJX", "NJY", "NJZ", "PHI")
    set_fields(state, [getattr(jkr_fields, n) for n in names], [*own["n_i"], *own["n_j"], own["phi"]])
    return state, pair, own, motion


def test_a_law_without_an_option_leaves_no_force():
    """Constant damping acts at the rate of approach; without friction nothing but the normal force is left."""
    state, pair, _, _ = strained(jkr(friction="none", damping="none"), (1e-7, 0.6e-7), 0.9)
    force, torque = forces(state, jkr(friction="none", damping="none"), BOX)
    assert np.linalg.norm(np.cross(force[0], NORMAL)) < 1e-12 * np.linalg.norm(force[0])
    assert (torque == 0.0).all()
    assert state.scalar[DT_DRIFT] == 0.0
