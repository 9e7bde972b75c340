"""Pull-off: the angular velocity at which a pair of monomers parts, against the exact answer and Eq. 35.

A damped pair parts where the centrifugal force is the pull-off force: *waiting*, under the spin-up that waits until the
grain is quiet, as `ratd.spin_up` makes it by default, and *damped*, under one that does not wait but is slow. An
*undamped* pair from first touch keeps vibrating, and parts where its vibration reaches the top of the barrier: see
`ratd.validation.vibrating_pair`.
"""

import math

import numpy as np

from ratd.aggregates.grain import Grain
from ratd.base.materials import get_material
from ratd.experiments.spin_up.pairs import eq35_omega, force_controlled_omega, parting_omega
from ratd.experiments.spin_up.run import spin_up
from ratd.laws.contact_constants import equilibrium_compression, reduced_radius
from ratd.validation.tables import table_kind
from ratd.validation.vibrating_pair import adiabatic_omega, vibrating_omega

COLUMNS = {
    "material": ("", "material"),
    "start": ("", "waiting or damped, both from equilibrium, or undamped from first touch"),
    "study": ("", "pairs: many pairs with one step; step: one pair with many steps"),
    "radius_1": ("m", "radius of the smaller monomer"),
    "radius_2": ("m", "radius of the larger monomer"),
    "epsilon": ("1", "(d omega/dt)/omega^2, NaN where the spin-up waits"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel), NaN where the spin-up waits"),
    "omega": ("rad s-1", "angular velocity at which the pair parts"),
    "omega_force": ("rad s-1", "solution for a force that grows slowly"),
    "omega_eq35": ("rad s-1", "Eq. 35 of the paper, for unequal radii with 5/9 of the pull-off force"),
    "omega_adiabatic": ("rad s-1", "solution for an undamped pair from first touch whose omega grows slowly"),
    "omega_vibrating": ("rad s-1", "integration of the distance of an undamped pair from first touch, at this epsilon"),
}
KIND = table_kind("pull_off", "Pairs of monomers that part", COLUMNS)
SMALLEST, LARGEST = 10e-9, 100e-9
STEP_STUDY_RADIUS = 40e-9


def compute(settings, progress=None):
    """Equal pairs of random radius (Fig. 10 of the paper), pairs of given ratio, and one undamped pair at many steps.

    Parameters
    ----------
    settings : dict
        material, pairs (number of random radii), ratios (list), seed. Nothing more for pairs under the spin-up that
        waits; for the others ``damped`` and ``undamped`` {epsilon, timestep_factor}, and ``undamped_steps`` (list), the
        f at which the undamped pair of equal monomers of `STEP_STUDY_RADIUS` is spun up.
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
    for start in ("damped", "undamped") if "damped" in settings else ("waiting",):
        rows += [one_row(*pair, material, "pairs", start, **settings.get(start, {})) for pair in pairs]
        if progress is not None:
            progress(f"{start}: {len(pairs)} pairs")
    if "undamped_steps" not in settings:
        return rows
    pair = (STEP_STUDY_RADIUS, STEP_STUDY_RADIUS)
    epsilon = settings["undamped"]["epsilon"]
    vibrating = vibrating_omega(*pair, material, epsilon)
    for f in settings["undamped_steps"]:
        row = one_row(*pair, material, "step", "undamped", epsilon=epsilon, timestep_factor=f)
        rows.append(row | {"omega_vibrating": vibrating})
    if progress is not None:
        progress(f"one pair at {len(settings['undamped_steps'])} steps")
    return rows


def waiting_omega(a_1, a_2, material):
    """omega [rad/s] at which a pair from equilibrium parts under `ratd.spin_up` with its defaults, NaN if it does not.

    Parameters
    ----------
    a_1, a_2 : float
        Radii [m].
    material : ratd.Material

    Returns
    -------
    float
    """
    overlap = equilibrium_compression(reduced_radius(a_1, a_2), material.surface_energy, material.reduced_modulus)
    run = spin_up(Grain(np.array([[0.0, 0.0, 0.0], [a_1 + a_2 - overlap, 0.0, 0.0]]), np.array([a_1, a_2]), material))
    return float(run["omega"][-1]) if run["n_contacts"][-1] == 0 else math.nan


def one_row(a_1, a_2, material, study, start, *, epsilon=math.nan, timestep_factor=math.nan):
    """One pair spun up by the engine, and what it should give, as a row of `COLUMNS`."""
    how = dict(epsilon=epsilon, timestep_factor=timestep_factor)
    if start == "waiting":
        omega = waiting_omega(a_1, a_2, material)
    else:
        omega = parting_omega(a_1, a_2, material, damped=start == "damped", **how)
    return dict(
        material=material.name,
        start=start,
        study=study,
        radius_1=a_1,
        radius_2=a_2,
        omega=omega,
        omega_force=force_controlled_omega(a_1, a_2, material),
        omega_eq35=eq35_omega(a_1, a_2, material),
        omega_adiabatic=adiabatic_omega(a_1, a_2, material),
        omega_vibrating=math.nan,
        **how,
    )
