"""How a grain is turned: what a user asks for, made into a drive and an integrator."""

from typing import NamedTuple

import numpy as np

from ratd.base.errors import InputError
from ratd.drives import quasi_static as slow
from ratd.drives import rotating as fast
from ratd.engine.leapfrog import leapfrog
from ratd.engine.semi_implicit import SemiImplicit, semi_implicit

__all__ = [
    "DRAG", "DRIVES", "EPSILON", "FIRST_LOSS", "PACE", "QUASI_STATIC", "STEP", "STRETCH", "TIMESTEP_FACTOR", "UNREST",
    "How", "how_to_turn",
]  # fmt: skip

DRIVES = tuple(dict.fromkeys((*slow.DRIVES, *fast.DRIVES)))
"""What turns a grain: an omega that rises, an angular momentum that rises, or the equations as printed."""
QUASI_STATIC = "quasi-static"

STRETCH = 2e-14
"""Greatest stretch of a contact [m] in a step of a spin-up that goes on, the number of the accuracy: see
`ratd.validation.quasi_static`."""
PACE = 0.02
"""(d omega/dt)/omega^2 of a grain at rest."""
UNREST = 0.02
"""q_0: the spin-up waits while the motion of the grain exceeds this part of its rotation."""
DRAG = 1.0
"""c: motion in the turning frame decays at the rate c omega."""
STEP = {"longest": 4e-9, "displacement": 2e-10, "travel": 2e-9, "calming": 0.1}
"""What the semi-implicit step may do, see `ratd.engine.semi_implicit`."""

EPSILON = {"BA": 0.02, "BAM1": 0.005, "BAM2": 0.005}
"""Of the constant-epsilon law for `literal` where nothing is said; a grain of no known type takes the least."""
TIMESTEP_FACTOR = 0.125
FIRST_LOSS = 0.7
"""Part of the cut bound from which on epsilon is constant. BA grains mostly lose their first monomers above it, BAM
grains often below, where the spin-up is faster than epsilon (docs/model/drives.md, The law omega(t))."""


class How(NamedTuple):
    """How a grain is turned; made by `how_to_turn`.

    Attributes
    ----------
    motion, integrator : parts
    attributes : dict
        The same in words and numbers, for the file of the run.
    """

    motion: object
    integrator: object
    attributes: dict


def how_to_turn(
    kind, bound, *, drive="prescribed", stretch=None, pace=PACE, unrest=UNREST, drag=DRAG, epsilon=None,
    angular_acceleration=None, coriolis=None, timestep_factor=TIMESTEP_FACTOR, damping="implicit", integrator=None,
):  # fmt: skip
    """Drive and integrator from the words of a user, see `ratd.spin_up`.

    Parameters
    ----------
    kind : str or None
        Type of the grain.
    bound : float
        Its cut bound [rad/s].

    Returns
    -------
    How

    Raises
    ------
    InputError
    """
    if drive not in DRIVES:
        raise InputError(f"drive is {drive!r}; allowed are {', '.join(DRIVES)}.")
    if not (integrator is None or hasattr(integrator, "set_step")):
        raise InputError(f"integrator is {integrator!r}; it must be one of ratd.engine, or None.")
    explicit = leapfrog(timestep_factor=timestep_factor, damping=damping)
    paced = epsilon is not None or angular_acceleration is not None
    waits = drive != "literal" and not paced
    usual = {"stretch": None, "pace": PACE, "unrest": UNREST, "drag": DRAG}
    for name, value in {"stretch": stretch, "pace": pace, "unrest": unrest, "drag": drag}.items():
        if value != usual[name] and not waits:
            raise InputError(
                f"{name} is for a spin-up that waits until the grain is quiet; it is given beside "
                f"{'the drive literal' if drive == 'literal' else 'epsilon or angular_acceleration'}, which does not "
                "wait."
            )
    if drive == "torque" and paced:
        raise InputError(
            "drive is 'torque' and epsilon or angular_acceleration is given; the torque waits until the grain is "
            "quiet, and knows stretch only."
        )
    if isinstance(integrator, SemiImplicit) and (paced or drive == "literal"):
        raise InputError(
            "integrator is semi-implicit and the spin-up does not wait (drive literal, epsilon or "
            "angular_acceleration); that step is right only while the grain is quiet."
        )
    if stretch is not None and integrator is not None and not isinstance(integrator, SemiImplicit):
        raise InputError(
            "stretch is given beside an integrator that is not semi-implicit; short steps stretch no contact by so "
            "much, and nothing is held back by it: leave it out."
        )
    if coriolis is not None and waits:
        raise InputError(
            "coriolis is for a spin-up that does not wait (drive literal, epsilon or angular_acceleration); where it "
            "waits, next to nothing moves in the turning frame: leave it out."
        )
    omega_1 = FIRST_LOSS * bound
    numbers = dict.fromkeys(("stretch", "unrest", "pace", "drag", "epsilon", "displacement"), np.nan)
    words = {"drive": drive, "coriolis": "exact", "damping": damping, "timestep_factor": float(timestep_factor)}
    if not waits:
        if not paced:
            epsilon = EPSILON.get(kind, min(EPSILON.values()))
        motion = fast.rotating(
            drive, omega_1=omega_1, epsilon=epsilon, angular_acceleration=angular_acceleration, coriolis=coriolis
        )
        integrator = integrator or explicit
        words |= {
            "spin_up_law": fast.SPIN_UP_LAWS[motion.law],
            "coriolis": "explicit" if motion.explicit_coriolis else "exact",
            "angular_acceleration": motion.acceleration or motion.epsilon * motion.omega_1**2 / fast.SOFT_START,
        }
        numbers["epsilon"] = np.nan if epsilon is None else float(epsilon)
    else:
        motion = slow.quasi_static(
            drive, omega_1=omega_1, stretch=STRETCH if stretch is None else stretch, pace=pace, unrest=unrest, drag=drag
        )
        integrator = integrator or semi_implicit(**STEP)
        words |= {
            "spin_up_law": QUASI_STATIC,
            "coriolis": "explicit",
            "angular_acceleration": slow.rise(motion, 0.0),
        }
        numbers |= {name: getattr(motion, name) for name in ("stretch", "unrest", "pace", "drag")}
    words["integrator"] = "leapfrog"
    if isinstance(integrator, SemiImplicit):
        numbers["displacement"] = integrator.displacement
        words |= {"integrator": "semi-implicit", "damping": "implicit"}
    else:
        # which leapfrog does not tell the drive
        numbers["stretch"] = np.nan
    return How(motion, integrator, words | numbers)
