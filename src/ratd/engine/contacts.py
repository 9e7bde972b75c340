"""The list of contacts: one added, one removed, the step that they allow."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.layout import (
    CONTACTS, INV_MASS, LOST_BROKEN, LOST_DAMP, LOST_MADE, MASS, MONOMERS, RADIUS, ROW, WX, WY, WZ, X, Y, Z,
)  # fmt: skip
from ratd.laws.contact_fields import (
    A_I, A_J, DAMPING_RATE, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, LANES, NCX, NCY, NCZ, STEP,
)  # fmt: skip
from ratd.laws.material_pair import material_pair

_ROW = np.uint64(ROW)


@jit
def contact_start(law, k):
    """Where the fields of contact k begin: add the field's offset."""
    return np.uint64((k // LANES) * law.n_fields() * LANES + k % LANES)


@jit
def image_start(k):
    """Where the three numbers of the image of contact k begin, `LANES` apart."""
    return np.uint64((k // LANES) * 3 * LANES + k % LANES)


@jit
def get_image(state, k):
    """The image of contact k: so many edges of the box are added to X_i - X_j, (3,); zeros where there is no box."""
    if state.image.shape[0] == 0:
        return 0, 0, 0
    at = image_start(k)
    return (
        np.int64(state.image[at]),
        np.int64(state.image[at + np.uint64(LANES)]),
        np.int64(state.image[at + np.uint64(2 * LANES)]),
    )


@jit
def set_image(state, k, image):
    """Set the image of contact k; nothing where there is no box."""
    if state.image.shape[0] > 0:
        at = image_start(k)
        for axis in range(3):
            state.image[at + np.uint64(axis * LANES)] = image[axis]


@jit
def clear_contacts(state, law, first, last):
    """Make the contacts first ... last-1 idle: whatever the arithmetic does with them adds nothing to anything."""
    idle = np.uint64(state.identity.shape[0])
    for k in range(first, last):
        at = contact_start(law, k)
        for field in range(law.n_fields()):
            state.contact[at + np.uint64(field * LANES)] = 0.0
        state.contact[at + NCX] = 1.0
        state.contact[at + A_I] = 1.0
        state.contact[at + A_J] = 1.0
        law.idle(state.contact, at)
        state.pair_i[k] = idle
        state.pair_j[k] = idle + np.uint64(1)
        set_image(state, k, (0, 0, 0))


@jit
def difference(state, edges, i, j, image):
    """X_i - X_j [m] with the image in a box of these edges added, and its length: (x, y, z, distance)."""
    ri = np.uint64(i) * _ROW
    rj = np.uint64(j) * _ROW
    dx = state.monomer[ri + X] - state.monomer[rj + X] + image[0] * edges[0]
    dy = state.monomer[ri + Y] - state.monomer[rj + Y] + image[1] * edges[1]
    dz = state.monomer[ri + Z] - state.monomer[rj + Z] + image[2] * edges[2]
    return dx, dy, dz, math.sqrt(dx * dx + dy * dy + dz * dz)


@jit
def gap(state, edges, i, j, image):
    """Distance between two surfaces [m], negative when they overlap."""
    distance = difference(state, edges, i, j, image)[3]
    return distance - state.monomer[np.uint64(i) * _ROW + RADIUS] - state.monomer[np.uint64(j) * _ROW + RADIUS]


@jit
def append_contact(state, law, box, i, j, image, back, at_rest):
    """Add a contact between monomers i and j where they are.

    Parameters
    ----------
    state : State
        With room for one more contact.
    law, box : parts
    i, j : int
        Monomers.
    image : tuple of int
        See `get_image`.
    back : float
        Duration [s] of the last move: the forces of the next step will advance by it what turns with the spins.
    at_rest : bool
        Whether the contact is part of the aggregate from the start: it then begins in the state that belongs to its
        overlap, and what it would radiate by forming is not counted.
    """
    monomer = state.monomer
    contact = state.contact
    k = state.counter[CONTACTS]
    ri = np.uint64(i) * _ROW
    rj = np.uint64(j) * _ROW
    at = contact_start(law, k)
    dx, dy, dz, distance = difference(state, box.edges(state.scalar), i, j, image)
    normal = (dx / distance, dy / distance, dz / distance)
    for field in range(law.n_fields()):
        contact[at + np.uint64(field * LANES)] = 0.0
    contact[at + NCX] = normal[0]
    contact[at + NCY] = normal[1]
    contact[at + NCZ] = normal[2]
    contact[at + A_I] = monomer[ri + RADIUS]
    contact[at + A_J] = monomer[rj + RADIUS]
    pair = material_pair(state.material[state.kind[i]], state.material[state.kind[j]])
    radiated = law.begin(
        contact, at, pair, monomer[ri + MASS], monomer[rj + MASS], normal, distance,
        (monomer[ri + WX], monomer[ri + WY], monomer[ri + WZ]), (monomer[rj + WX], monomer[rj + WY], monomer[rj + WZ]),
        back, at_rest,
    )  # fmt: skip
    if not at_rest:
        state.scalar[LOST_MADE] += radiated
    state.pair_i[k] = np.uint64(i)
    state.pair_j[k] = np.uint64(j)
    set_image(state, k, image)
    state.counter[CONTACTS] = k + 1


@jit
def remove_contact(state, law, k):
    """Remove contact k; the last one takes its place.

    What it has dissipated goes to the totals, and so does what is still stored in it: the pieces keep none of it.
    """
    scalar = state.scalar
    contact = state.contact
    at = contact_start(law, k)
    normal, sliding, rolling, twisting = law.energies(contact, at)
    scalar[LOST_BROKEN] += normal + sliding + rolling + twisting
    for mode, field in enumerate((E_DAMP, E_SLIDE, E_ROLL, E_TWIST)):
        scalar[LOST_DAMP + mode] += contact[at + field]
    last = state.counter[CONTACTS] - 1
    end = contact_start(law, last)
    for field in range(law.n_fields()):
        contact[at + np.uint64(field * LANES)] = contact[end + np.uint64(field * LANES)]
    state.pair_i[k] = state.pair_i[last]
    state.pair_j[k] = state.pair_j[last]
    set_image(state, k, get_image(state, last))
    clear_contacts(state, law, last, last + 1)
    state.counter[CONTACTS] = last


@jit
def update_contact_rates(state, law, integrator):
    """Set the time step that the contacts allow and the rates of the implicit damping.

    Notes
    -----
    Step: f times the shortest time of any contact (the law's `STEP`; for JKR Eq. 31 with the lighter mass), or what the
    integrator prescribes.

    Damping: a step of length dt with the coefficient c is made with c/(1 + dt rate), where
    rate = C_i/m_i + C_j/m_j and C_i is the sum of c over the contacts of monomer i. For a single pair that is the
    backward Euler step exactly; for any aggregate the matrix of damping rates stays below 2/dt (Gershgorin), so
    that damping limits the step no longer. The force stays central and equal and opposite, hence conserves both
    momenta, and tends to the explicit one as dt^1; at a given step it damps a monomer with many contacts too little.
    Where the damping is explicit the rates are zero.
    """
    contact = state.contact
    monomer = state.monomer
    n_contacts = state.counter[CONTACTS]
    total = np.zeros(state.counter[MONOMERS])
    step = np.inf
    implicit = integrator.implicit_damping
    for k in range(n_contacts):
        at = contact_start(law, k)
        step = min(step, contact[at + STEP])
        if implicit:
            c = law.damping_coefficient(contact, at)
            total[state.pair_i[k]] += c
            total[state.pair_j[k]] += c
    for k in range(n_contacts):
        i = state.pair_i[k]
        j = state.pair_j[k]
        rate = 0.0
        if implicit:
            rate = total[i] * monomer[i * _ROW + INV_MASS] + total[j] * monomer[j * _ROW + INV_MASS]
        contact[contact_start(law, k) + DAMPING_RATE] = rate
    integrator.set_step(state, step)
