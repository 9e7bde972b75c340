"""Compressions made again beside those that are committed."""

import shutil

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.experiments.compression import again
from ratd.experiments.compression.document import DATA
from ratd.pipeline import io
from tiny_pipeline import ROOT

SETS = ROOT / DATA / "sets"


@pytest.fixture
def committed():
    return io.read(SETS / "rate_1e-5.nc", "compression_set").load()


def test_what_is_the_same_and_what_is_not(committed):
    other = committed.copy(deep=True)
    seeds = committed["seed"].values
    other["seed"].values[0] = 999
    last = np.flatnonzero(np.isfinite(other["pressure"].values[1]))[-1]
    other["pressure"].values[1, last] *= 1.001
    found = again.beside(other, committed)
    assert list(found) == sorted(seeds[1:])
    assert {seed for seed, difference in found.items() if difference > 0.0} == {seeds[1]}
    # a table that begins later and ends earlier
    assert again.beside(other.isel(phi_bin=slice(7, -5)), committed).keys() == found.keys()
    other["phi"].values[3] *= 1.01
    with pytest.raises(InputError, match="other bins"):
        again.beside(other, committed)


def test_the_command(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert again.main([]) == 2 and "FOLDER" in capsys.readouterr().out
    assert again.main([str(tmp_path)]) == 1 and "has no sets" in capsys.readouterr().err
    (tmp_path / "compression").mkdir()
    shutil.copy(SETS / "rate_1e-5.nc", tmp_path / "compression")
    assert again.main([str(tmp_path)]) == 0 and "5 clusters in both, 5 of them" in capsys.readouterr().out
    shutil.copy(SETS / "rate_1e-5.nc", tmp_path / "compression" / "rate_1e-6.nc")
    assert again.main([str(tmp_path)]) == 1 and "differs by up to" in capsys.readouterr().out
    (tmp_path / "compression" / "rate_1e-6.nc").write_text("")
    assert again.main([str(tmp_path)]) == 1 and "rate_1e-6.nc: is damaged" in capsys.readouterr().err
