"""A squeezed cluster whose box is let go: does the work that contacts are said to store come back?

A cluster is squeezed in its periodic box to some filling factor. Then all velocities are taken away and the box grows
again, along all axes and as fast as it shrank, until nothing presses on it any more. What the cluster does to the box
meanwhile is the work that it had stored. What friction has taken does not come back.
"""

import numpy as np

from ratd.aggregates.clusters import grow_bcca
from ratd.experiments.compression.run import LONG_STEPS, compress, compression_law
from ratd.experiments.compression.static import box_rate
from ratd.experiments.compression.steps import integrators
from ratd.experiments.compression.strain import COLUMNS as RECORDED
from ratd.experiments.compression.strain import Parts, state_of, strain, strain_dataset
from ratd.experiments.relax import start_anew
from ratd.geometry.box import periodic
from ratd.validation.tables import table_kind

COLUMNS = {
    "material": ("", "material"),
    "seed": ("1", "seed of the cluster"),
    "n_monomers": ("1", "monomers"),
    "strain_rate": ("1", "C_v of the squeeze, and of the growth of the box"),
    "until_phi": ("1", "filling factor up to which it was squeezed"),
    "way": ("", "in: squeezed; out: the box grows"),
    "phi": ("1", "filling factor"),
    "pressure": ("Pa", "mean pressure since the record before"),
    "work": ("1", "work of the box over E_roll since it began to shrink, or to grow: below 0 where the cluster works"),
    "rolling": ("1", "energy in the springs of rolling over E_roll"),
    "twisting": ("1", "energy in the springs of twisting over E_roll"),
    "lost": ("1", "energy lost by rolling, twisting and sliding over E_roll, since the same time"),
    "n_contacts": ("1", "contacts"),
}
KIND = table_kind("spring_back", "A squeezed cluster whose box grows again", COLUMNS)
RECORD = 1e-3
"""ln L between two records while the box grows."""
LONGEST = 0.5
"""ln L at which the growth ends at the latest."""
GONE = 20
"""Records in a row in which the box gets no work back at which nothing is said to press any more: 6 % in phi."""


def compute(settings, progress=None):
    """Squeeze one cluster and let it go.

    Parameters
    ----------
    settings : dict
        material, n, seed, strain_rate, until_phi, timestep_factor (of explicit steps).
    progress : callable, optional
        Called with a sentence.

    Returns
    -------
    list of dict
        Rows of `COLUMNS`.
    """
    cluster = grow_bcca(settings["n"], settings["material"], settings["seed"])
    how = {"timestep_factor": settings["timestep_factor"], "snapshots": ()}
    squeezed = compress(cluster, settings["strain_rate"], settings["until_phi"], **how)
    if progress is not None:
        progress(f"squeezed to phi = {settings['until_phi']:g}")
    released = _released(squeezed, cluster.material, settings)
    names = ("material", "seed", "strain_rate", "until_phi")
    own = {name: settings[name] for name in names} | {"n_monomers": settings["n"]}
    unit = squeezed.attrs["rolling_pressure"] * squeezed.attrs["monomer_radius"] ** 3
    return [own | row for way, run in (("in", squeezed), ("out", released)) for row in _rows(way, run, unit)]


def _released(squeezed, material, settings):
    """Records of a box that grows from the end of a compression on."""
    attrs = squeezed.attrs
    integrator, explicit = integrators(
        material, attrs["monomer_radius"], attrs["time_unit"], settings["timestep_factor"], LONG_STEPS,
        settings["strain_rate"],
    )  # fmt: skip
    integrator = integrator if settings["until_phi"] < LONG_STEPS.until_phi else explicit
    law, rate = compression_law(), -box_rate(settings["strain_rate"], attrs["time_unit"])
    state = state_of(squeezed)
    start_anew(state, law, integrator)
    parts = Parts(law, periodic(squeezed["box_length"].values[-1], np.full(3, rate)), integrator)
    marks = np.arange(1, round(LONGEST / RECORD) + 1) * RECORD / rate
    at, _ = RECORDED["work"]
    state, table, _ = strain(state, parts, marks, stop=lambda rows: over(rows[:, at]))
    return strain_dataset(state, table, parts)


def over(work):
    """Whether a box that grows gets no work back any more: its work, (m,), has had its least `GONE` records ago."""
    return len(work) > GONE and np.argmin(work) < len(work) - GONE


def _rows(way, run, unit):
    """Rows without what all of them share."""
    lost = sum(run[f"dissipated_{mode}"] for mode in ("rolling", "twisting", "sliding"))
    return [
        {
            "way": way,
            "phi": run["phi"].item(k),
            "pressure": run["pressure"].item(k),
            "work": run["work"].item(k) / unit,
            "rolling": run["stored_rolling"].item(k) / unit,
            "twisting": run["stored_twisting"].item(k) / unit,
            "lost": lost.item(k) / unit,
            "n_contacts": run["n_contacts"].item(k),
        }
        for k in range(run.sizes["record"])
    ]
