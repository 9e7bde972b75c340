"""The literal drive: what the printed equations give, against the spin-up rate, the time step and the Coriolis term.

The printed equations leave an aggregate at rest in the inertial frame but for two things (docs/model/drives.md). The
printed equation of the spins has no Euler term, which acts like an outer torque I_spin d omega/dt, where I_spin is the
sum of the monomers' own moments of inertia. And an explicit Coriolis term, taken at the velocities half a step before,
turns the aggregate backwards. `ratd.experiments.spin_up.solid.solid_omega` says where a solid grain parts under both.
"""

import numpy as np

from ratd.aggregates.growth import grow
from ratd.experiments.spin_up.marks import disruption
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.same_grains import first_step
from ratd.experiments.spin_up.solid import solid_omega, turned_by_spins
from ratd.validation.tables import GRAIN_COLUMNS, grain_values, table_kind

MARKS = ("omega_disr", "omega_first_loss", "omega_mass_75")
COLUMNS = {
    "drive": ("", "prescribed or literal"),
    "coriolis": ("", "treatment of the Coriolis term"),
    "outcome": ("", "how the run ended"),
    **GRAIN_COLUMNS,
    "angular_acceleration": ("rad s-2", "d omega/dt at the start"),
    "timestep_factor": ("1", "f in the time step f min(t_dis, t_vel)"),
    "timestep": ("s", "first time step"),
    "spin_share": ("1", "I_spin/(I_orbit + I_spin) about the axis of rotation"),
    "cut_bound": ("rad s-1", "bound on omega of the grain as it stands"),
    "omega_end": ("rad s-1", "angular velocity at the end of the run"),
    **{name: ("rad s-1", f"mark {name} of ratd.experiments.spin_up.marks") for name in MARKS},
    "turned": ("rad s-1", "greatest angular velocity that its spins give the grain before it loses mass; exact only"),
    "stretched": ("1", "I_1 over that at rest when it turns so fast"),
}
table_kind("literal", "The literal drive", COLUMNS)
NOT_KNOWN = {"turned": np.nan, "stretched": np.nan}
EXPLICIT_END, EXACT_END = 1.25, 3.0
"""Runs go on to so many times the omega at which a solid grain parts."""


def compute(settings, progress=None):
    """Spin one grain up with the consistent drive once, then with the literal one in every way.

    Parameters
    ----------
    settings : dict
        material, type, a_eff [m], seed, part_of_limit (list: (d omega/dt / dt)^(1/3) over the omega at which the spins
        alone tear the grain), timestep_factor (list).
    progress : callable, optional
        Called with a sentence after each run.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`. With the exact Coriolis term only the two greatest parts and the longest step are run.
    """
    grain = grow(settings["type"], settings["a_eff"], settings["material"], settings["seed"])
    share = grain.shape.spin_share
    parts, factors = sorted(settings["part_of_limit"]), sorted(settings["timestep_factor"])
    reference = _row(grain, share, drive="prescribed")
    rows = [reference]
    runs = [(part, f, "explicit") for part in parts for f in factors]
    runs += [(part, factors[-1], "exact") for part in parts[-2:]]
    # A grain whose last two monomers hold three quarters of its mass never loses one quarter.
    threshold = reference["omega_mass_75"] if reference["omega_mass_75"] > 0.0 else reference["omega_first_loss"]
    limit = threshold / share
    for part, f, coriolis in runs:
        dt = first_step(grain, f)
        acceleration = (part * limit) ** 3 * dt
        end = EXACT_END * limit
        if coriolis == "explicit":
            end = EXPLICIT_END * max(
                solid_omega(own, share, acceleration, dt)[0]
                for own in (reference[mark] for mark in MARKS)
                if np.isfinite(own)
            )
        rows.append(
            _row(
                grain,
                share,
                drive="literal",
                coriolis=coriolis,
                angular_acceleration=acceleration,
                timestep_factor=f,
                max_steps=int(end / acceleration / dt),
            )
        )
        if progress is not None:
            progress(f"{coriolis} {acceleration:.2g} rad/s2, f = {f:g}: {rows[-1]['outcome']}")
    return rows


def _row(grain, share, **how):
    run = spin_up(grain, **how)
    marks = disruption(run)
    fastest = NOT_KNOWN
    if how["drive"] == "literal" and run.attrs["coriolis"] == "exact":
        fastest = _fastest(run, share, float(marks["omega_first_loss"]))
    return dict(
        drive=how["drive"],
        coriolis=run.attrs["coriolis"],
        outcome=run.attrs["end_reason"],
        **grain_values(grain),
        angular_acceleration=run.attrs["angular_acceleration"],
        timestep_factor=run.attrs["timestep_factor"],
        timestep=run.attrs["timestep"],
        spin_share=share,
        cut_bound=run.attrs["cut_bound"],
        omega_end=float(run["omega"][-1]),
        **{name: float(marks[name]) for name in MARKS},
        **fastest,
    )


def _fastest(run, share, first_loss):
    """Greatest `turned_by_spins` before the first loss of mass, and by how much I_1 has grown by then.

    NaN where the only record before the loss is that of the grain at rest.
    """
    whole = ~(run["omega"].values >= first_loss)  # all of a run without a loss
    omega, b, c = (run[name].values[whole] for name in ("omega", "axis_b", "axis_c"))
    turned = turned_by_spins(omega, share, b, c)
    k = np.argmax(turned)
    if not turned[k] > 0.0:
        return NOT_KNOWN
    return {"turned": float(turned[k]), "stretched": float(share * omega[k] / turned[k])}
