"""A cluster of equal monomers in a periodic box in LAMMPS, which shrinks or stays.

LAMMPS makes its lists of neighbours anew from time to time, and puts monomers that have left the box back into it on
the other side. A contact is then kept by another monomer, and what its springs hold is handed over with the opposite
sign (`transfer_history` in its source). That is right for sliding, which changes its sign with the order of the two.
Rolling, (spin_i - spin_j) x n, and twisting, (spin_i - spin_j) . n, do not: their springs are turned round, which
breaks the conservation of energy. `ratd.validation.box_at_rest` shows it. So here the lists are made once, of all pairs
that may meet, and are kept.
"""

import numpy as np

from ratd.geometry.box import periodic, touching_pairs
from ratd.validation.peer_lammps import load, pair_coefficients

__all__ = ["BoxInLammps"]

MARGIN = 20.0
"""Monomers are in one list if they come nearer by less than the box shrinks, and as many radii more."""
SKIN = 0.2
"""Skin of lists that are made anew, over the radius."""
WINDOW = 200
"""Steps over which LAMMPS averages the pressure; a run is a multiple of it."""

_COMMANDS = """
units si
atom_style sphere
atom_modify map array
boundary p p p
newton off
comm_modify vel yes cutoff {cutoff}
region world block {low} {high} {low} {high} {low} {high}
create_box 1 world
"""
_SETTINGS = """
pair_style granular
pair_coeff 1 1 {models}
neighbor {skin} bin
neigh_modify {lists}
timestep {timestep}
compute pressure all pressure thermo_temp
compute name all property/local patom1 patom2
compute vector all pair/local p10 p11 p12
fix move all nve/sphere
fix shrink all deform 1 x trate {rate} y trate {rate} z trate {rate} remap x
fix drag all viscous {drag}
fix mean all ave/time 1 {window} {window} c_pressure
thermo 2000000000
"""
_KEPT = "every 1000000000 delay 1000000000 check no one {one} page {page}"
_ANEW = "every 1 delay 0 check yes"


class BoxInLammps:
    """The box; use it in a `with` statement.

    Parameters
    ----------
    cluster : Grain
        At rest, of equal monomers.
    length : float
        Edge of the box [m].
    rate : float
        d ln L/dt [s-1].
    timestep : float
        [s]
    shortest : float or None
        Edge of the box at the end [m], up to which lists of neighbours are kept; None for lists that are made anew, see
        the module.
    margin : float, optional
        In place of `MARGIN`.
    twisting : bool, optional
        Whether contacts resist twisting.
    """

    def __init__(self, cluster, length, rate, timestep, shortest, *, margin=MARGIN, twisting=True):
        radius = float(cluster.radius[0])
        self._n, self._timestep, self._kept = cluster.n_monomers, timestep, shortest is not None
        words = pair_coefficients(radius, radius, cluster.material)
        if not twisting:
            words = {name: words[name] for name in words if not name.startswith("twisting")}
        models = " ".join(f"{name} " + " ".join(f"{value:.17g}" for value in words[name]) for name in words)
        skin = length - shortest + margin * radius if self._kept else SKIN * radius
        one = 4 * self._n + 2000
        self._lammps = load()(cmdargs=["-log", "none", "-screen", "none"])
        middle = 0.5 * (cluster.position.max(axis=0) + cluster.position.min(axis=0))
        self._say(_COMMANDS.format(low=-0.5 * length, high=0.5 * length, cutoff=skin + 2.5 * radius))
        numbers = np.arange(1, self._n + 1)
        place = cluster.position - middle
        place -= length * np.round(place / length)
        self._lammps.create_atoms(self._n, numbers.tolist(), [1] * self._n, np.ravel(place).tolist())
        for name, value in (("radius", radius), ("rmass", cluster.mass[0])):
            self._atoms(name)[:] = value
        lists = _KEPT.format(one=one, page=100 * one) if self._kept else _ANEW
        how = {"models": models, "skin": skin, "lists": lists, "timestep": timestep, "rate": rate, "window": WINDOW}
        # the drag -H u of the homogeneous equations, which LAMMPS lacks
        self._say(_SETTINGS.format(**how, drag=float(cluster.mass[0]) * rate))
        self._say("run 0 post no")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._lammps.close()

    def _say(self, text):
        self._lammps.commands_string(text)

    def _atoms(self, name):
        return self._lammps.numpy.extract_atom(name)[: self._n]

    def whole(self, time):
        """Steps of a time [s], a multiple of `WINDOW`."""
        return round(time / self._timestep / WINDOW) * WINDOW

    def advance(self, steps):
        """Make some steps, and tell the mean pressure in them [Pa], with that of the motion of the monomers."""
        means = []
        for _ in range(steps // WINDOW):
            # all runs are parts of one, so that the lists stay and the box goes on from where it began
            again = "pre no start 0 stop 2000000000" if self._kept else ""
            self._say(f"run {WINDOW} {again} post no")
            means.append(self._lammps.extract_fix("mean", 0, 0))
        return float(np.mean(means))

    def come_to_rest(self):
        """From now on the box stays; take all velocities and spins away. The springs keep what they hold."""
        self._say("unfix shrink")
        self._say("unfix drag")
        for name in ("v", "omega"):
            self._atoms(name)[:] = 0.0

    def kinetic(self):
        """Kinetic energy of the centres, relative to the box, and of the spins [J]."""
        mass, radius = self._atoms("rmass"), self._atoms("radius")
        moving, spinning = ((self._atoms(name) ** 2).sum(axis=1) for name in ("v", "omega"))
        return 0.5 * float(mass @ moving), 0.2 * float((mass * radius**2) @ spinning)

    def contacts(self):
        """Number of pairs in contact.

        Raises
        ------
        RuntimeError
            If two spheres overlap whose pair is in no list.
        """
        self._say(f"run 0 {'pre no' if self._kept else ''} post no")
        name, vector = (self._lammps.numpy.extract_compute(what, 2, 2) for what in ("name", "vector"))
        held = np.any(np.reshape(vector, (-1, 3)) != 0.0, axis=1)
        there = {tuple(sorted(pair)) for pair in np.reshape(name, (-1, 2))[held].astype(int).tolist()}
        low, high = self._lammps.extract_box()[:2]
        number = self._atoms("id")
        pairs = touching_pairs(self._atoms("x").copy(), self._atoms("radius").copy(), periodic(high[0] - low[0]))
        for pair in number[pairs[:, :2]].tolist():
            if tuple(sorted(pair)) not in there:
                raise RuntimeError("spheres overlap in LAMMPS and are in no list: the margin is too small")
        return int(held.sum())
