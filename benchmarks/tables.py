"""CSV files of results: rows are dicts, a file is written as a whole."""

import csv

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
