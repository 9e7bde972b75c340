"""The text of docs/reproduction.md."""

from ratd.composition import tell
from ratd.ensemble import radius_of_reading, size_key
from ratd.markdown import markdown_table
from ratd.reproduction import argument, disrupted, grown, open_questions
from ratd.reproduction.data import COMMON_FIGURES, DRIVEN_FIGURES
from ratd.reproduction.summary import summary
from ratd.reproduction.text import interval, number, row_table
from ratd.units import NM

INTRODUCTION = """# Reproduction of Reissl et al. (2024)

Reissl, Nguyen, Jordan & Klessen (2024, A&A 692, A60, arXiv:2301.12889) spin up porous grains until they fly apart, and
give the angular velocity omega_disr at which they do. Here is every figure, table and quoted number of the paper beside
what this code finds, what holds and what does not, by how much, and why as far as that can be shown.

Numbers and figures were written by

    snakemake --cores 2 redraw

from the files in `docs/reproduction/data`, where a README says how these were made; no number but the printed ones was
typed by hand. "±" is a standard error, a range in brackets behind a value is its {confidence:g} % interval unless the
text says otherwise. Angular velocities are in rad/s.

**Two models.** Every spin-up was made in up to two ways, called drives:

- `prescribed`, the consistent model: an outer torque, which the radiation supplies, makes the grain turn with omega(t).
- `literal`, the equations as printed (Eqs. 29 and 30): inertial forces of a turning frame, no outer torque. A grain
  that obeys them exactly does not turn in the inertial frame but for the terms that Eq. 30 leaves out, see
  `docs/model.md`.

What the printed equations do is shown here. What the authors' code did is not known: it may differ from the print."""

CAPTION_DRIVE = "``{{ snakemake.wildcards.drive }}``"


def report(data, pictures, captions=None):
    """The text of the document, Markdown.

    Parameters
    ----------
    data : ratd.reproduction.data.Data
    pictures : str
        Folder of the figures, as seen from the document.
    captions : dict of int to str, optional
        Number of a figure -> caption of the report (reStructuredText).

    Returns
    -------
    str
    """
    drives = data.drives
    rows = [*grown.rows(data), *disrupted.rows(data)]
    parts = [
        INTRODUCTION.format(confidence=100 * data.plan.config["ensemble"]["confidence"]),
        "## In short",
        summary(data, rows),
        "## Which grains",
        _coverage(data),
        "## The printed numbers",
        "One row for each number or finding that the paper quotes; Tables 1, 2 and 3 and Fig. 1 have tables of their "
        "own below. “ratio” is ours over printed, of both ends for a range. “holds” says whether ours lies within a "
        "quarter of the printed value (a factor of 2 where the paper says “roughly”), or whether a finding in words is "
        "seen in our grains; a dash, that the data do not decide it.",
        row_table(rows, drives),
        "## Figures and tables",
        *_figures(data, pictures, captions or {}),
        "## Why the consistent model lies below the print",
        argument.INTRODUCTION,
        *_argument(data, pictures),
        "## Beyond the paper",
        *_beyond(data, pictures),
    ]
    return "\n\n".join(parts) + "\n"


def _coverage(data):
    """Grains per type and size, of the paper's 90 each (3 materials x 30 seeds)."""
    total = sum(len(table) for table in data.tables.values())
    sizes = sorted({size for table in data.tables.values() for size in size_key(table["a_eff"])})
    rows = []
    for drive, table in data.tables.items():
        for kind, part in table.groupby("type", sort=False):
            counts = size_key(part["a_eff"]).value_counts()
            rows.append([drive, kind, *(str(counts.get(size, 0)) for size in sizes), str(len(part))])
    text = (
        f"{len(data.grown)} grains were grown, and {total} spin-ups made. The paper has 2970 grains: 3 materials, 3 "
        "types, 11 sizes from 50 to 550 nm, 30 seeds, that is 90 grains of each type and size. What is said of grains "
        "at rest, and of what their contacts can hold, is said of all that were grown. The table counts the spin-ups. "
        "Where something is said of several cells (a material, type and size each), all of them have the same weight, "
        "as in the paper, where each has 30 grains: means, medians and fits do not depend on how many grains of each "
        "could be computed, but their errors do. Cells that are missing here are missing in all of that."
    )
    return f"{text}\n\n{markdown_table(['drive', 'type', *(f'{s / 1e3:g} nm' for s in sizes), 'all'], rows)}"


def _figures(data, pictures, captions):
    """One section a figure or table, in the order of the paper."""
    one, two = tell()
    parts = ["### Table 1: abundances in co-S", one, "### Table 2: materials", two]
    there = set(data.figures)
    for number_ in sorted({*COMMON_FIGURES, *DRIVEN_FIGURES}):
        if number_ == 8:
            parts += ["### Table 3: A and alpha of Eq. 33", _table3(data)]
        parts.append(f"### Fig. {number_}")
        names = [f"figure{number_}_{drive}" for drive in data.drives] if number_ in DRIVEN_FIGURES else []
        names = [name for name in [f"figure{number_}", *names] if name in there]
        if not names:
            parts.append("The data of this figure are not there.")
            continue
        parts.append(_side_by_side(names, pictures))
        if number_ in captions:
            parts.append(_caption(captions[number_]))
        if number_ == 1:
            head = ["type", "size [nm]"]
            head += [
                f"{what}{of}" for what in ("N_mon", "N_con", "a_out [nm]") for of in (", printed", ", ours", ", ratio")
            ]
            parts.append(markdown_table(head, grown.figure1_rows(data)))
            parts.append("Single grains of other seeds: N_mon scatters, N_con follows from it and the type.")
    return parts


def _side_by_side(names, pictures):
    """Pictures next to each other, those of the two drives in one row."""
    cells = [f"![{name}]({pictures}/{name}.png)" for name in names]
    return markdown_table([name.partition("_")[2] or "all drives" for name in names], [cells])


def _caption(text):
    """A caption of the report as Markdown, in one paragraph each."""
    text = text.replace(f", drive {CAPTION_DRIVE}", "").replace(f" (here {CAPTION_DRIVE})", "")
    return text.replace("``", "`").strip()


def _table3(data):
    """A and alpha beside print, a table a drive and reading of <a_mon>."""
    parts = [
        "Least squares over single grains, all sizes with the same weight; in brackets the bootstrap interval. <a_mon> "
        "is read as the printed 20 nm and as the mean radius of each grain's own monomers: the choice moves A, and "
        "hardly alpha. Ratio: ours over printed."
    ]
    for drive, fit in data.fits.items():
        for reading in fit["mean_radius"].values:
            rows = []
            for material in fit["material"].values:
                for kind in fit["type"].values:
                    best = fit.sel(mean_radius=reading, material=material, type=kind)
                    cells = [str(material), str(kind)]
                    for name in ("A", "alpha"):
                        value, low, high, printed = (
                            float(best[f"{name}{end}"]) for end in ("", "_low", "_high", "_printed")
                        )
                        cells += [number(printed), interval(value, low, high), number(value / printed)]
                    rows.append(
                        [*cells, number(float(best["scatter"])), f"{int(best['n_grains'])} of {int(best['n_sizes'])}"]
                    )
            radius = radius_of_reading(str(reading))
            label = "own mean radius" if radius is None else f"{radius / NM:g} nm"
            parts.append(f"Drive `{drive}`, <a_mon> = {label}:")
            head = ["material", "type", "A printed", "A", "ratio", "alpha printed", "alpha", "ratio", "scatter"]
            parts.append(markdown_table([*head, "grains of sizes"], rows))
        if fit.attrs["missing_fits"]:
            parts.append(f"No fit: {fit.attrs['missing_fits']}.")
    return "\n\n".join(parts)


def _argument(data, pictures):
    there = set(data.further_figures)

    def picture(name):
        return [f"![{name}]({pictures}/{name}.png)"] if name in there else []

    return [
        "### What the contacts can hold",
        argument.bound_section(data),
        *picture("bound"),
        "### LAMMPS",
        argument.lammps_section(data),
        *picture("lammps"),
        "### What the literal drive does",
        argument.literal_section(data),
        *picture("literal"),
        "### One free number of the literal drive",
        argument.calibration_section(data),
        *picture("calibration"),
        "### Each printed formula alone",
        argument.formula_section(data),
        *picture("formulae"),
    ]


def _beyond(data, pictures):
    fragments = [f"![fragments]({pictures}/fragments.png)"] if "fragments" in data.further_figures else []
    return [
        "### Eq. 33 or the cut bound?",
        open_questions.predictor_section(data),
        "### Does omega_disr flatten with size?",
        open_questions.flattening_section(data),
        "### Sizes of the fragments",
        open_questions.fragment_section(data),
        *fragments,
        "### Oblate or prolate",
        open_questions.shape_section(data),
        "A and alpha with their intervals stand under Table 3.",
    ]
