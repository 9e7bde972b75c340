"""From the long steps of the semi-implicit integrator to those of the explicit one, within a run."""

from ratd.engine.contacts import update_contact_rates
from ratd.engine.layout import DT, STEPS
from ratd.engine.step import run, until

BETWEEN = 8
"""Short semi-implicit steps between the long ones and the explicit ones."""


def hand_over(state, law, drive, box, integrator, explicit):
    """Bring a state from this integrator to the explicit one.

    The velocities stand half a step behind the positions, and a long step cannot be followed by a short one of the
    explicit integrator, which would put in the forces of half the long one.

    Parameters
    ----------
    state : State
    law, drive, box : parts
    integrator : SemiImplicit
    explicit : Leapfrog

    Returns
    -------
    State
    """
    update_contact_rates(state, law, explicit)
    short = integrator._replace(longest=state.scalar[DT])
    state, _ = run(state, law, drive, box, short, until(steps=state.counter[STEPS] + BETWEEN))
    update_contact_rates(state, law, explicit)
    return state
