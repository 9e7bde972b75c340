"""The same small grains spun up by this checkout and by another one: how the marks of disruption compare.

A child process with the other checkout on its path runs this file as a script, so nothing above `_spin_up` imports
anything but what both have.
"""

import json
import os
import subprocess
import sys
from itertools import islice, product
from pathlib import Path

import numpy as np

TYPES = ("BA", "BAM1", "BAM2")
MATERIALS = ("a-C", "q-S", "co-S")
SIZES = (50, 60, 70, 80, 90, 100)
"""Effective radii [nm], by turns."""
EPSILON = 0.3
"""(d omega/dt)/omega^2: without waiting, as every checkout can do it."""
MARKS = {"omega_first_loss": "first loss", "omega_mass_75": "25 % of the mass", "omega_disr": "omega_disr"}
QUANTITIES = MARKS | {"work": "work of the torque", "steps": "steps"}
"""What is compared: marks, which are told to an interval of the records, and what the whole run adds up to."""


def cases(number):
    """Type, material, size [nm] and seed of so many grains, list of tuple."""
    cells = product(range(number), TYPES, MATERIALS)
    return [
        (kind, material, SIZES[(seed + k) % len(SIZES)], seed)
        for k, (seed, kind, material) in enumerate(islice(cells, number))
    ]


def _spin_up(number):
    """Spin the grains up at a constant epsilon, a line of JSON each to the standard output."""
    import ratd

    for kind, material, size, seed in cases(number):
        grain = ratd.grow(kind, a_eff=size * 1e-9, material=material, seed=seed)
        run = ratd.spin_up(grain, epsilon=EPSILON)
        marks = ratd.disruption(run)
        row = {"grain": float(grain.position.sum()), "steps": int(run.attrs["steps"])}
        row["work"] = float(run["torque_work"][-1])
        print(json.dumps(row | {name: float(marks[name]) for name in MARKS}), flush=True)


def spun_up(checkout, number, say):
    """Rows of the grains, list of dict, spun up by a checkout of the repository in a process of its own."""
    environment = os.environ | {"PYTHONPATH": str(Path(checkout) / "src")}
    # -P: this folder has modules with names of the standard library
    command = [sys.executable, "-P", __file__, str(number)]
    rows = []
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as child:
        for line in child.stdout:
            rows.append(json.loads(line))
            if len(rows) % 20 == 0:
                say(f"agreement: {len(rows)} of {number} grains in {checkout}")
    if child.returncode:
        raise RuntimeError(f"the spin-ups in {checkout} ended with {child.returncode}")
    return rows


def compare(here, there):
    """How marks and sums compare, grain by grain.

    Parameters
    ----------
    here, there : list of dict
        From `spun_up`.

    Returns
    -------
    list of dict
        A row a quantity: how many grains have it in both, in how many it is the same number; of the ratio here/there
        the median, the mean and the standard deviation of its logarithm, the least and the greatest.
    """
    if [row["grain"] for row in here] != [row["grain"] for row in there]:
        raise RuntimeError("the two checkouts do not grow the same grains")
    found = []
    for mark, name in QUANTITIES.items():
        ratio = np.array([a[mark] / b[mark] for a, b in zip(here, there, strict=True)])
        ratio = ratio[np.isfinite(ratio)]
        scatter = 100.0 * np.log(ratio).std(ddof=1)
        found.append(
            {
                "": name,
                "grains": len(ratio),
                "the same": int((ratio == 1.0).sum()),
                "median ratio": float(np.median(ratio)),
                "mean ratio": float(np.exp(np.log(ratio).mean())),
                "its error [%]": scatter / np.sqrt(len(ratio)),
                "scatter [%]": scatter,
                "least": float(ratio.min()),
                "greatest": float(ratio.max()),
            }
        )
    return found


def main(before, number, root, say):
    """Spin up, compare and print a table."""
    from benchmarks.tables import markdown_table

    found = compare(spun_up(root, number, say), spun_up(before, number, say))
    rows = [[f"{value:.6g}" if isinstance(value, float) else value for value in row.values()] for row in found]
    print(markdown_table(list(found[0]), rows))


if __name__ == "__main__":
    _spin_up(int(sys.argv[1]))
