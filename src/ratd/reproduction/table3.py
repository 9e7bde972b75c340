"""Table 3 of the paper beside the fits to our grains."""

import numpy as np

from ratd.ensemble import radius_of_reading, size_key
from ratd.markdown import markdown_table
from ratd.reproduction.bounds import PM, shown_sizes
from ratd.reproduction.text import interval, number
from ratd.units import NM


def table3_section(data):
    """A and alpha beside print, a table a drive and reading of <a_mon>, Markdown."""
    sizes = ", ".join(f"{size * PM / NM:g}" for size in shown_sizes(data.grown))
    parts = [
        "Least squares of ln omega_disr over single grains, all sizes with the same weight; in brackets the bootstrap "
        f"interval of {100 * data.plan.config['ensemble']['confidence']:g} %. <a_mon> is read as the printed 20 nm and "
        "as the mean radius of each grain's own monomers: the choice moves A, and hardly alpha. A is the value at "
        "N_con phi = 1, far from any grain, and moves against alpha. Eq. 33 fixes the power -1 of a_eff, so that alpha "
        "takes up the rest of the fall with size, and is negative where omega_disr falls more steeply. What can be "
        f"compared is Eq. 33 with the fitted numbers over Eq. 33 with the printed ones, given at {sizes} nm for the "
        "geometric mean of N_con phi of the grown grains there. Both have the <a_mon> that the table names; with the "
        "own mean radius, the greater one, the printed Eq. 33 is lower as well. Scatter: standard deviation of "
        "ln omega_disr about the fit."
    ]
    for drive, fit in data.fits.items():
        for reading in fit["mean_radius"].values:
            cells = [(str(material), str(kind)) for material in fit["material"].values for kind in fit["type"].values]
            best = [fit.sel(mean_radius=reading, material=material, type=kind) for material, kind in cells]
            best = [{name: float(one[name]) for name in one} for one in best]
            rows = [_row(*cell, one, _shapes(data, *cell)) for cell, one in zip(cells, best, strict=True)]
            inside = sum(one["alpha_low"] <= one["alpha_printed"] <= one["alpha_high"] for one in best)
            radius = radius_of_reading(str(reading))
            label = "own mean radius" if radius is None else f"{radius / NM:g} nm"
            parts.append(f"Drive `{drive}`, <a_mon> = {label}:")
            head = ["material", "type", "A printed", "A", "alpha printed", "alpha", "alpha less printed"]
            parts.append(markdown_table([*head, "Eq. 33 over print", "scatter", "grains"], rows))
            parts.append(f"The interval of alpha holds the printed value in {inside} of {len(rows)} cases.")
        if fit.attrs["missing_fits"]:
            parts.append(f"No fit: {fit.attrs['missing_fits']}.")
    return "\n\n".join(parts)


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
