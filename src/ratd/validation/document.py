"""docs/validation.md, its figures and its tables of numbers, drawn from the tables of the checks beside them.

python -m ratd.validation.document collect RESULTS    take the pieces that are there, such as of results/validation/full
python -m ratd.validation.document redraw             figures, tables and text, in seconds
"""

import json
import sys
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd

from ratd.base.errors import FileError
from ratd.experiments.spin_up.findings.beside import NEAR_LAMMPS
from ratd.pictures.style import save
from ratd.pipeline import io
from ratd.pipeline.atomic import write_text
from ratd.pipeline.documents import command, fill
from ratd.validation import (
    figures,
    findings,
    growth_findings,
    lammps_findings,
    lammps_single,
    lammps_spin_up,
    quasi_static_document,
)
from ratd.validation.tables import CASE, as_dataset

__all__ = ["collect", "main", "read_data", "redraw", "values"]

DATA = Path("docs/validation/data")
FIGURES = Path("docs/validation")
TEMPLATE = Path("docs/templates/validation.md")
DOCUMENT = Path("docs/validation.md")
CHECKS = (
    "pull_off", "lammps", "forces", "frames", "energy_step", "energy", "relaxation", "growth", "theory", "damping",
    "literal", "compression", "dense", "box_at_rest", "collision_step",
)  # fmt: skip
"""One file each, with a row a case."""
ELSEWHERE = ("mark_rules", "spring_back")
"""Checks whose table another page tells of."""
MADE = ("settings_hash", "code_hash", "versions")
"""What a table keeps of each of its pieces."""
COMPRESSION = "docs/compression/data/sets/*.nc"
COLLISION = "docs/collision/data/*/*.nc"
"""Production runs whose balance of energy is told."""
FROM_PHI = 0.1
"""A balance of a compression is told from this filling factor on, where the box has done work."""


def collect(results, folder="."):
    """Take the pieces of the checks that a folder of results has.

    Parameters
    ----------
    results : path-like
        Such as ``results/validation/full``.
    folder : path-like
        Where the project is.

    Raises
    ------
    FileError
        If there is no piece.
    """
    folder = Path(folder)
    found = {check: sorted(Path(results, check).glob("*.nc")) for check in (*CHECKS, *ELSEWHERE)}
    if not any(found.values()):
        raise FileError(f"{results}: holds no piece of a check; `snakemake --cores 2 {results}/energy.csv` makes some")
    for check, paths in found.items():
        if paths:
            kind, target = f"validation_{check}", folder / DATA / f"{check}.nc"
            io.write(target, merged(target, paths, kind), kind)


def merged(target, paths, kind):
    """The table of a check with some pieces more, or in place of those of the same names.

    Parameters
    ----------
    target : path-like
        The table as it is, if there is one. It names its pieces in ``pieces``: for each the name, the number of cases,
        and with which settings, source and versions it was made.
    paths : list of path-like
        Files of pieces.
    kind : str
        From `ratd.validation.tables.table_kind`.

    Returns
    -------
    xarray.Dataset
    """
    parts = {}
    if Path(target).is_file():
        old, first = io.read(target, kind), 0
        for name, cases, made in json.loads(old.attrs["pieces"]):
            parts[name] = old.isel({CASE: slice(first, first + cases)}), made
            first += cases
    for path in paths:
        piece = io.read(path, kind)
        parts[Path(path).stem] = piece, {name: str(piece.attrs[name]) for name in MADE}
    rows = pd.concat([part.to_dataframe() for part, _ in parts.values()]).to_dict("records")
    pieces = [[name, part.sizes[CASE], made] for name, (part, made) in parts.items()]
    return as_dataset(rows, kind).assign_attrs(pieces=json.dumps(pieces))


def balance(folder):
    """What the balance of energy lacks at most in production runs.

    Parameters
    ----------
    folder : path-like
        Of the project.

    Returns
    -------
    pandas.DataFrame
        experiment, set, runs, worst: over the work of the box, from `FROM_PHI` on, or over the energy of the impact.
    """
    rows = []
    for path in sorted(Path(folder).glob(COMPRESSION)):
        table = io.read(path, "compression_set")
        explicit = table.attrs["integrator"].startswith("Leapfrog")
        part = np.abs(table["energy_residual"].values / table["work"].values)[:, table["phi"].values > FROM_PHI]
        if part.size == 0:
            continue
        name = "compression" if explicit else "long steps"
        rows.append({"experiment": name, "set": path.stem, "runs": len(part), "worst": np.nanmax(part)})
    collisions = pd.concat(
        io.read(path, "collisions")[["friction", "balance"]].to_dataframe()
        for path in sorted(Path(folder).glob(COLLISION))
        if path.parent.name != "pictures"
    )
    for friction, part in collisions.groupby("friction"):
        name = "springs" if friction == "spring" else "collision"
        rows.append({"experiment": name, "set": friction, "runs": len(part), "worst": part["balance"].max()})
    return pd.DataFrame(rows)


def read_data(folder="."):
    """The tables behind the page, name of a check -> pandas.DataFrame."""
    data = Path(folder, DATA)
    tables = {check: io.read(data / f"{check}.nc", f"validation_{check}").to_dataframe() for check in CHECKS}
    tables["lammps_spin_up"] = lammps_spin_up.thresholds(Path(folder, lammps_spin_up.DATA), tables["lammps"])
    one_each = lammps_spin_up.one_each(tables["lammps_spin_up"])
    tables["lammps_single"] = lammps_single.beside(Path(folder, lammps_single.DATA), one_each)
    scheme = Path(folder, quasi_static_document.DATA)
    return (
        tables
        | {name: pd.read_csv(data / f"{name}.csv") for name in ("reference", "growth_reference")}
        | {"balance": balance(folder)}
        | {name: pd.read_csv(scheme / f"{name}.csv") for name in quasi_static_document.CHECKS}
    )


def values(tables):
    """Values of the slots, from what `read_data` gives: name of a slot -> number or text."""
    elsewhere = {
        "lammps": lammps_findings.of_lammps,
        "growth": partial(growth_findings.of_growth, reference=tables["growth_reference"]),
    }
    found = {}
    for check in (*CHECKS, "reference", "balance"):
        of = elsewhere[check] if check in elsewhere else getattr(findings, f"of_{check}")
        found |= of(tables[check])
    found |= lammps_spin_up.findings(tables["lammps_spin_up"])
    found |= lammps_single.findings(tables["lammps_single"])
    scheme = quasi_static_document.findings(tables["quasi_static"], tables["remnant"])
    found |= {f"scheme.{name}": value for name, value in scheme.items()}
    found["scheme.all verdict"] = "met" if scheme["classes omega_mass_75"] == scheme["all classes"] else "missed"
    quarter = [found["lammps_spin_up.all quarter"]]
    found["lammps_spin_up.quarter verdict"] = findings.decided(quarter, lammps_spin_up.NEAR)
    found["scheme.DMT over JKR"] = np.sqrt(4.0 / 3.0)
    found |= {"limit.near": NEAR_LAMMPS, "limit.force": lammps_findings.FORCE}
    return found | findings.limits()


def numbers(tables):
    """The tables of the page that are too long for it, name -> pandas.DataFrame."""
    pairs = findings.off_the_answer(tables["pull_off"])
    pairs["radii"] = np.where(pairs["radius_1"] == pairs["radius_2"], "equal", "unequal")
    pairs = pairs.groupby(["material", "start", "radii"])["off"].agg(["size", "median", "min", "max"]).reset_index()
    damping = tables["damping"]
    times = pd.concat(
        findings.ratios(part, mark, (9, 5), ["damping", "epsilon", "timestep_factor"]).assign(study=study, mark=mark)
        for study, part in damping.groupby("study")
        for mark in ("omega_first_loss", "omega_mass_75", "omega_disr")
    )
    keys = ["study", "mark", "type", "damping", "epsilon", "timestep_factor"]
    return {
        "pull_off": pairs,
        "lammps": lammps_findings.thresholds(tables["lammps"]),
        "lammps_spin_up": lammps_spin_up.one_each(tables["lammps_spin_up"]),
        "lammps_single": tables["lammps_single"],
        "growth": pd.DataFrame(growth_findings.grown(tables["growth"], tables["growth_reference"])),
        "migration": pd.DataFrame(growth_findings.migrations(tables["growth"])),
        "energy": findings.balances(tables["energy"]),
        "theory": tables["theory"],
        "damping": times.groupby(keys, dropna=False)["ratio"].agg(["size", "median", "min", "max"]).reset_index(),
        "literal": findings.runs_of_solid_grains(tables["literal"]),
    }


def redraw(folder=".", into=None):
    """Write the page, its figures and its tables of numbers, into another folder where one is given."""
    folder = Path(folder)
    into = folder if into is None else Path(into)
    tables = read_data(folder)
    drawn = {
        "pull_off": figures.apart(tables["pull_off"]),
        "lammps": lammps_findings.beside(tables["lammps"], lammps_spin_up.one_each(tables["lammps_spin_up"])),
        "steps": figures.steps(tables["energy_step"], tables["frames"]),
        "theory": figures.bounds(tables["theory"]),
        "damping": figures.viscous_time(tables["damping"]),
        "literal": figures.late_coriolis(tables["literal"]),
    }
    for name, figure in drawn.items():
        save(figure, into / FIGURES / f"{name}.png")
    for name, table in numbers(tables).items():
        write_text(into / DATA / "tables" / f"{name}.csv", table.to_csv(index=False, float_format="%.5g"))
    template = (folder / TEMPLATE).read_text(encoding="utf-8")
    write_text(into / DOCUMENT, fill(template, values(tables), str(TEMPLATE)))


def main(words):
    """The command line; returns the exit code."""
    return command(words, __doc__, collect, redraw)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
