"""Collisions made again beside those that are committed."""

import pandas as pd
import pytest

from ratd.experiments.collision.again import CELL, COMPARED, beside, main
from ratd.experiments.collision.document_plan import run_files
from ratd.experiments.collision.tables import collision_table, read_collisions


@pytest.fixture(scope="module")
def committed():
    return collision_table(read_collisions([path for path in run_files() if "velocity/570nm.nc" in path]))


def test_what_is_the_same_and_what_is_not(committed):
    again = committed.head(4).copy()
    again.loc[again.index[1], "N_s"] += 1e-3
    again.loc[again.index[2], "timestep"] *= 0.5
    both = beside(again, committed)
    assert list(both["difference"]) == [0.0, pytest.approx(1e-3), 0.0]
    assert list(both) == [*CELL, "difference"] and not set(CELL) & set(COMPARED)


def test_a_collision_that_is_there_twice_is_refused(committed):
    with pytest.raises(pd.errors.MergeError):
        beside(committed.iloc[[0, 0]], committed)


def test_the_command(tmp_path, capsys):
    assert main([]) == 2 and "FOLDER" in capsys.readouterr().out
    assert main([str(tmp_path)]) == 1 and "has no collisions" in capsys.readouterr().err
    damaged = tmp_path / "collision" / "runs" / "velocity" / "570nm" / "sample_1" / "15mps_b0.nc"
    damaged.parent.mkdir(parents=True)
    damaged.write_text("")
    assert main([str(tmp_path)]) == 1
    said = capsys.readouterr()
    assert f"{damaged}: is damaged" in said.err and said.out == ""
