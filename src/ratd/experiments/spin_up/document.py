"""docs/reproduction.md, its appendix and their figures, drawn again from the data beside them.

python -m ratd.experiments.spin_up.document collect RESULTS    take what the pipeline made, such as results/paper
python -m ratd.experiments.spin_up.document redraw             figures and text, in seconds

The ensemble itself grows in docs/reproduction/data/spun_up, see `ratd.experiments.spin_up.study`.
"""

import itertools
import math
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from ratd.aggregates.files import read_grains
from ratd.base.errors import FileError
from ratd.base.units import NM
from ratd.experiments.spin_up.findings import beside, claims, ensemble
from ratd.experiments.spin_up.findings.fragments import of_all_that_left, of_exponents, of_shares
from ratd.experiments.spin_up.findings.law import of_curve, of_exponents_apart, of_law, of_prediction
from ratd.experiments.spin_up.findings.literature import of_literature
from ratd.experiments.spin_up.findings.mark_rules import of_mark_rules
from ratd.experiments.spin_up.findings.pulled import of_pulled
from ratd.experiments.spin_up.findings.radiation import of_radiation
from ratd.experiments.spin_up.findings.scheme import of_scheme
from ratd.experiments.spin_up.findings.shapes import of_shapes, of_stretch
from ratd.experiments.spin_up.findings.static_limit import of_static_limits
from ratd.experiments.spin_up.findings.studies import of_studies, studies
from ratd.experiments.spin_up.pulled import read_pulled
from ratd.experiments.spin_up.eq33 import fit_ensemble
from ratd.experiments.spin_up.figures.figure1 import figure1
from ratd.experiments.spin_up.figures.figure2 import figure2
from ratd.experiments.spin_up.figures.figure4 import figure4
from ratd.experiments.spin_up.figures.figure5 import figure5, nearest_snapshots
from ratd.experiments.spin_up.figures.figure6 import figure6
from ratd.experiments.spin_up.figures.figure7 import figure7
from ratd.experiments.spin_up.figures.figure8 import figure8
from ratd.experiments.spin_up.figures.figure9 import figure9
from ratd.experiments.spin_up.figures.figure10 import figure10
from ratd.experiments.spin_up.figures.fragments import fragments
from ratd.experiments.spin_up.figures.law import law
from ratd.experiments.spin_up.figures.overview import overview
from ratd.experiments.spin_up.figures.pulled import pulled
from ratd.experiments.spin_up.figures.radiation import radiation
from ratd.experiments.spin_up.fragmentation import spun_up_fragments
from ratd.experiments.spin_up.grain_table import spun_up_files, spun_up_table
from ratd.experiments.spin_up.marks import MARK, disruption
from ratd.experiments.spin_up.plan import GRAINS, RUNS, load
from ratd.experiments.spin_up.printed import PAPER_MEAN_RADIUS
from ratd.experiments.spin_up.run_files import read_runs, read_table, run_row, runs
from ratd.experiments.spin_up.shapes import read_shapes
from ratd.experiments.spin_up.static_limit import read_limits
from ratd.pictures.style import save
from ratd.pipeline import blocks, io
from ratd.pipeline.atomic import atomic, write_text
from ratd.pipeline.documents import command, fill
from ratd.pipeline.provenance import together

__all__ = ["DATA", "Data", "collect", "findings", "main", "read_data", "redraw"]

DATA = Path("docs/reproduction/data")
FIGURES = Path("docs/reproduction")
DOCUMENTS = {
    Path("docs/templates/reproduction.md"): Path("docs/reproduction.md"),
    Path("docs/templates/reproduction_appendix.md"): Path("docs/reproduction_appendix.md"),
}
CONFIGS = ("config/config.yaml", "config/spin_up.yaml")
DRIVEN, PRINTED = "prescribed", "literal"
DRIVEN_TABLE = DATA / "driven.csv"
"""The driven grains as a table for everybody, docs/compression.md for one."""
TABLE_COLUMNS = (
    "material", "type", "a_eff", "seed", "n_monomers", "n_contacts", "filling_factor", "mean_monomer_radius",
    "cut_bound", "omega_first_loss", "omega_mass_75", "omega_disr",
)  # fmt: skip
LAMMPS = {
    "driven": "validation/data/tables/lammps.csv",
    "default": "validation/data/tables/lammps_spin_up.csv",
    "starts": "validation/data/tables/lammps_single.csv",
}
"""Spin-up of ratd beside LAMMPS -> table below docs, written with docs/validation.md."""
MARK_RULES = "validation/data/mark_rules.nc"
"""omega_disr by other rules, below docs, taken there by ``python -m ratd.validation.document collect``."""
SCHEME = "quasi_static/data/quasi_static.csv"
"""Grains spun up with one thing changed, below docs, the data of docs/quasi_static.md."""
OTHERS = ("q-S", "co-S")
STUDY = "config/figure9_{}.yaml"
"""Materials beside that of figure 9 for which its constants were varied as well, and their config."""
MOVES = (
    "d.disr over quarter BA large", "equal_30nm.BA 300 nm omega_mass_75", "co-S ways.BA xi quarter",
    "dmt.BA omega_mass_75",
)  # fmt: skip
"""Slots of factors by which other choices would move omega of BA of 300 nm upward; ``d.together`` is the product, with
that of the mean radius in Eq. 33."""
BOTH_DRIVES = "config/studies/spun_up.yaml"
"""Config of the ensemble with both drives; its results are in the folder spun_up."""
SHOWN_RUNS = (f"figure4/{DRIVEN}", f"figure4/{PRINTED}", f"figure5/{DRIVEN}")
TABLES = {"parameters": "parameters/prescribed.nc", "formulae": "formulae/table.nc"}
"""Kind of file, and name beside the document -> where the pipeline has it."""


class Data(NamedTuple):
    """What stands beside the document.

    Attributes
    ----------
    grown, driven, printed : pandas.DataFrame
        All grains as grown, and those that were spun up, with Eq. 33 as printed.
    files : dict of str to list of xarray.Dataset
        Drive -> what the queue of spin-ups has made.
    fragments : dict of str to pandas.DataFrame
        Drive -> fragments.
    firm : pandas.DataFrame
    runs : dict of str to list of xarray.Dataset
        Runs of figures 4 and 5: ``figure4/prescribed`` and so on.
    grains : list of ratd.Grain
        Those of figure 1.
    tables : dict of str to pandas.DataFrame
        ``parameters`` (figure 9), ``formulae``.
    others : dict of str to pandas.DataFrame
        Material of `OTHERS` -> the same as ``parameters``.
    pairs : list of pandas.DataFrame
        Of figure 10.
    limits : pandas.DataFrame
        Static limits of grains as grown.
    pulled : pandas.DataFrame
        Grains that were pulled apart.
    shapes : pandas.DataFrame
        Grains that were looked at on their way to the break.
    lammps : dict of str to pandas.DataFrame
        Thresholds of both codes, from the validation, see `LAMMPS`.
    mark_rules : pandas.DataFrame or None
        omega_disr by other rules, from the validation, see `MARK_RULES`.
    scheme : pandas.DataFrame
        See `SCHEME`.
    studies : dict
        See `ratd.experiments.spin_up.findings.studies.studies`.
    """

    grown: pd.DataFrame
    driven: pd.DataFrame
    printed: pd.DataFrame
    files: dict
    fragments: dict
    firm: pd.DataFrame
    runs: dict
    grains: list
    tables: dict
    others: dict
    pairs: list
    limits: pd.DataFrame
    pulled: pd.DataFrame
    shapes: pd.DataFrame
    lammps: dict
    mark_rules: pd.DataFrame | None
    scheme: pd.DataFrame
    studies: dict


def collect(results, data=DATA):
    """Copy what the figures need from a folder of results of the pipeline.

    Parameters
    ----------
    results : path-like
        Such as ``results/paper``.
    data : path-like
    """
    results, data, plan = Path(results), Path(data), load(*CONFIGS)
    for name, source in TABLES.items():
        _copy(results / source, data / f"{name}.nc", name)
    for material in OTHERS:
        own = results.parent / f"figure9_{material}/parameters/{DRIVEN}.nc"
        _copy(own, data / f"parameters_{material}.nc", "parameters", f" --configfile {STUDY.format(material)}")
    for material in plan.config["materials"]:
        _copy(results / f"pairs/{material}.nc", data / f"pairs/{material}.nc", "pairs")
    path = RUNS.replace("<results>", str(results))
    _copy(Path(plan.figure4_files(path, DRIVEN)[0]), data / f"figure4/{DRIVEN}.nc", "spinup")
    # drawn from by no code: docs/model/drives.md sends readers to it
    _copy(results / "calibration/fit.nc", data / "calibration.nc", "calibration")
    (own,) = load(*CONFIGS, BOTH_DRIVES).figure4_files(path, PRINTED)
    own = results.parent / "spun_up" / Path(own).relative_to(results)
    _copy(own, data / f"figure4/{PRINTED}.nc", "spinup", f" --configfile {BOTH_DRIVES}")
    (source,) = plan.figure5_files(path, DRIVEN)
    file = _read(source, "spinup")
    wanted = plan.config["figures"]["figure5"]["seed"]
    rows = [row for row in blocks.rows(file, "spinup") if row.attrs["seed"] == wanted]
    kept = {name: file.attrs[name] for name in ("settings", "settings_hash") if name in file.attrs}
    (run,) = runs(blocks.block(rows, "spinup", blocks.material_of(file), kept))
    looks = sorted(set(nearest_snapshots(run, disruption(run)["omega_disr"].item())))
    block = blocks.block([run_row(run.isel(snapshot=looks))], "spinup", blocks.material_of(file), kept)
    io.write(data / f"figure5/{DRIVEN}.nc", block, "spinup")
    # of all grains as grown, which take longest
    _copy(results / "ensemble/grown.nc", data / "grown.nc", "table")
    _collect_firm_bounds(results, data, plan)
    _collect_figure1(results, data, plan)


def _collect_firm_bounds(results, data, plan):
    """The bounds of all materials and types in one table."""
    pairs = itertools.product(plan.config["materials"], plan.config["types"])
    parts = [_read(results / f"firm_bounds/{material}/{kind}.nc", "firm_bounds") for material, kind in pairs]
    whole = xr.concat(parts, "entry", combine_attrs="drop")
    io.write(data / "firm_bounds.nc", whole.assign_attrs(together(part.attrs for part in parts)), "firm_bounds")


def _collect_figure1(results, data, plan):
    """The grains that figure 1 shows, a file a type."""
    seed = plan.config["figures"]["figure1"]["seed"]
    files = [_read(path, "grains") for path in plan.figure1_files(GRAINS.replace("<results>", str(results)))]
    for kind in plan.config["types"]:
        own = [file for file in files if file.attrs["type"] == kind]
        rows = [row for file in own for row in blocks.rows(file, "grains") if row["seed"].item() == seed]
        made_with = together(file.attrs for file in own)
        block = blocks.block(rows, "grains", blocks.material_of(own[0]), made_with)
        io.write(data / f"figure1/{kind}.nc", block, "grains")


def _read(path, kind, how=""):
    if not Path(path).is_file():
        raise FileError(f"{path}: is missing; `snakemake --cores 2 {path}{how}` makes it")
    return io.read(path, kind)


def _copy(source, target, kind, how=""):
    _read(source, kind, how)
    with atomic(target) as temporary:
        temporary.write_bytes(source.read_bytes())


def read_data(data=DATA):
    """The data beside the document."""
    data = Path(data)
    tables = {name: io.read(data / f"{name}.nc", name).to_dataframe() for name in TABLES}
    grown = read_table(data / "grown.nc")
    files = {drive: spun_up_files(data / "spun_up" / drive) for drive in (DRIVEN, PRINTED)}
    driven, printed = (spun_up_table(files[drive], grown) for drive in (DRIVEN, PRINTED))
    rules = data.parents[1] / MARK_RULES
    return Data(
        grown=ensemble.beside_print(grown),
        driven=ensemble.beside_print(driven),
        printed=ensemble.beside_print(printed),
        files=files,
        fragments={drive: spun_up_fragments(files[drive]) for drive in files},
        firm=io.read(data / "firm_bounds.nc", "firm_bounds").to_dataframe(),
        runs={name: read_runs(data / f"{name}.nc") for name in SHOWN_RUNS},
        grains=[grain for path in sorted((data / "figure1").glob("*.nc")) for grain in read_grains(path)],
        tables=tables,
        others={name: io.read(data / f"parameters_{name}.nc", "parameters").to_dataframe() for name in OTHERS},
        limits=read_limits(data / "static_limits"),
        pulled=read_pulled(data / "pulled"),
        shapes=read_shapes(data / "shapes"),
        studies=studies(data, files[DRIVEN], printed),
        lammps={name: pd.read_csv(data.parents[1] / path) for name, path in LAMMPS.items()},
        mark_rules=io.read(rules, "validation_mark_rules").to_dataframe() if rules.is_file() else None,
        scheme=pd.read_csv(data.parents[1] / SCHEME),
        pairs=[io.read(path, "pairs").to_dataframe() for path in sorted((data / "pairs").glob("*.nc"))],
    )


def findings(data, fits):
    """Values of the slots of both documents.

    Parameters
    ----------
    data : Data
    fits : dict of str to xarray.Dataset
        Drive -> fit of Eq. 33 to its grains, see `redraw`.

    Returns
    -------
    dict
        Name of a slot -> number or text.
    """
    values = {}
    for letter, table, drive in (("d", data.driven, DRIVEN), ("p", data.printed, PRINTED)):
        fragments = data.fragments[drive]
        values |= ensemble.of_drive(letter, table) | ensemble.of_table_3(letter, fits[drive])
        values |= claims.claims(letter, table, fragments) | of_shares(letter, fragments)
        values |= of_all_that_left(letter, data.runs[f"figure4/{drive}"])
    values |= of_law(data.driven) | ensemble.marks_compared(data.driven) | ensemble.table_3_by_mark(data.driven)
    values |= ensemble.what_contacts_hold(data.grown, data.firm, data.driven) | claims.grown_claims(data.grown)
    values |= beside.of_ways(data.tables["parameters"]) | beside.of_pairs(data.pairs) | beside.of_overlap()
    for material, table in data.others.items():
        values |= {f"{material} {name}": value for name, value in beside.of_ways(table).items()}
    values |= beside.of_formulae(data.tables["formulae"]) | beside.of_printed_twist()
    values |= of_curve(data.driven, data.grown) | of_prediction(data.driven) | of_exponents_apart(data.driven)
    values |= beside.composition_tables()
    values |= of_static_limits(data.limits, data.driven)
    values |= of_pulled(data.pulled, data.driven) | of_shapes(data.shapes)
    for letter, drive in (("d", DRIVEN), ("p", PRINTED)):
        values |= of_stretch(letter, data.files[drive])
        values[f"{letter}.states"] = len(set(np.concatenate([file["source"].values for file in data.files[drive]])))
    printed = load(*CONFIGS).config["literal"]
    pace = printed["angular_acceleration"], printed["timestep_factor"]
    values |= {"p.acceleration": pace[0], "p.step": pace[1]}
    values |= beside.of_printed_pairs(*pace)
    values |= beside.of_printed_pace(data.driven, data.printed, *pace)
    values |= beside.of_lammps(**data.lammps) | of_scheme(data.scheme)
    values |= of_studies(data.studies) | of_literature(data.driven, data.grown)
    values |= of_exponents(data.fragments[DRIVEN])
    values |= of_radiation(data.driven, data.grown, mark=MARK)
    values |= beside.of_heat(values["radiation.q-S BA 100 ours"].value * NM)
    if data.mark_rules is not None:
        values |= of_mark_rules(data.mark_rules)
    values["d.together"] = values["g.radius factor"] * math.prod(values[name].value for name in MOVES)
    values["d.BA 300 gap"] = 1.0 / values["d.BA 300"].value
    values["cells.quarter"] = ensemble.cell_medians(data.driven)
    values["cells.disr"] = ensemble.cell_medians(data.driven, "omega_disr")
    values["cells.printed"] = ensemble.cell_medians(data.printed, "omega_disr")
    return values


def figures(data, fits):
    """The figures of the document, a name and a figure each, of the same as `findings`."""
    plan = load(*CONFIGS)
    for drive, table in ((DRIVEN, data.driven), (PRINTED, data.printed)):
        six, eight = plan.figure("figure6", drive), plan.figure("figure8", drive)
        yield f"figure4_{drive}", figure4(data.runs[f"figure4/{drive}"], drive=drive)
        yield f"figure7_{drive}", figure7(table, fits[drive], drive=drive, grown=data.grown)
        if drive == DRIVEN:
            yield f"figure5_{drive}", figure5(data.runs[f"figure5/{drive}"][0], drive=drive)
            yield f"figure6_{drive}", figure6(table, six["material"], six["sizes"], drive=drive)
            shown = eight["material"], eight["type"]
            yield f"figure8_{drive}", figure8(table, *shown, drive=drive, grown=data.grown, fit=fits[drive])
    yield "overview", overview(data.driven, data.printed, data.firm, data.grown)
    yield "law", law(data.driven)
    yield "fragments", fragments(data.fragments[DRIVEN], drive=DRIVEN)
    yield "pulled", pulled(data.pulled, data.driven)
    yield "figure1", figure1(data.grains)
    yield "figure2", figure2(data.grown)
    yield "radiation", radiation(data.driven, data.grown)
    yield "figure9_prescribed", figure9(data.tables["parameters"])
    yield "figure10", figure10(pd.concat(data.pairs, ignore_index=True))


def redraw(folder=".", into=None):
    """Write the document, its appendix and the figures, into another folder where one is given."""
    folder = Path(folder)
    into = folder if into is None else Path(into)
    data = read_data(folder / DATA)
    tables = {DRIVEN: data.driven, PRINTED: data.printed}
    fits = {drive: fit_ensemble(table, PAPER_MEAN_RADIUS) for drive, table in tables.items()}
    for name, figure in figures(data, fits):
        save(figure, into / FIGURES / f"{name}.png")
    with atomic(into / DRIVEN_TABLE) as temporary:
        data.driven[list(TABLE_COLUMNS)].to_csv(temporary, index=False, float_format="%.6g")
    values = findings(data, fits)
    for template, document in DOCUMENTS.items():
        text = (folder / template).read_text(encoding="utf-8")
        write_text(into / document, fill(text, values, str(template)))


def main(words):
    """The command line; returns the exit code."""
    return command(words, __doc__, collect, redraw)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
