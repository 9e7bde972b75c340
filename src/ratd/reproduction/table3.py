"""Table 3 of the paper beside the fits to our grains."""

import numpy as np

from ratd.ensemble import radius_of_reading, size_key
from ratd.markdown import markdown_table
from ratd.reproduction.bounds import PM, shown_sizes
from ratd.reproduction.text import between, interval, number
from ratd.units import NM


def table3_section(data):
    """A and alpha beside print, a table a drive, Markdown; of the second reading of <a_mon> what it changes."""
    sizes = ", ".join(f"{size * PM / NM:g}" for size in shown_sizes(data.grown))
    parts = [
        "Least squares of ln omega_disr over single grains, all sizes with the same weight; in brackets the bootstrap "
        f"interval of {100 * data.plan.config['ensemble']['confidence']:g} %. A is the value at N_con phi = 1, far "
        "from any grain, and moves against alpha. Eq. 33 fixes the power -1 of a_eff, so that alpha takes up the rest "
        "of the fall with size, and is negative where omega_disr falls more steeply. What can be compared is Eq. 33 "
        f"with the fitted numbers over Eq. 33 with the printed ones, given at {sizes} nm for the geometric mean of "
        "N_con phi of the grown grains there. Scatter: standard deviation of ln omega_disr about the fit."
    ]
    for drive, fit in data.fits.items():
        first, *others = (str(reading) for reading in fit["mean_radius"].values)
        best = _numbers(fit, first)
        rows = [_row(*cell, one, _shapes(data, *cell)) for cell, one in best.items()]
        inside = sum(one["alpha_low"] <= one["alpha_printed"] <= one["alpha_high"] for one in best.values())
        head = ["material", "type", "A printed", "A", "alpha printed", "alpha", "alpha less printed"]
        parts.append(f"Drive `{drive}`, <a_mon> = {radius_of_reading(first) / NM:g} nm:")
        parts.append(markdown_table([*head, "Eq. 33 over print", "scatter", "grains"], rows))
        words = f"The interval of alpha holds the printed value in {inside} of {len(rows)} cases."
        for reading in others:
            own = _numbers(fit, reading)
            change = [own[cell]["alpha"] - best[cell]["alpha"] for cell in best]
            over = [own[cell]["A"] / best[cell]["A"] for cell in best]
            words += (
                " With the mean radius of each grain's own monomers for <a_mon> alpha changes by "
                f"{between(np.nanmin(change), np.nanmax(change))}, and A is "
                f"{between(np.nanmin(over), np.nanmax(over))} times as great."
            )
        parts.append(words)
        if fit.attrs["missing_fits"]:
            parts.append(f"No fit: {fit.attrs['missing_fits']}.")
    return "\n\n".join(parts)


def _numbers(fit, reading):
    """(material, type) -> numbers of a fit for one reading of <a_mon>."""
    cells = [(str(material), str(kind)) for material in fit["material"].values for kind in fit["type"].values]
    own = {cell: fit.sel(mean_radius=reading, material=cell[0], type=cell[1]) for cell in cells}
    return {cell: {name: float(one[name]) for name in one} for cell, one in own.items()}


def _row(material, kind, best, shapes):
    """Cells of one fit: print, ours, their difference, and Eq. 33 with ours over that with the printed numbers."""
    cells = [material, kind]
    for name in ("A", "alpha"):
        ends = (best[f"{name}{end}"] for end in ("", "_low", "_high"))
        cells += [number(best[f"{name}_printed"]), interval(*ends)]
    difference = best["alpha"] - best["alpha_printed"]
    over = [number(best["A"] / best["A_printed"] * shape**difference) for shape in shapes]
    return [*cells, number(difference), " / ".join(over), number(best["scatter"]), f"{best['n_grains']:g}"]


def _shapes(data, material, kind):
    """Geometric mean of N_con phi of the grown grains of a material and type, at each of `shown_sizes`."""
    own = data.grown[(data.grown["material"] == material) & (data.grown["type"] == kind)]
    shape = np.log(own["n_contacts"] * own["filling_factor"]).groupby(size_key(own["a_eff"])).mean()
    return [np.exp(shape.get(size, np.nan)) for size in shown_sizes(data.grown)]
