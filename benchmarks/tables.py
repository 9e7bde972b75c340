"""CSV files of results: written as a whole from rows that are dicts, and read for the report."""

import csv

import numpy as np
import pandas as pd

from ratd.pipeline.io import atomic


def read(path):
    """Rows of a CSV file, list of dict of str; empty where there is no file."""
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def write(path, rows):
    """Write rows, at least one, that all have the same keys; numbers with 6 digits.

    Parameters
    ----------
    path : pathlib.Path
    rows : list of dict
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    with atomic(path) as part, open(part, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{v:.6g}" if isinstance(v, float) else v for key, v in row.items()})


def frame(out, name):
    """A CSV file of the folder `out` as pandas.DataFrame, None where there is none."""
    path = out / f"{name}.csv"
    return pd.read_csv(path, keep_default_na=True) if path.exists() else None


def pair_ratios(case, code="LAMMPS"):
    """Another code over ratd for each pair of a case, (pairs,); empty without it."""
    both = case.pivot_table(index="pair", columns="code", values="ns_per_contact_step")
    return (both[code] / both["ratd"]).to_numpy() if code in both else np.empty(0)


def projected_range(row):
    """Core-hours [h], low and high, if all cells not run in full were off together by the scatter of those that were.

    None for both where nothing is known of the scatter.
    """
    scatter = row.full_to_projected_scatter
    if not np.isfinite(scatter):
        return None, None
    rest = (1.0 - row.part_run_in_full) * row.core_hours
    return tuple(row.core_hours - rest + rest * scatter**sign for sign in (-1, 1))


def markdown_table(header, rows):
    """A table in Markdown, str, from the texts of its header and of its rows."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)
