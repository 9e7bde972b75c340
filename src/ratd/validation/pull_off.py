"""Pull-off: the angular velocity at which a pair of monomers parts, against the exact answer and Eq. 35.

A damped pair parts where the centrifugal force is the pull-off force. An undamped pair from first touch keeps
vibrating, and parts where its vibration reaches the top of the barrier: see `ratd.validation.vibrating_pair`.
"""

import math
from dataclasses import replace

import numpy as np

from ratd.drives import make_drive
from ratd.engine.advance import FEW_CONTACTS, advance
from ratd.engine.layout import OMEGA
from ratd.engine.state import new_state
from ratd.materials import equilibrium_compression, get_material, reduced_radius
from ratd.validation.tables import table_kind
from ratd.validation.vibrating_pair import Pair, adiabatic_omega, vibrating_omega

COLUMNS = {
    "material": ("", "material"),
    "start": ("", "damped from equilibrium, or undamped from first touch"),
    "study": ("", "pairs: many pairs with one step; step: one pair with many steps"),
    "radius_1": ("m", "radius of the smaller monomer"),
    "radius_2": ("m", "radius of the larger monomer"),
    "epsilon": ("1", "(d omega/dt)/omega^2"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "omega": ("rad s-1", "angular velocity at which the pair parts"),
    "omega_force": ("rad s-1", "solution for a force that grows slowly"),
    "omega_eq35": ("rad s-1", "Eq. 35 of the paper, for unequal radii with 5/9 of the pull-off force"),
    "omega_adiabatic": ("rad s-1", "solution for an undamped pair from first touch whose omega grows slowly"),
    "omega_vibrating": ("rad s-1", "integration of the distance of an undamped pair from first touch, at this epsilon"),
}
KIND = table_kind("pull_off", "Pairs of monomers that part", COLUMNS)
SMALLEST, LARGEST = 10e-9, 100e-9
PIECES = 200
STEP_STUDY_RADIUS = 40e-9


def force_controlled_omega(a_1, a_2, material):
    """omega [rad/s] at which the centrifugal force on a pair is the pull-off force.

    m_red omega^2 (a_1 + a_2) = 3 pi gamma R (docs/model.md); for equal monomers sqrt(3 pi gamma/(2 m)).
    """
    return Pair.of(a_1, a_2, material).force_controlled_omega


def eq35_omega(a_1, a_2, material):
    """omega [rad/s] of Eq. 35, which takes the force at the end of the branch, 5/9 of the pull-off force."""
    return math.sqrt(5.0 / 9.0) * force_controlled_omega(a_1, a_2, material)


def parting_omega(a_1, a_2, material, *, epsilon, timestep_factor, damped=True):
    """omega [rad/s] at which a simulated pair parts.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material
    epsilon : float
        (d omega/dt)/omega^2; omega grows linearly up to half of `force_controlled_omega`.
    timestep_factor : float
        f of Eq. 31.
    damped : bool
        From equilibrium and with damping; or from first touch, delta = 0, without, so that the pair vibrates.

    Returns
    -------
    float
    """
    if not damped:
        material = replace(material, viscous_time=0.0)
    expected = force_controlled_omega(a_1, a_2, material)
    overlap = 0.0
    if damped:
        overlap = equilibrium_compression(reduced_radius(a_1, a_2), material.surface_energy, material.reduced_modulus)
    distance = a_1 + a_2 - overlap
    share = a_2**3 / (a_1**3 + a_2**3)
    position = np.array([[-share * distance, 0.0, 0.0], [(1.0 - share) * distance, 0.0, 0.0]])
    state = new_state(position, np.array([a_1, a_2]), material, np.array([[0, 1]]), timestep_factor=timestep_factor)
    motion = make_drive("prescribed", omega_1=0.5 * expected, epsilon=epsilon)
    # Piece by piece, as in a spin-up: each call puts the origin back into the centre of mass.
    for goal in np.arange(1, 3 * PIECES) * expected / PIECES:
        if advance(state, motion, goal, np.iinfo(np.int64).max, 0, timestep_factor, True) == FEW_CONTACTS:
            return float(state.scalar[OMEGA])
    return math.nan


def compute(settings, progress=None):
    """Equal pairs of random radius (Fig. 10 of the paper), pairs of given ratio, and one undamped pair at many steps.

    Parameters
    ----------
    settings : dict
        material, pairs (number of random radii), ratios (list), seed; ``damped`` and ``undamped`` {epsilon,
        timestep_factor}; ``undamped_steps`` (list), the f at which the undamped pair of equal monomers of
        `STEP_STUDY_RADIUS` is spun up.
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`; ``omega_vibrating`` is NaN but for the pair of the step study.
    """
    material = get_material(settings["material"])
    rng = np.random.Generator(np.random.PCG64(settings["seed"]))
    pairs = [(a, a) for a in rng.uniform(SMALLEST, LARGEST, settings["pairs"])]
    pairs += [(LARGEST / ratio, LARGEST) for ratio in settings["ratios"]]
    pairs += [(SMALLEST, SMALLEST * ratio) for ratio in settings["ratios"]]
    rows = []
    for start in ("damped", "undamped"):
        rows += [one_row(*pair, material, "pairs", start, **settings[start]) for pair in pairs]
        if progress is not None:
            progress(f"{start}: {len(pairs)} pairs")
    pair = (STEP_STUDY_RADIUS, STEP_STUDY_RADIUS)
    epsilon = settings["undamped"]["epsilon"]
    vibrating = vibrating_omega(*pair, material, epsilon)
    for f in settings["undamped_steps"]:
        row = one_row(*pair, material, "step", "undamped", epsilon=epsilon, timestep_factor=f)
        rows.append(row | {"omega_vibrating": vibrating})
    if progress is not None:
        progress(f"one pair at {len(settings['undamped_steps'])} steps")
    return rows


def one_row(a_1, a_2, material, study, start, *, epsilon, timestep_factor):
    """One pair spun up by the engine, and what it should give, as a row of `COLUMNS`."""
    how = dict(epsilon=epsilon, timestep_factor=timestep_factor)
    return dict(
        material=material.name,
        start=start,
        study=study,
        radius_1=a_1,
        radius_2=a_2,
        omega=parting_omega(a_1, a_2, material, damped=start == "damped", **how),
        omega_force=force_controlled_omega(a_1, a_2, material),
        omega_eq35=eq35_omega(a_1, a_2, material),
        omega_adiabatic=adiabatic_omega(a_1, a_2, material),
        omega_vibrating=math.nan,
        **how,
    )
