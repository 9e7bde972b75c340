"""Where each number of a contact stands.

Contacts are kept in blocks of `LANES`: within a block each field is contiguous, so that the arithmetic runs on whole
vector registers, and a block (some 12 KiB) stays in the first-level cache while it is gathered, computed and summed.
Field f of the contact whose fields begin at ``at`` is ``contact[at + f]``. The first `COMMON` fields are those of
every law, the others belong to the law, which takes them from `law_fields`. The offsets are unsigned: for a signed
index numba emits a test for a negative one, which keeps the loop from being vectorised.
"""

import numpy as np

LANES = 48
VECTOR = 8
"""Contacts are padded to a multiple of this with contacts that do nothing."""


def _offsets(first, count):
    return tuple(np.uint64(k * LANES) for k in range(first, first + count))


# --- contacts: fields of every law ---------------------------------------------------------------------------------
COMMON = 12
RARE = 4
"""The first so many fields are not needed in every step; the others are called from memory ahead of their block."""
(
    STEP,  # shortest time of the contact [s], which limits the time step
    E_SLIDE, E_ROLL, E_TWIST, E_DAMP,  # energy dissipated since the contact formed [J]
    NCX, NCY, NCZ,  # direction from j to i
    NORMAL,  # normal force without damping [N], > 0 pushing
    A_I, A_J,  # radii [m]
    DAMPING_RATE,  # of the implicit damping [1/s], 0 where it is explicit
) = _offsets(0, COMMON)  # fmt: skip


def law_fields(count):
    """Offsets of so many fields of a law's own."""
    return _offsets(COMMON, count)


# --- contacts: what one block needs only during its step -------------------------------------------------------------
N_SCRATCH = 30
(
    DX, DY, DZ, DVX, DVY, DVZ,  # position and velocity of i from j
    WIX, WIY, WIZ, WJX, WJY, WJZ,  # spins
    FX, FY, FZ, TIX, TIY, TIZ, TJX, TJY, TJZ,  # force on i, torques on i and j
    SX, SY, SZ,  # for the law
    VXX, VYY, VZZ, VXY, VXZ, VYZ,  # virial, summed over blocks lane by lane
) = _offsets(0, N_SCRATCH)  # fmt: skip
SCRATCH_SIZE = N_SCRATCH * LANES
