"""Which fragments leave a grain until it is disrupted, and how the mass is spread over them.

A run notes each fragment when it has left for good (`ratd.experiments.spin_up.run.FRAGMENTS`). Two pieces of that
list say how a grain falls apart: what left up to omega_disr, the peak of the stress, and what left while the first half
of the mass went, which takes in the collapse itself (it follows the peak of the stress, and a piece that was cut off
leaves a little later). Only these fragments are kept: what becomes of the largest one after that is a matter of the
spin-up going on.
"""

import numpy as np
import pandas as pd
import xarray as xr

from ratd.base.errors import InputError
from ratd.base.statistics import equal_weights
from ratd.experiments.spin_up.ensemble import cell_of

HALF = 0.5
"""Part of the mass that leaves in the second piece of the list."""
COLUMNS = {
    "material": ("", "material of the monomers"),
    "type": ("", "growth: BA, BAM1 or BAM2"),
    "a_eff": ("m", "effective radius of the grain"),
    "seed": ("1", "seed of the grain"),
    "grain_mass": ("kg", "mass of the grain"),
    "omega_disr": ("rad s-1", "angular velocity of disruption"),
    "mass_fraction_disr": ("1", "mass of the largest fragment at omega_disr over that of the grain"),
}
"""Units and meaning of what is known of each grain."""
FRAGMENT_COLUMNS = {
    "fragment_mass": ("kg", "mass of a fragment that left"),
    "fragment_n_monomers": ("1", "number of monomers of a fragment that left"),
    "fragment_omega": ("rad s-1", "angular velocity at which a fragment left"),
}
"""Units and meaning of what is known of each fragment."""
STAGES = {
    "disruption": "up to omega_disr",
    "half": "while the first half of the mass leaves",
}


def fragmentation(run, mark):
    """Fragments that leave one grain up to omega_disr, or until half of its mass has left, whichever is later.

    Parameters
    ----------
    run : xarray.Dataset
        A spin-up run, see `ratd.spin_up`.
    mark : xarray.Dataset
        What `ratd.disruption` returns for it.

    Returns
    -------
    xarray.Dataset
        Scalars of `COLUMNS` and, over `fragment`, the variables of `FRAGMENT_COLUMNS`, in the order of leaving.
    """
    order = np.argsort(run["fragment_omega"].values, kind="stable")
    omega = run["fragment_omega"].values[order]
    mass = run["fragment_mass"].values[order]
    grain_mass = float(run.attrs["initial_mass"])
    kept = 0
    if len(mass):
        gone = np.cumsum(mass)
        kept = min(int(np.searchsorted(gone, HALF * grain_mass)) + 1, len(mass))
        omega_disr = float(mark["omega_disr"])
        if np.isfinite(omega_disr):
            kept = max(kept, int(np.sum(omega <= omega_disr)))
    row = xr.Dataset(
        {
            **{name: run.attrs[name] for name in ("material", "type", "a_eff", "seed")},
            "grain_mass": grain_mass,
            "omega_disr": float(mark["omega_disr"]),
            "mass_fraction_disr": float(mark["mass_fraction_disr"]),
        }
    )
    for name in FRAGMENT_COLUMNS:
        row[name] = ("fragment", run[name].values[order][:kept])
    return row


def join(rows):
    """Fragmentation of many grains as one dataset, the fragments one grain after the other.

    Parameters
    ----------
    rows : list of xarray.Dataset
        What `fragmentation` returned for them.

    Returns
    -------
    xarray.Dataset
        `COLUMNS` and row_size_fragment over `row`, `FRAGMENT_COLUMNS` over `fragment`: a file of kind "fragments".

    Raises
    ------
    InputError
        If there is no grain.
    """
    if not rows:
        raise InputError("fragmentation: at least one grain is needed")
    result = xr.Dataset({name: ("row", np.array([row[name].item() for row in rows])) for name in COLUMNS})
    result["row_size_fragment"] = ("row", np.array([row.sizes["fragment"] for row in rows], dtype="i8"))
    for name in FRAGMENT_COLUMNS:
        result[name] = ("fragment", np.concatenate([row[name].values for row in rows]))
    return result


def fragment_table(dataset):
    """One row a fragment, with its grain.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of kind "fragments".

    Returns
    -------
    pandas.DataFrame
        Columns of `COLUMNS` and `FRAGMENT_COLUMNS`; `grain`, the number of the grain; `mass_fraction`, the mass of the
        fragment over that of the grain; `disruption` and `half`, whether it belongs to these `STAGES`; `weight` of the
        grain, with which all cells (material, type, size) count alike.
    """
    size = dataset["row_size_fragment"].values
    grains = pd.DataFrame({name: dataset[name].values for name in COLUMNS})
    grains["grain"] = np.arange(len(grains))
    grains["weight"] = equal_weights(cell_of(grains))
    table = grains.loc[grains.index.repeat(size)].reset_index(drop=True)
    for name in FRAGMENT_COLUMNS:
        table[name] = dataset[name].values
    table["mass_fraction"] = table["fragment_mass"] / table["grain_mass"]
    before = table.groupby("grain")["mass_fraction"].cumsum() - table["mass_fraction"]
    table["half"] = before < HALF
    table["disruption"] = table["fragment_omega"] <= table["omega_disr"]
    return table
