"""On request: collisions of clusters of spheres from 50 nm to 2.5 um, beside LAMMPS.

Two MRN clusters meet. The time of a step and contact counts, everything included that a run does: records, the search
for contacts, contacts that form and break. LAMMPS has not the friction of this law, so both also go without it, from
the same places. Its spheres are sorted into classes of size, each with cells and a reach of its own.
"""

import time
from functools import partial

import numpy as np

from benchmarks import tables
from ratd import build_cluster, collide, mrn
from ratd.experiments.collision.approach import approach
from ratd.experiments.collision.run import GAP, at_rest
from ratd.geometry.neighbours import close_pairs
from ratd.laws import dmt
from ratd.validation.peer_lammps import Spheres, dmt_coefficients

VELOCITY, SEED = 30.0, 1
STEP, EQUAL_STEP = 2e-12, 20e-12
"""Steps [s] of MRN and of equal spheres, those of docs/collision.md."""
CLUSTER_RADIUS, NUMBER = 4e-6, 5000
EQUAL_RADIUS, EQUAL_NUMBER = 0.314e-6, 613
CLASSES = 4
"""Classes of size in LAMMPS; 1, 2, 6, 12 and 25 were slower."""
SHARE = 4
"""ratd makes so many steps for one of LAMMPS."""


def measure(out, *, number, steps, duration, about, say):
    """Measure and write ``collision.csv``.

    Parameters
    ----------
    out : pathlib.Path
        Folder of the results.
    number : int
        Spheres of an MRN cluster.
    steps : int
        Of ratd, from where the clusters are `GAP` apart.
    duration : float
        Of the collision of equal spheres [s].
    about : dict
        Columns that each row gets: the machine and the versions.
    say : callable
        Told how far it is.
    """
    radius = CLUSTER_RADIUS * (number / NUMBER) ** (1.0 / 3.0)
    # few spheres cannot have the moments of the law
    limits = {} if number >= NUMBER else {"mass_within": None, "length_within": None, "largest": 0.25 * radius}
    build = partial(build_cluster, radius=radius, second_contact=0.5, seed=SEED)
    build(mrn(number, SEED, **limits))  # compiles
    begun = time.perf_counter()
    cluster = build(mrn(number, SEED, **limits))
    rows = [{"what": f"building a cluster of {number} MRN spheres", "seconds": time.perf_counter() - begun}]
    for code, friction, run in (("ratd", "velocity", _ratd), ("ratd", "none", _ratd), ("LAMMPS", "none", _lammps)):
        law = dmt(viscous_time=0.5e-9, friction=friction)
        seconds, made, contacts = run(at_rest(cluster, law), law, steps)
        ns = 1e9 * seconds / made / contacts
        row = {"what": "MRN", "code": code, "friction": friction, "ns_per_contact_step": ns, "steps": made}
        rows.append(row | {"timestep": STEP, "seconds": seconds, "spheres": 2 * number, "contacts": contacts})
        say(f"collision: {2 * number} MRN spheres, {code}, friction {friction}: {ns:.1f} ns per contact and step")
    what = f"two clusters of equal spheres of {1e9 * EQUAL_RADIUS:g} nm, {1e6 * duration:g} us"
    rows.append({"what": what, "timestep": EQUAL_STEP, "seconds": _equal(duration)})
    say(f"collision: {what}: {rows[-1]['seconds']:.1f} s")
    about = {"velocity": VELOCITY} | about
    keys = dict.fromkeys(key for row in rows for key in row)
    tables.write(out / "collision.csv", [dict.fromkeys(keys, "") | row | about for row in rows])


def _ratd(cluster, law, steps):
    """Seconds, steps, and the mean number of contacts of the begin of a collision."""
    collide(cluster, cluster, VELOCITY, seed=SEED, law=law, duration=10 * STEP, timestep=STEP, relaxed=True)  # compiles
    begun = time.perf_counter()
    run = collide(
        cluster, cluster, VELOCITY, seed=SEED, law=law, duration=steps * STEP, timestep=STEP, relaxed=True, records=20
    )
    seconds = time.perf_counter() - begun
    return seconds, run.attrs["steps"], float(run["n_contacts"].mean())


def _lammps(cluster, law, steps):
    """The same of LAMMPS."""
    position, velocity, _ = approach(cluster, cluster, VELOCITY, 0.0, GAP, SEED)
    radius = np.tile(cluster.radius, 2)
    pair = partial(dmt_coefficients, damping_time=law.viscous_time)
    steps //= SHARE
    with Spheres(position, radius, cluster.material, STEP, pair, classes=CLASSES, search="multi") as spheres:
        spheres.push(velocity)
        spheres.advance(steps // 10)
        begun = time.perf_counter()
        spheres.advance(steps)
        seconds = time.perf_counter() - begun
        contacts = len(close_pairs(spheres.position(), radius, 0.0))
    return seconds, steps, contacts


def _equal(duration):
    """Seconds of a collision of two clusters of equal spheres."""
    cluster = build_cluster(np.full(EQUAL_NUMBER, EQUAL_RADIUS), CLUSTER_RADIUS, second_contact=0.5, seed=SEED)
    begun = time.perf_counter()
    collide(cluster, cluster, VELOCITY, seed=SEED, duration=duration, timestep=EQUAL_STEP)
    return time.perf_counter() - begun
