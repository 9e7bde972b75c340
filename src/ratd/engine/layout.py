"""Where each number of the engine stands.

Contacts are kept in blocks of `LANES`: within a block each field is contiguous, so that the arithmetic runs on whole
vector registers, and a block (13 KiB) stays in the first-level cache while it is gathered, computed and summed.
Field f of contact k is `contact[block_start(k) + f + k % LANES]`.

Monomers are rows of `ROW` numbers, so that gathering one touches two cache lines. The offsets are unsigned: for a
signed index numba emits a test for a negative one, which keeps the loop from being vectorised.
"""

import numpy as np

from ratd.base.rows import EIGHT

LANES = 56
VECTOR = EIGHT
"""Contacts are padded to a multiple of this with contacts that do nothing."""

# --- contacts: fields kept from step to step -------------------------------------------------------------------------
CONTACT_FIELDS = (
    "NIX NIY NIZ "  # contact pointer in monomer i
    "NJX NJY NJZ "  # contact pointer in monomer j
    "NCX NCY NCZ "  # direction from j to i
    "PHI "  # twisting angle [rad]
    "S "  # sqrt(r/r0)
    "COMPRESSION "  # delta/delta_0
    "NORMAL "  # normal force without damping [N]
    "E_SLIDE E_ROLL E_TWIST E_DAMP "  # energy dissipated since the contact formed [J]
    # constants of the contact
    "A_I A_J INV_SUM INV_DELTA0 PULL_OFF K_SLIDE INV_ZETA2 K_ROLL INV_XI2 K_TWIST "
    "DAMPING DAMPING_RATE INV_AREA"
).split()
N_FIELDS = len(CONTACT_FIELDS)
BLOCK = N_FIELDS * LANES
(
    NIX, NIY, NIZ, NJX, NJY, NJZ, NCX, NCY, NCZ, PHI, S, COMPRESSION, NORMAL, E_SLIDE, E_ROLL, E_TWIST, E_DAMP,
    A_I, A_J, INV_SUM, INV_DELTA0, PULL_OFF, K_SLIDE, INV_ZETA2, K_ROLL, INV_XI2, K_TWIST,
    DAMPING, DAMPING_RATE, INV_AREA,
) = (np.uint64(k * LANES) for k in range(N_FIELDS))  # fmt: skip

# --- contacts: what one block needs only during its step -------------------------------------------------------------
N_SCRATCH = 21
(
    DX, DY, DZ, DVX, DVY, DVZ, WIX, WIY, WIZ, WJX, WJY, WJZ,
    FX, FY, FZ, TIX, TIY, TIZ, TJX, TJY, TJZ,
) = (np.uint64(k * LANES) for k in range(N_SCRATCH))  # fmt: skip

# --- monomers: rows of 16, forces: rows of 8 -------------------------------------------------------------------------
ROW = 16
X, Y, Z, RADIUS, VX, VY, VZ, INV_MASS, WX, WY, WZ, INV_INERTIA, MASS, INERTIA, DRIVEN, SPARE = (
    np.uint64(k) for k in range(ROW)
)
FORCE_ROW = 8
FORCE_X, FORCE_Y, FORCE_Z, _, TORQUE_X, TORQUE_Y, TORQUE_Z, _ = (np.uint64(k) for k in range(FORCE_ROW))

# --- scalars of a run ------------------------------------------------------------------------------------------------
SCALARS = (
    "time omega "  # [s], [rad/s]
    "dt "  # of the step to come [s]
    "dt_drift "  # with which the positions were last moved [s]
    "unwind excess "  # to turn the largest fragment back by, and by how much it turned after the last step [rad/s]
    "torque_work "  # [J]
    "lost_slide lost_roll lost_twist lost_damp lost_contact "  # dissipated by contacts that are gone [J]
    "stress_sum stress_samples "  # of the recording interval
).split()
(
    TIME, OMEGA, DT, DT_DRIFT, UNWIND, EXCESS, TORQUE_WORK,
    LOST_SLIDE, LOST_ROLL, LOST_TWIST, LOST_DAMP, LOST_CONTACT, STRESS_SUM, STRESS_SAMPLES,
) = range(len(SCALARS))  # fmt: skip

COUNTERS = "steps monomers contacts fragments_lost largest_monomers largest_contacts searches".split()
STEPS, MONOMERS, CONTACTS, FRAGMENTS_LOST, LARGEST_MONOMERS, LARGEST_CONTACTS, SEARCHES = range(len(COUNTERS))
