"""The list of contacts: one added, one removed, the constants of one, the step that they allow."""

import math

import numpy as np

from ratd.base.jit import jit
from ratd.engine.layout import (
    A_I, A_J, BLOCK, COMPRESSION, CONTACTS, DAMPING, DAMPING_RATE, DT, E_DAMP, E_ROLL, E_SLIDE, E_TWIST, INV_AREA,
    INV_DELTA0, INV_MASS, INV_SUM, INV_XI2, INV_ZETA2, K_ROLL, K_SLIDE, K_TWIST, LANES, LOST_CONTACT, LOST_DAMP,
    LOST_ROLL, LOST_SLIDE, LOST_TWIST, MASS, MONOMERS, NCX, NCY, NCZ, NIX, NIY, NIZ, NJX, NJY, NJZ, NORMAL, N_FIELDS,
    PHI, PULL_OFF, RADIUS, ROW, S, WX, WY, WZ, X, Y, Z,
)  # fmt: skip
from ratd.laws.jkr import S_TOUCH, contact_state, damping_coefficient, dissipation_time, normal_force, normal_potential
from ratd.laws.tangential import (
    rolling_stiffness,
    rotate_pointer,
    sliding_displacement,
    sliding_limit,
    sliding_stiffness,
    twisting_stiffness,
)
from ratd.base.materials import equilibrium_compression, equilibrium_contact_radius, pull_off_force, reduced_radius

SURFACE_ENERGY, REDUCED_MODULUS, SHEAR_MODULUS, POISSON, ROLLING_LIMIT, VISCOUS_TIME = range(6)
_ROW = np.uint64(ROW)


@jit
def contact_start(k):
    """Where the fields of contact k begin: add the field's offset."""
    return np.uint64((k // LANES) * BLOCK + k % LANES)


@jit
def clear_contacts(state, first, last):
    """Make the contacts first ... last-1 idle: whatever the arithmetic does with them adds nothing to anything."""
    idle = np.uint64(state.identity.shape[0])
    for k in range(first, last):
        at = contact_start(k)
        for field in range(N_FIELDS):
            state.contact[at + np.uint64(field * LANES)] = 0.0
        state.contact[at + NIX] = -1.0
        state.contact[at + NJX] = 1.0
        state.contact[at + NCX] = 1.0
        state.contact[at + S] = S_TOUCH
        state.contact[at + A_I] = 1.0
        state.contact[at + A_J] = 1.0
        state.pair_i[k] = idle
        state.pair_j[k] = idle + np.uint64(1)


@jit
def append_contact(state, i, j, drift_time, at_rest):
    """Add a contact between monomers i and j where they are.

    Parameters
    ----------
    state : State
        With room for one more contact.
    i, j : int
        Monomers.
    drift_time : float
        Duration [s] of the last move. The forces of the next step will turn the pointers by it; they are turned
        back by as much here, so that they then point exactly at the other monomer.
    at_rest : bool
        Whether the contact is part of the aggregate from the start: it then begins in the state that belongs to its
        compression, and its energy is not counted as dissipated. A new one jumps to the contact radius of first
        touch, which radiates the energy of the jump (counted as dissipated by contacts made and broken).
    """
    monomer = state.monomer
    contact = state.contact
    k = state.counter[CONTACTS]
    ri = np.uint64(i) * _ROW
    rj = np.uint64(j) * _ROW
    at = contact_start(k)
    dx = monomer[ri + X] - monomer[rj + X]
    dy = monomer[ri + Y] - monomer[rj + Y]
    dz = monomer[ri + Z] - monomer[rj + Z]
    distance = math.sqrt(dx * dx + dy * dy + dz * dz)
    nx = dx / distance
    ny = dy / distance
    nz = dz / distance
    a_i = monomer[ri + RADIUS]
    a_j = monomer[rj + RADIUS]
    material = state.material
    gamma = material[SURFACE_ENERGY]
    e_star = material[REDUCED_MODULUS]
    nu = material[POISSON]
    r = reduced_radius(a_i, a_j)
    r0 = equilibrium_contact_radius(r, gamma, e_star)
    delta0 = equilibrium_compression(r, gamma, e_star)
    f_c = pull_off_force(r, gamma)

    state.pair_i[k] = np.uint64(i)
    state.pair_j[k] = np.uint64(j)
    contact[at + A_I] = a_i
    contact[at + A_J] = a_j
    contact[at + INV_SUM] = 1.0 / (a_i + a_j)
    contact[at + INV_DELTA0] = 1.0 / delta0
    contact[at + PULL_OFF] = f_c
    contact[at + K_SLIDE] = sliding_stiffness(r0, material[SHEAR_MODULUS], nu)
    contact[at + INV_ZETA2] = 1.0 / sliding_limit(r0, nu) ** 2
    contact[at + K_ROLL] = rolling_stiffness(f_c, r)
    contact[at + INV_XI2] = (r / material[ROLLING_LIMIT]) ** 2
    contact[at + K_TWIST] = twisting_stiffness(r0, material[SHEAR_MODULUS])
    contact[at + DAMPING] = damping_coefficient(r0, e_star, nu, material[VISCOUS_TIME])
    contact[at + DAMPING_RATE] = 0.0
    contact[at + INV_AREA] = 1.0 / (math.pi * r0 * r0)
    contact[at + E_SLIDE] = 0.0
    contact[at + E_ROLL] = 0.0
    contact[at + E_TWIST] = 0.0
    contact[at + E_DAMP] = 0.0
    contact[at + NCX] = nx
    contact[at + NCY] = ny
    contact[at + NCZ] = nz

    compression = (a_i + a_j - distance) / delta0
    s = S_TOUCH
    if at_rest:
        for _ in range(40):
            s = contact_state(compression, s)
    else:
        state.scalar[LOST_CONTACT] -= normal_potential(S_TOUCH, f_c, delta0)
    contact[at + S] = s
    contact[at + COMPRESSION] = compression
    contact[at + NORMAL] = normal_force(s, f_c)

    h = -0.5 * drift_time
    wix = monomer[ri + WX]
    wiy = monomer[ri + WY]
    wiz = monomer[ri + WZ]
    wjx = monomer[rj + WX]
    wjy = monomer[rj + WY]
    wjz = monomer[rj + WZ]
    px, py, pz = rotate_pointer(-nx, -ny, -nz, h * wix, h * wiy, h * wiz)
    contact[at + NIX] = px
    contact[at + NIY] = py
    contact[at + NIZ] = pz
    px, py, pz = rotate_pointer(nx, ny, nz, h * wjx, h * wjy, h * wjz)
    contact[at + NJX] = px
    contact[at + NJY] = py
    contact[at + NJZ] = pz
    contact[at + PHI] = 2.0 * h * ((wix - wjx) * nx + (wiy - wjy) * ny + (wiz - wjz) * nz)
    state.counter[CONTACTS] = k + 1


@jit
def contact_energies(state, k):
    """Potential energies [J] of contact k: normal, sliding, rolling, twisting.

    Each is the potential whose derivative is the force or torque (docs/model.md):
    k_s zeta^2/2, k_r |n_i + n_j|^2/2, k_t phi^2/2.
    """
    contact = state.contact
    at = contact_start(k)
    normal = normal_potential(contact[at + S], contact[at + PULL_OFF], 1.0 / contact[at + INV_DELTA0])
    nix, niy, niz = contact[at + NIX], contact[at + NIY], contact[at + NIZ]
    njx, njy, njz = contact[at + NJX], contact[at + NJY], contact[at + NJZ]
    _, zx, zy, zz = sliding_displacement(
        contact[at + A_I], nix, niy, niz, contact[at + A_J], njx, njy, njz,
        contact[at + NCX], contact[at + NCY], contact[at + NCZ],
    )  # fmt: skip
    sliding = 0.5 * contact[at + K_SLIDE] * (zx * zx + zy * zy + zz * zz)
    rolling = 0.5 * contact[at + K_ROLL] * ((nix + njx) ** 2 + (niy + njy) ** 2 + (niz + njz) ** 2)
    twisting = 0.5 * contact[at + K_TWIST] * contact[at + PHI] ** 2
    return normal, sliding, rolling, twisting


@jit
def remove_contact(state, k):
    """Remove contact k; the last one takes its place.

    What it has dissipated goes to the totals, and so does what is still stored in it: the pieces keep none of it.
    """
    scalar = state.scalar
    contact = state.contact
    normal, sliding, rolling, twisting = contact_energies(state, k)
    scalar[LOST_CONTACT] += normal + sliding + rolling + twisting
    at = contact_start(k)
    scalar[LOST_SLIDE] += contact[at + E_SLIDE]
    scalar[LOST_ROLL] += contact[at + E_ROLL]
    scalar[LOST_TWIST] += contact[at + E_TWIST]
    scalar[LOST_DAMP] += contact[at + E_DAMP]
    last = state.counter[CONTACTS] - 1
    end = contact_start(last)
    for field in range(N_FIELDS):
        contact[at + np.uint64(field * LANES)] = contact[end + np.uint64(field * LANES)]
    state.pair_i[k] = state.pair_i[last]
    state.pair_j[k] = state.pair_j[last]
    clear_contacts(state, last, last + 1)
    state.counter[CONTACTS] = last


@jit
def contact_timestep(state, k):
    """t_dis [s] of contact k, Eq. 31 with the lighter mass of the pair."""
    at = contact_start(k)
    r = reduced_radius(state.contact[at + A_I], state.contact[at + A_J])
    r0 = equilibrium_contact_radius(r, state.material[SURFACE_ENERGY], state.material[REDUCED_MODULUS])
    light = min(state.monomer[state.pair_i[k] * _ROW + MASS], state.monomer[state.pair_j[k] * _ROW + MASS])
    return dissipation_time(light, r, r0, state.material[SURFACE_ENERGY])


@jit
def update_contact_rates(state, timestep_factor, implicit_damping):
    """Set the time step that the contacts allow and the rates of the implicit damping.

    Notes
    -----
    Step: f times the least t_dis of any contact, Eq. 31 with the lighter mass of the pair.

    Damping: a step of length dt with the coefficient c x is made with c x/(1 + dt x rate), where
    rate = C_i/m_i + C_j/m_j and C_i is the sum of c over the contacts of monomer i. For a single pair that is the
    backward Euler step exactly; for any aggregate the matrix of damping rates stays below 2/dt (Gershgorin), so
    that damping limits the step no longer. The force stays central and equal and opposite, hence conserves both
    momenta, and tends to the explicit one as dt^1. With `implicit_damping` off the rates are zero.
    """
    contact = state.contact
    monomer = state.monomer
    n_contacts = state.counter[CONTACTS]
    total = np.zeros(state.counter[MONOMERS])
    step = np.inf
    for k in range(n_contacts):
        at = contact_start(k)
        i = state.pair_i[k]
        j = state.pair_j[k]
        c = contact[at + DAMPING]
        total[i] += c
        total[j] += c
        step = min(step, contact_timestep(state, k))
    for k in range(n_contacts):
        i = state.pair_i[k]
        j = state.pair_j[k]
        rate = 0.0
        if implicit_damping:
            rate = total[i] * monomer[i * _ROW + INV_MASS] + total[j] * monomer[j * _ROW + INV_MASS]
        contact[contact_start(k) + DAMPING_RATE] = rate
    if n_contacts > 0:
        state.scalar[DT] = timestep_factor * step
