"""The text of docs/reproduction.md."""

import re

from ratd.calibration import PRINTED_STEP
from ratd.composition import tell
from ratd.ensemble import cell_of, size_key
from ratd.markdown import markdown_table
from ratd.marks import MEDIAN_WINDOW
from ratd.reproduction import argument, disrupted, grown, open_questions, pair_test, rate, structure
from ratd.reproduction.bounds import sizes_of, table3_omega
from ratd.reproduction.captions import CAPTIONS
from ratd.reproduction.data import COMMON_FIGURES, DRIVEN_FIGURES
from ratd.reproduction.paper import ABOUT
from ratd.reproduction.recommended import recommended_section
from ratd.reproduction.summary import answer, summary
from ratd.reproduction.table3 import table3_section
from ratd.reproduction.text import number, row_table, with_error
from ratd.spinup import FIRST_LOSS
from ratd.statistics import mean_of, median_of

INTRODUCTION = """# Reproduction of Reissl et al. (2024)

Reissl, Nguyen, Jordan & Klessen (2024, A&A 692, A60, arXiv:2301.12889) spin up porous grains until they fly apart, and
give the angular velocity omega_disr at which they do. Here is every figure, table and quoted number of the paper beside
what this code finds, what holds and what does not, by how much, and why as far as that can be shown.

Numbers and figures were written by

    snakemake --cores 2 redraw

from the files in `docs/reproduction/data` and, for the checks of the model, in `docs/validation/data`, where READMEs
say how these were made; no number but the printed ones and the rules of “holds if” was typed by hand. "±" is a standard
error, that of a median rather too large. A range in brackets behind a value holds the middle two thirds of the grains
(16th to 84th percentile); “(x–y of n)” is from the least to the greatest of n; other ranges say what they are. Angular
velocities are in rad/s.

**Two models.** Every spin-up was made in up to two ways, called drives:

- `prescribed`, the consistent model: an outer torque, which the radiation supplies, makes the grain turn with omega(t).
- `literal`, the terms of the frame as printed (Eqs. 29 and 30): inertial forces of a turning frame, no outer torque. A
  grain that obeys them exactly does not turn in the inertial frame but for the terms that Eq. 30 leaves out, see
  `docs/model.md`. The forces of the contacts are those of the consistent model, with the damping that Eq. 29 lacks;
  what their misprints change is told under Each printed formula alone. Unless “exact” is said, the Coriolis force is
  taken at the velocity half a step before (“explicit”): this lag, which grows with the step, turns a grain backwards
  and is what tears it. How the paper takes it is not said.

What the printed equations do is shown here. What the authors' code did is not known: it may differ from the print.

**Words.**

- BA, BAM1, BAM2: ways to grow a grain, by ballistic aggregation without, with one, and with two migrations of each
  monomer, so that it has about one, two and three contacts a monomer. a-C, q-S, co-S: amorphous carbon, quartz silicate
  and a mixture of silicates, the three materials. A cell is a material, type and size.
- a_eff, the size: radius of the sphere of the same volume of matter. a, b, c: semi-axes of a grain, a < b < c; oblate
  means b/a > c/b. phi: filling factor. P = 1 - phi: porosity.
- omega_disr, the paper's mark: the omega at which the total stress of the largest fragment peaks. The total stress (Eq.
  32) is the sum over all contacts of |F_N|/(pi r²), r being the radius of the contact, which is no stress of the
  material. What the paper leaves open: here it is a running median over {window} records (one each {record} of the
  cut bound), which count only while the largest fragment holds at least half of the mass of the grain, and of equal
  peaks the last. Other marks are the first loss of mass, and the loss of a quarter of it.
- Eq. 33, the paper's fit: omega_disr = A/a_eff sqrt(gamma/(rho <a_mon>)) (N_con phi)^alpha, A and alpha in Table 3;
  N_con is the number of contacts and <a_mon> the mean radius of the monomers. With the printed Table 3 it is taken at
  the printed <a_mon> = 20 nm; with that of our grains, which is greater, it would be lower (Table 3).
- F_C: the greatest pull of a contact. Cut bound: the omega above which the weakest cut through the contacts of a grain,
  each holding F_C, gives way; firm bound: the same with all that contacts bear, sideways and pushed as well (What the
  contacts can hold).
- dt, f: the time step, f times the shortest time of the contacts (Eq. 31); printed f = {step:g}. The ensemble of the
  drive `prescribed` has f = {prescribed_step:g}; other studies name theirs.
- epsilon = (d omega/dt)/omega², how fast the drive `prescribed` raises omega; {epsilon} from {first:g} of the cut bound
  on, faster below, where many BAM grains part (Does omega_disr flatten with size? tells how fast, and what it does).
- d omega/dt: how fast the drive `literal` raises omega. What the figures of the paper were made with is not known (One
  free number of the literal drive). The runs of the ensemble have {rate}; other runs name theirs.
- xi_c: how far a contact rolls before it gives way; T_vis: viscous time of the damping. The cell of Fig. 4: {cell}.
- A solid grain: one that turns as a rigid body, until it parts where the consistent model says."""

SEEN = {True: "yes", False: "no", None: "not decided"}
WIDE_FIGURES = (6, 7, 9)
"""Numbers of figures that are as wide as a page: those of the two drives stand below each other."""
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
    rows = [*grown.rows(data), *structure.rows(data), *disrupted.rows(data), *disrupted.pairs(data)]
    parts = [
        _introduction(data),
        "## In short",
        *answer(data),
        *_further(data, "overview", pictures),
        summary(data, rows),
        *_recommended(data),
        "## Which grains",
        _coverage(data),
        "## The printed numbers",
        "One row for each number or finding that the paper quotes; Tables 1, 2 and 3 and Fig. 1 have tables of their "
        "own below. “ratio” is ours over printed, of both ends for a range. “holds” says whether ours fulfils the rule "
        "under “holds if”: within a quarter is a factor of 1.25 either way, to a tenth is 10 % beyond either end. "
        "Where an error is given, yes and no need two errors; extremes, ranges and the cell of Fig. 4 have none and "
        "are compared as they stand. A dash: not decided (also a mean, median or slope of too few grains for an "
        "error), no rule, or used to fix the drive. Left out are Fig. 3, a sketch; what the paper says of its own runs "
        "(their energy error, number of steps and Euler forces) and of other work; and what the data do not tell: the "
        "fractal dimension at disruption, what a grain does where the spin-up stops, and Fig. 9 for q-S and co-S.",
        *_printed_numbers(data, rows),
        "## Figures and tables",
        *_figures(data, pictures, captions or {}, rows),
        "## Why the consistent model lies below the print",
        argument.INTRODUCTION,
        *_argument(data, pictures),
        "## Beyond the paper",
        *_beyond(data, pictures),
    ]
    return "\n\n".join(parts) + "\n"


def _recommended(data):
    """What to use for omega_disr, under its heading."""
    parts = recommended_section(data)
    return ["## What to use for omega_disr", *parts] if parts else []


def _introduction(data):
    config, printed = data.plan.config, rate.printed_rate(data)
    law = data.plan.spin_up_of("literal")
    own = f"{data.plan.pace('literal')} and f = {law['timestep_factor']:g}"
    return INTRODUCTION.format(
        step=PRINTED_STEP,
        prescribed_step=data.plan.spin_up_of("prescribed")["timestep_factor"],
        window=MEDIAN_WINDOW,
        epsilon=data.plan.pace("prescribed").removeprefix("epsilon = "),
        first=FIRST_LOSS,
        record=f"1/{2 * data.plan.spin_up_of('prescribed')['records']:g}",
        cell=_cell_of_figure4(config),
        rate=own if printed is None else f"{own}, which stands for {number(printed)} rad/s² at the printed step",
    )


def _cell_of_figure4(config):
    own = config["figures"]["figure4"]
    return f"{own['material']} {own['type']} {own['size_nm']:g} nm" if own else "none"


def _printed_numbers(data, rows):
    """A table for each part of `ABOUT`, under its heading."""
    parts = []
    for about, what in ABOUT.items():
        chosen = [row for row in rows if row.printed.about == about]
        parts += [f"### {what[0].upper()}{what[1:]}", *(_more_grains(data) if about == "grains" else [])]
        parts.append(row_table(chosen, data.drives if about == "spin-up" else []))
    return parts


def _more_grains(data):
    """Which grains are told of as grown, a paragraph; none where they are those of the ensemble."""
    table = data.at_rest
    if table is data.grown:
        return []
    least = table.groupby(["type", size_key(table["a_eff"])]).size().min()
    own = data.grown["material"].isin(table["material"])
    one, other = (mean_of(part["porosity"], cell_of(part)) for part in (data.grown[own], data.grown[~own]))
    return [
        f"Said of {len(table)} grains, at least {least} of each type and size, which were grown like those of the "
        f"ensemble (docs/validation.md, Growth), all of {', '.join(table['material'].unique())}. Materials differ in "
        "how far a contact is compressed, which hardly moves a monomer: the mean porosity of these grains of the "
        f"ensemble is {with_error(*one)}, of the others {with_error(*other)}. With 90 of each type and size, as in the "
        "paper, chance would leave more of it open. “Single grains” are those of the ensemble."
    ]


def _coverage(data):
    """Grains per type and size, of the paper's 90 each (3 materials x 30 seeds)."""
    total = sum(len(table) for table in data.tables.values())
    sizes = sorted({size for table in data.tables.values() for size in size_key(table["a_eff"])})
    rows = []
    for drive, table in data.tables.items():
        for kind, part in table.groupby("type", sort=False):
            counts = size_key(part["a_eff"]).value_counts()
            rows.append([drive, kind, *(str(counts.get(size, 0)) for size in sizes), str(len(part))])
    at_rest = ", and what is said of them at rest," if data.at_rest is data.grown else ""
    text = (
        f"{len(data.grown)} grains were grown, and {total} spin-ups made. The paper has 2970 grains: 3 materials, 3 "
        "types, 11 sizes from 50 to 550 nm, 30 seeds, that is 90 grains of each type and size. What the contacts of "
        f"grains can hold{at_rest} is said of all that were grown. The table counts the spin-ups. Where something is "
        "said of several cells (a material, type and size each), all of them have the same weight, as in the paper, "
        "where each has 30 grains: means, medians (weighted by Harrell's rule) and fits do not depend on how many "
        f"grains of each could be computed, but their errors do.{_missing(data)}"
    )
    counts = markdown_table(["drive", "type", *(f"{s / 1e3:g} nm" for s in sizes), "all"], rows)
    return "\n\n".join([text, counts, _marks(data)])


def _missing(data):
    """A sentence where a drive lacks cells that were grown."""
    cells = data.grown.assign(size=size_key(data.grown["a_eff"])).groupby(["material", "type", "size"]).ngroups
    short = [drive for drive, table in data.tables.items() if len(set(cell_of(table))) < cells]
    return f" Cells that are missing ({', '.join(short)}) are missing in all of that." if short else ""


def _marks(data):
    """A paragraph: grains that lack the mark of 25 % of the mass, and what the definition of omega_disr decides."""
    lacking, greater, levels = [], [], []
    for drive, table in data.tables.items():
        without = table[table["omega_mass_75"].isna()]
        lacking.append(f"{len(without)} ({drive}{f', {sizes_of(without)}' if len(without) else ''})")
        count = int((table["omega_stress_max"] > table["omega_disr"] * (1 + 1e-9)).sum())
        greater.append(f"{count} of {len(table)} ({drive})")
        printed = table3_omega(table, data.plan.materials)
        level = median_of(table["omega_stress_max"] / printed, cell=cell_of(table))
        levels.append(f"{number(level['median'])} ({drive})")
    return (
        "Grains without the mark of a quarter of the mass, as it was not lost before their run ended: "
        f"{', '.join(lacking)}; they are missing in what is said of 25 % of the mass. Had the stress of a largest "
        f"fragment with less than half of the mass counted, omega_disr would be greater in {', '.join(greater)} "
        f"grains, and its median over Eq. 33 with the printed Table 3 {', '.join(levels)}."
    )


def _figures(data, pictures, captions, rows):
    """One section a figure or table, in the order of the paper."""
    one, two = tell()
    parts = ["### Table 1: abundances in co-S", one, "### Table 2: materials", two]
    there = set(data.figures)
    for number_ in sorted({*COMMON_FIGURES, *DRIVEN_FIGURES}):
        if number_ == 8:
            parts += ["### Table 3: A and alpha of Eq. 33", table3_section(data)]
        parts.append(f"### Fig. {number_}")
        names = [f"figure{number_}_{drive}" for drive in data.drives] if number_ in DRIVEN_FIGURES else []
        names = [name for name in [f"figure{number_}", *names] if name in there]
        if not names:
            parts.append("The data of this figure are not there.")
            continue
        parts += _stacked(names, pictures) if number_ in WIDE_FIGURES else [_side_by_side(names, pictures)]
        if number_ in captions:
            parts.append(_caption(captions[number_]))
        parts += _seen(number_, rows, data.drives)
        if number_ == 1:
            head, lines, outside = grown.figure1_table(data)
            parts.append(markdown_table(head, lines))
            parts.append(
                "“Ours” is the grain that is drawn, of another seed than the paper's; the range is that of all grown "
                "grains of the type and size. N_con follows from N_mon and the type, and N_mon, on the whole, from the "
                "distribution of radii, which was chosen for it. Printed values outside the range: "
                f"{', '.join(outside) or 'none'}. The paper lets monomers migrate in a random direction, as here; what "
                "a_out is when they migrate to the nearest place stands in docs/validation.md (Growth)."
            )
    return parts


def _side_by_side(names, pictures):
    """Pictures next to each other, those of the two drives in one row."""
    cells = [f"![{name}]({pictures}/{name}.png)" for name in names]
    return markdown_table([name.partition("_")[2] or "all drives" for name in names], [cells])


def _stacked(names, pictures):
    """Pictures below each other, as wide as the page."""
    return [f"![{name}]({pictures}/{name}.png)" for name in names]


def _seen(number_, rows, drives):
    """A paragraph: what the paper says of a figure, and whether it is seen here, from the rows of printed numbers."""
    told = []
    for row in rows:
        if not row.printed.rule or not re.search(rf"Fig\. {number_}\b", row.printed.place) or not row.answers:
            continue
        names = [drive for drive in drives if drive in row.answers]
        verdicts = " / ".join(SEEN[row.answers[name].holds] for name in names or [""])
        told.append(f"{row.printed.what} ({row.printed.text}): {verdicts}")
    if not told:
        return []
    of = f" ({' / '.join(drives)})" if number_ in DRIVEN_FIGURES else ""
    return [f"Seen here of what the paper says with it{of}, by the rules of The printed numbers: {'; '.join(told)}."]


def _caption(text):
    """A caption of the report as Markdown, in one paragraph each."""
    text = text.replace(f", drive {CAPTION_DRIVE}", "").replace(f" (here {CAPTION_DRIVE})", "")
    return text.replace("``", "`").strip()


def _argument(data, pictures):
    return [
        "### What the contacts can hold",
        argument.bound_section(data),
        *_further(data, "bound", pictures),
        "### LAMMPS",
        argument.lammps_section(data),
        *_further(data, "lammps", pictures),
        "### What the literal drive does",
        argument.literal_section(data),
        *_further(data, "literal", pictures),
        "### One free number of the literal drive",
        rate.calibration_section(data),
        *_further(data, "calibration", pictures),
        "### The pairs of Fig. 10 under the printed equations",
        pair_test.section(data),
        "### Each printed formula alone",
        argument.formula_section(data),
        *_further(data, "formulae", pictures),
    ]


def _further(data, name, pictures):
    """A figure that the paper does not have with its caption, where there are data for it; paragraphs."""
    return [f"![{name}]({pictures}/{name}.png)", CAPTIONS[name]] if name in data.further_figures else []


def _beyond(data, pictures):
    return [
        "### Eq. 33 or the cut bound?",
        open_questions.predictor_section(data),
        "### Does omega_disr flatten with size?",
        open_questions.flattening_section(data),
        "### Sizes of the fragments",
        open_questions.fragment_section(data),
        *_further(data, "fragments", pictures),
        "### Oblate or prolate",
        open_questions.shape_section(data),
    ]
