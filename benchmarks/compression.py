"""On request: the compression beside LAMMPS, in the same box that shrinks.

Clusters of ice are squeezed from where they just fit into their box. With explicit steps both codes do the same work,
and the time of a step and contact counts, everything included that a run does: in ratd its records and lists, in LAMMPS
the mean pressure. Then the time to `UNTIL`, with long steps, explicit ones and LAMMPS. Those of explicit steps and of
LAMMPS are projected: their number of steps is known, and each costs at least what it costs at the start.
"""

import math
import time

from benchmarks import tables
from ratd import compress, grow_bcca
from ratd.experiments.compression.run import Cluster
from ratd.experiments.compression.static import box_rate
from ratd.validation.lammps_box import WINDOW, BoxInLammps

FACTOR, LAMMPS_STEP = 0.14, 0.1
"""f of the explicit step of ratd, which is 0.2 t_0; step of LAMMPS over t_0, where the damping is explicit."""
STRAIN_RATE = 3e-7
"""C_v, that of the paper."""
UNTIL = 0.03


def measure(out, *, numbers, steps, about, say):
    """Measure and write ``compression.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    numbers : sequence of int
        Monomers of the clusters, powers of 2.
    steps : int
        Explicit steps of ratd; LAMMPS makes a twentieth.
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    rows = []
    for n in numbers:
        grow_bcca(n, "ice", 0)  # compiles
        begun = time.perf_counter()
        cluster = grow_bcca(n, "ice", 0)
        growth = time.perf_counter() - begun
        # compiles, and says where it begins
        start = compress(cluster, 1e-3, 0.03, long_steps=None, balance=False)
        first, unit = start.attrs["phi_start"], start.attrs["time_unit"]
        for code, (seconds, made, contacts, dt) in (
            ("ratd, explicit", _explicit(cluster, steps, first)),
            ("LAMMPS", _lammps(cluster, max(2 * WINDOW, steps // 20), first, unit)),
            ("ratd, long steps", _long(cluster)),
        ):
            ns = 1e9 * seconds / made / contacts
            if dt is not None:
                part, made = made, round(math.log(UNTIL / first) / (6.0 * STRAIN_RATE) * unit / dt)
                seconds *= made / part
            own = {"monomers": n, "code": code, "ns_per_contact_step": ns, "steps": made, "hours": seconds / 3600.0}
            rows.append(own | {"growth_seconds": growth, "strain_rate": STRAIN_RATE, "until_phi": UNTIL} | about)
            say(f"compression: {n} monomers, {code}: {seconds / 3600.0:.2f} h, {ns:.1f} ns per contact and step")
    tables.write(out / "compression.csv", rows)


def _explicit(cluster, steps, first):
    """Seconds, steps, contacts, and the step [s] of a part of the run."""
    until = first * math.exp(6.0 * STRAIN_RATE * 0.2 * steps)
    begun = time.perf_counter()
    run = compress(cluster, STRAIN_RATE, until, long_steps=None, timestep_factor=FACTOR)
    seconds = time.perf_counter() - begun
    return seconds, run.attrs["steps"], int(run["n_contacts"].values[-1]), run.attrs["timestep"]


def _lammps(cluster, steps, first, unit):
    """The same of LAMMPS."""
    dt = LAMMPS_STEP * unit
    length = (Cluster(cluster).volume / first) ** (1.0 / 3.0)
    # its own way of keeping lists of neighbours, which is the faster one
    with BoxInLammps(cluster, length, box_rate(STRAIN_RATE, unit), dt, None) as box:
        # the first part sets everything up
        box.advance(WINDOW)
        steps = round(steps / WINDOW) * WINDOW
        begun = time.perf_counter()
        box.advance(steps)
        seconds = time.perf_counter() - begun
        return seconds, steps, box.contacts(), dt


def _long(cluster):
    """Seconds, steps and contacts of the whole run."""
    begun = time.perf_counter()
    run = compress(cluster, STRAIN_RATE, UNTIL)
    seconds = time.perf_counter() - begun
    return seconds, int(run.attrs["steps"]), int(run["n_contacts"].values[-1]), None
