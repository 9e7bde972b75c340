"""A loaded cluster in a box at rest, and what LAMMPS does with a contact that passes a face of the box."""

import numpy as np
import pandas as pd
import pytest

from peer import need_lammps
from ratd.aggregates.clusters import grow_bcca
from ratd.experiments.compression.beside_lammps import of_box
from ratd.experiments.compression.run import Cluster
from ratd.pipeline import io
from ratd.validation import box_at_rest
from ratd.validation.lammps_box import BoxInLammps
from ratd.validation.tables import as_dataset

SMALL = {
    "material": "ice", "n": 64, "seed": 1, "strain_rate": 2e-5, "squeezed": 1.3, "duration": 4000, "records": 8,
    "timestep_factor": 0.14, "lammps_step": 0.1,
}  # fmt: skip


@pytest.fixture(scope="module")
def rows():
    need_lammps()
    said = []
    found = box_at_rest.compute(SMALL, said.append)
    assert [line.split(":")[0] for line in said] == ["ratd", "LAMMPS", "LAMMPS anew"]
    return found


def test_there_is_no_more_motion_than_the_springs_hold(rows):
    found = of_box(pd.DataFrame(rows))
    assert found["box.n"] == 1 and found["box.N"] == 64
    assert found["box.gap"] < 0.01
    for code in ("ratd", "LAMMPS"):
        assert 0.0 < found[f"box.{code} least"] == found[f"box.{code} most"] < 1.0
    # the codes move alike
    assert found["box.apart"] < 0.1
    assert found["box.LAMMPS anew least"] > 3.0


def test_rows_make_a_file_of_the_check(rows, tmp_path):
    io.write(tmp_path / "a.nc", as_dataset(rows, box_at_rest.KIND), box_at_rest.KIND)
    assert io.read(tmp_path / "a.nc", box_at_rest.KIND).sizes["case"] == len(rows) == 24


def spins(shortest, drift):
    """Spins of a pair that rolls and twists while it drifts through a face of its box, (records, 2, 3)."""
    pair = grow_bcca(2, "ice", 0)
    time_unit, radius = Cluster(pair).time_unit, float(pair.radius[0])
    found = []
    with BoxInLammps(pair, 20.0 * radius, 0.0, 0.1 * time_unit, shortest) as box:
        number = box._atoms("id").copy()
        spin = np.array([[1e-4, 2e-4, 3e-4], [-2e-4, 1e-4, -1e-4]]) / time_unit
        for k in range(2):
            box._atoms("omega")[k] = spin[number[k] - 1]
            box._atoms("v")[k] = drift * radius / time_unit, 0.0, 0.0
        for _ in range(6):
            box.advance(2000)
            found.append(box._atoms("omega")[np.argsort(box._atoms("id"))] * time_unit)
    return np.array(found)


def test_lammps_turns_springs_round_where_its_lists_are_made_anew():
    """A uniform drift changes nothing; if this fails, LAMMPS is mended and its lists need not be kept any more."""
    need_lammps()
    length = 20.0 * float(grow_bcca(2, "ice", 0).radius[0])
    at_rest = spins(None, 0.0)
    np.testing.assert_allclose(spins(length, 0.0), at_rest, atol=1e-9)
    # through the face after 1000 t_0, which is the fifth record
    kept, anew = spins(length, 0.01), spins(None, 0.01)
    np.testing.assert_allclose(kept, at_rest, atol=1e-7)
    np.testing.assert_allclose(anew[:4], at_rest[:4], atol=1e-7)
    assert np.abs(anew[5] - at_rest[5]).max() > np.abs(at_rest[0]).max()
