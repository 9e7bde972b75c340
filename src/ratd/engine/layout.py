"""Where each number of a monomer and of a run stands; those of a contact: `ratd.laws.contact_fields`.

Monomers are rows of `ROW` numbers, four to a vector, so that gathering one touches two cache lines. The offsets are
unsigned: for a signed index numba emits a test for a negative one, which keeps the loop from being vectorised.
"""

import numpy as np

# --- monomers: rows of 16, forces: rows of 8 -------------------------------------------------------------------------
ROW = 16
(
    X, Y, Z, RADIUS,
    VX, VY, VZ, STILL,  # the last is 0: positions and radius move as one vector
    WX, WY, WZ, DRIVEN,  # DRIVEN: whether the drive acts on it
    INV_MASS, INV_INERTIA, MASS, INERTIA,
) = (np.uint64(k) for k in range(ROW))  # fmt: skip
FORCE_ROW = 8
FORCE_X, FORCE_Y, FORCE_Z, _, TORQUE_X, TORQUE_Y, TORQUE_Z, _ = (np.uint64(k) for k in range(FORCE_ROW))

# --- scalars of a run ------------------------------------------------------------------------------------------------
SCALARS = (
    "time "  # [s]
    "dt "  # of the step to come [s]
    "dt_drift "  # with which the positions were last moved [s]
    "lost_damp lost_slide lost_roll lost_twist "  # dissipated by contacts that are gone [J]
    "lost_made lost_broken "  # radiated where contacts jump in, and what broken ones still held [J]
    "fastest "  # no monomer is faster after the last step [m/s]; at most sqrt(3) times the greatest speed
    "dt_contacts "  # the step that the contacts allow [s]
    "stretch "  # greatest change of a compression in the last step, where the integrator looks at it [m]
    "virial_xx virial_yy virial_zz virial_xy virial_xz virial_yz"  # sum of d_a F_b over contacts, last step [J]
).split()
(
    TIME, DT, DT_DRIFT, LOST_DAMP, LOST_SLIDE, LOST_ROLL, LOST_TWIST, LOST_MADE, LOST_BROKEN, FASTEST,
    DT_CONTACTS, STRETCH, VIRIAL,
) = range(13)  # fmt: skip

DRIVE_SCALARS = 24
"""Numbers that a drive may keep; the first is its clock, in which `Until.clock` and the fragments lost are told."""
CLOCK = 0

COUNTERS = (
    "steps monomers contacts fragments_lost largest_monomers largest_contacts searches "
    "steady"  # steps since the length of the step changed, where the integrator chooses it
).split()
(
    STEPS, MONOMERS, CONTACTS, FRAGMENTS_LOST, LARGEST_MONOMERS, LARGEST_CONTACTS, SEARCHES, STEADY,
) = range(len(COUNTERS))  # fmt: skip
