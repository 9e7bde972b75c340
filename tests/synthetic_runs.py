"""Made-up spin-up runs and tables of grains with known answers, in the form that ratd gives them."""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.materials import get_material
from ratd.experiments.spin_up.eq33 import eq33
from ratd.experiments.spin_up.marks import disruption

CONTACTS = {"BA": lambda n: n - 1, "BAM1": lambda n: 2 * n - 3, "BAM2": lambda n: 3 * n - 6}
POROSITY = {"BA": 0.75, "BAM1": 0.62, "BAM2": 0.48}
NO_CHECKS = "no checks"
"""Name of a folder that is not there, for data without the tables of the validation."""


def record_omegas(omega_1, end, records=300):
    """Angular velocities of the records of a run: evenly spaced to 2 omega_1, then twice as wide with each octave."""
    omega, spacing, octave = [], omega_1 / records, 2 * omega_1
    last = 0.0
    while last < end:
        if last >= octave * (1 - 1e-9):
            spacing, octave = 2 * spacing, 2 * octave
        last += spacing
        omega.append(last)
    return np.array(omega)


def make_run(
    break_at=1e8,
    *,
    omega_1=1.2e8,
    decay=2.0,
    gain=0.05,
    steps=None,
    noise=0.0,
    period=7,
    end=None,
    n_monomers=600,
    seed=0,
    contacts=None,
    **attrs,
):
    """Run of a grain whose stress rises as omega squared up to `break_at` and that then comes apart.

    Parameters
    ----------
    break_at : float
        omega [rad s-1] of the peak of the stress.
    omega_1 : float
        Cut bound [rad s-1], which sets the spacing of the records.
    decay : float
        After the break the largest fragment holds (break_at/omega)^decay of the mass.
    gain : float
        Fraction by which the contacts rise before the break.
    steps : list of (omega, fraction), optional
        Mass fraction from each omega on, instead of the decay.
    noise, period : float
        Relative amplitude and period (in records) of the vibration of the stress.
    end : float, optional
        Last omega; default: where one contact is left.
    """
    n_contacts_0 = contacts or 3 * n_monomers - 6
    last = break_at * n_contacts_0 ** (1 / decay) * 1.05 if end is None else end
    omega = record_omegas(omega_1, last)
    if steps is None:
        fraction = np.minimum(1.0, (break_at / omega) ** decay)
    else:
        fraction = np.ones_like(omega)
        for omega_step, value in steps:
            fraction[omega >= omega_step] = value
    bump = 1 + gain * np.exp(-(((omega - 0.7 * break_at) / (0.15 * break_at)) ** 2))
    n_contacts = np.floor(n_contacts_0 * np.where(fraction < 1, fraction**1.2, bump)).astype(int)
    if end is None:
        n_contacts = np.maximum(n_contacts, 1)
        stop = int(np.argmax(n_contacts <= 1)) + 1 if (n_contacts <= 1).any() else len(omega)
    else:
        stop = len(omega)
    k = np.arange(len(omega))
    # Only the fragment's own contacts bear load, and after the break they bear less than at it.
    load = np.where(fraction < 1, fraction**1.5 * (omega / break_at) ** (0.5 * decay), (omega / break_at) ** 2)
    stress = 1.5e12 * load * (1 + noise * np.sin(2 * np.pi * k / period + seed))
    mass = 4.76e-16 * fraction
    axis = 700e-9 * np.array([0.8, 1.0, 1.2])
    run = xr.Dataset(
        {
            "omega": ("record", omega),
            "time": ("record", omega / 1e14),
            "mass": ("record", mass),
            "n_monomers": ("record", np.maximum(1, np.round(n_monomers * fraction)).astype(np.int32)),
            "n_contacts": ("record", n_contacts.astype(np.int32)),
            "total_stress": ("record", stress),
            "axis_a": ("record", axis[0] * (1 - 0.2 * np.minimum(1, omega / break_at))),
            "axis_b": ("record", np.full(len(omega), axis[1])),
            "axis_c": ("record", np.full(len(omega), axis[2])),
            "porosity": ("record", 0.5 + 0.1 * np.minimum(1, omega / break_at)),
            "n_fragments_lost": ("record", np.round(50 * (1 - fraction)).astype(np.int32)),
        }
    ).isel(record=slice(0, stop))
    run.attrs = {
        "steps": 1000,
        "timestep": 1e-12,
        "end_reason": "one contact left" if end is None else "max_steps reached",
        "drive": "prescribed",
        "material": "q-S",
        "type": "BAM2",
        "a_eff": 350e-9,
        "seed": seed,
        "cut_bound": omega_1,
        "initial_n_monomers": n_monomers,
        "initial_n_contacts": n_contacts_0,
        "initial_mass": 4.76e-16,
        "initial_axis_a": axis[0],
        "initial_axis_b": axis[1],
        "initial_axis_c": axis[2],
        "initial_porosity": 0.5,
        **attrs,
    }
    return run


def run_with_snapshots():
    """A chain of three monomers that stretches and loses an end; the other is dropped by the last of five snapshots."""
    run = make_run(1e8, n_monomers=3, contacts=2, end=2e8)
    omega = np.array([0.1, 0.5, 0.8, 1.0, 1.5]) * 1e8
    place = np.array([-40e-9, 0, 40e-9]) * np.linspace(1, 1.4, 5)[:, None]
    shape = ("snapshot", "monomer")
    fragment = np.zeros((5, 3), int)
    fragment[3:, 2], fragment[4, 0] = 1, -1
    return run.assign(
        snapshot_omega=("snapshot", omega), snapshot_x=(shape, place), snapshot_y=(shape, 0 * place),
        snapshot_z=(shape, 0 * place), snapshot_fragment=(shape, fragment),
        snapshot_normal_force=(shape, np.full((5, 3), -1e-9)), monomer_radius=("monomer", [20e-9] * 3),
    )  # fmt: skip


def make_table(
    materials=("a-C", "q-S", "co-S"),
    types=("BA", "BAM1", "BAM2"),
    sizes=tuple(50e-9 * k for k in range(1, 12)),
    seeds=10,
    *,
    A=0.4,
    alpha=0.12,
    scatter=0.1,
    drive="prescribed",
):
    """Table of grains that follow Eq. 33 for their own mean radius, with lognormal scatter."""
    rng = np.random.default_rng(1)
    rows = []
    for material_name in materials:
        material = get_material(material_name)
        for kind in types:
            for a_eff in sizes:
                for seed in range(seeds):
                    n = max(4, round((a_eff / 40.9e-9) ** 3 * rng.lognormal(0, 0.15)))
                    n_contacts = CONTACTS[kind](n)
                    porosity = 1 - (1 - POROSITY[kind]) * rng.lognormal(0.3 * np.exp(-a_eff / 150e-9), 0.05)
                    radius = 30e-9 * rng.lognormal(0, 0.08)
                    args = (a_eff, material.surface_energy, material.density, radius, n_contacts, 1 - porosity)
                    omega = eq33(*args, A, alpha) * rng.lognormal(0, scatter)
                    start = a_eff * (1 - porosity) ** (-1 / 3) * np.sort(rng.lognormal(0, 0.18, 3))
                    flat = rng.lognormal({"BA": -0.2, "BAM1": -0.6, "BAM2": -0.7}[kind], 0.3)
                    end = np.sort(start * np.array([min(1, flat), 1.1, 1.15]) * rng.lognormal(0, 0.05, 3))
                    rows.append(
                        {
                            "material": material_name,
                            "type": kind,
                            "a_eff": a_eff,
                            "seed": seed,
                            "n_monomers": n,
                            "n_contacts": n_contacts,
                            "porosity": porosity,
                            "filling_factor": 1 - porosity,
                            "mean_monomer_radius": radius,
                            "fractal_dimension": 2.2 + 0.5 * (1 - porosity) + rng.normal(0, 0.1) if n > 8 else np.nan,
                            "fractal_dimension_error": 0.05,
                            "enclosing_radius": 1.5 * start[2],
                            "cut_bound": 0.5 * omega * rng.lognormal(0, 0.1),
                            "omega_disr": omega,
                            "omega_mass_75": 0.95 * omega,
                            "drive": drive,
                            "steps": 100000,
                            **{f"axis_{axis}_start": value for axis, value in zip("abc", start, strict=True)},
                            **{f"axis_{axis}_disr": value for axis, value in zip("abc", end, strict=True)},
                        }
                    )
    return pd.DataFrame(rows)


def marked(run):
    """A run and its marks."""
    return run, disruption(run)


def make_fragments(grains=6, exponent=1.2, seed=0):
    """Fragments of grains of three types and sizes, monomers drawn from a power law, together half of the mass."""
    rng = np.random.default_rng(seed)
    rows, number = [], 0
    for kind in CONTACTS:
        for a_eff, largest in ((50e-9, 20), (200e-9, 100), (500e-9, 1000)):
            n = np.arange(1, largest + 1)
            law = n**-exponent / np.sum(n**-exponent)
            for _ in range(grains):
                monomers = rng.choice(n, size=rng.integers(2, 9), p=law)
                mass = 0.5 * monomers / monomers.sum()
                rows += [
                    {
                        "type": kind,
                        "a_eff": a_eff,
                        "grain": number,
                        "n_monomers": largest + 1,
                        "fragment_n_monomers": m,
                        "mass_fraction": part,
                    }
                    for m, part in zip(monomers, mass, strict=True)
                ]
                number += 1
    return pd.DataFrame(rows).assign(weight=1.0, half=True, disruption=False)
