"""The literal drive: what the printed equations give, against the spin-up rate, the time step and the Coriolis term.

The printed equations leave an aggregate at rest in the inertial frame but for two things. An explicit Coriolis term
feeds in energy at a rate ~ omega^2 dt, so that the aggregate comes apart at omega ~ (d omega/dt / dt)^(1/3)
(docs/model.md). And the printed equation of the spins has no Euler term, which acts like an outer torque
I_spin d omega/dt: the aggregate turns with omega I_spin/(I_orbit + I_spin), where I_spin is the sum of the monomers'
own moments of inertia, and parts when that is the right threshold.
"""

import numpy as np

from ratd.growth import grow
from ratd.marks import disruption
from ratd.shape import inertia_tensor, principal_axes
from ratd.spinup import spin_up
from ratd.validation.tables import table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75")
COLUMNS = {
    "drive": ("", "prescribed or literal"),
    "coriolis": ("", "treatment of the Coriolis term"),
    "material": ("", "material"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "outcome": ("", "how the run ended"),
    "a_eff": ("m", "effective radius"),
    "seed": ("1", "seed of the grain"),
    "n_monomers": ("1", "monomers"),
    "angular_acceleration": ("rad s-2", "d omega/dt at the start"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "timestep": ("s", "first time step"),
    "spin_share": ("1", "I_spin/(I_orbit + I_spin) about the axis of rotation"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "omega_end": ("rad s-1", "angular velocity at the end of the run"),
    **{name: ("rad s-1", f"mark {name} of ratd.marks") for name in MARKS},
}
KIND = table_kind("literal", "The literal drive", COLUMNS)
REFERENCE_EPSILON = 0.02
LARGEST_OMEGA = 3.0
"""Runs go on to so many times the omega at which the spins alone should have torn the grain apart."""


def spin_share(grain):
    """I_spin/(I_orbit + I_spin) of a grain about its axis a_1: sum of 2/5 m_i a_i^2 over the moment of inertia I_1."""
    moments, _ = principal_axes(grain.position, grain.mass, grain.radius)
    own = inertia_tensor(np.zeros_like(grain.position), grain.mass, grain.radius)[0, 0]
    return float(own / moments[0])


def compute(settings, progress=None):
    """Spin one grain up with the consistent drive once, then with the literal one in every way.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, angular_acceleration (list) [rad/s2], timestep_factor (list).
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`. With the exact Coriolis term only the two fastest accelerations and the middle step are run.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    share = spin_share(grain)
    accelerations, factors = sorted(settings["angular_acceleration"]), settings["timestep_factor"]
    reference = _row(grain, share, drive="prescribed", epsilon=REFERENCE_EPSILON, timestep_factor=0.05)
    rows = [reference]
    runs = [(a, f, "explicit") for a in accelerations for f in factors]
    runs += [(a, sorted(factors)[len(factors) // 2], "exact") for a in accelerations[-2:]]
    # A grain whose last two monomers hold three quarters of its mass never loses one quarter.
    threshold = reference["omega_mass_75"] if reference["omega_mass_75"] > 0.0 else reference["omega_first_loss"]
    for acceleration, factor, coriolis in runs:
        limit = LARGEST_OMEGA * threshold / share
        dt = reference["timestep"] * factor / reference["timestep_factor"]
        rows.append(
            _row(
                grain,
                share,
                drive="literal",
                coriolis=coriolis,
                angular_acceleration=acceleration,
                timestep_factor=factor,
                max_steps=int(limit / acceleration / dt),
            )
        )
        if progress is not None:
            progress(f"{coriolis} {acceleration:g} {factor:g}: {rows[-1]['outcome']}")
    return rows


def _row(grain, share, **how):
    run = spin_up(grain, **how)
    marks = disruption(run)
    return dict(
        drive=how["drive"],
        coriolis=run.attrs["coriolis"],
        material=grain.material.name,
        type=grain.type,
        outcome=run.attrs["end_reason"],
        a_eff=grain.effective_radius,
        seed=grain.seed,
        n_monomers=grain.n_monomers,
        angular_acceleration=run.attrs["angular_acceleration"],
        timestep_factor=run.attrs["timestep_factor"],
        timestep=run.attrs["timestep"],
        spin_share=share,
        cut_bound=run.attrs["cut_bound"],
        omega_end=float(run["omega"][-1]),
        **{name: float(marks[name]) for name in MARKS},
    )
