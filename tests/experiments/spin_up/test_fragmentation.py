"""Fragments up to disruption and up to half of the mass."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.base.errors import InputError
from ratd.experiments.spin_up.fragmentation import (
    COLUMNS,
    SIZE_CLASSES,
    fragment_table,
    fragmentation,
    join,
    size_class,
    spun_up_fragments,
)
from ratd.experiments.spin_up.grain_table import spun_up_files
from ratd.pipeline import io, kinds

SPUN_UP = Path("docs/reproduction/data/spun_up/prescribed/q-S_BAM1.nc")


def run_and_mark(mass, omega, omega_disr, seed=0):
    run = xr.Dataset(
        {
            "fragment_mass": ("fragment", np.array(mass, dtype=float)),
            "fragment_n_monomers": ("fragment", np.arange(1, len(mass) + 1, dtype="i4")),
            "fragment_omega": ("fragment", np.array(omega, dtype=float)),
        },
        attrs={"material": "q-S", "type": "BA", "a_eff": 1e-7, "seed": seed, "initial_mass": 10.0},
    )
    return run, xr.Dataset({"omega_disr": omega_disr, "mass_fraction_disr": 0.9})


def test_fragments_are_kept_until_half_of_the_mass_has_left():
    row = fragmentation(*run_and_mark([1, 3, 2, 1, 1], [5, 6, 7, 8, 9], omega_disr=5.5))
    assert row["fragment_mass"].values.tolist() == [1, 3, 2]


def test_fragments_are_kept_up_to_disruption_where_that_is_later():
    row = fragmentation(*run_and_mark([3, 3, 2, 1, 1], [5, 6, 7, 8, 9], omega_disr=8))
    assert row["fragment_omega"].values.tolist() == [5, 6, 7, 8]


def test_fragments_stand_in_the_order_of_leaving():
    row = fragmentation(*run_and_mark([1, 2, 3], [7, 5, 6], omega_disr=np.nan))
    assert row["fragment_n_monomers"].values.tolist() == [2, 3]


def test_the_table_tells_the_stages_of_each_grain_apart():
    rows = [
        fragmentation(*run_and_mark([1, 3, 2, 1], [5, 6, 7, 8], 5.5, seed=4)),
        fragmentation(*run_and_mark([], [], 5.5, seed=5)),
        fragmentation(*run_and_mark([6, 2], [5, 6], 6.0, seed=6)),
    ]
    table = fragment_table(join(rows))
    assert table["seed"].tolist() == [4, 4, 4, 6, 6] and table["grain"].tolist() == [0, 0, 0, 2, 2]
    assert table["mass_fraction"].tolist() == pytest.approx([0.1, 0.3, 0.2, 0.6, 0.2])
    assert table["disruption"].tolist() == [True, False, False, True, True]
    assert table["half"].tolist() == [True, True, True, True, False]
    assert (table["weight"] == 1).all()
    other = fragmentation(*run_and_mark([1], [5], 5.5, seed=7)).assign(a_eff=5e-8)
    assert fragment_table(join([*rows, other]))["weight"].tolist() == pytest.approx([2 / 3] * 5 + [2])
    with pytest.raises(InputError, match="at least one grain"):
        join([])


def test_a_file_gives_back_what_was_written(tmp_path):
    rows = [
        fragmentation(*run_and_mark([1, 3], [5, 6], omega_disr, seed)) for seed, omega_disr in ((1, 5.5), (2, np.nan))
    ]
    dataset = join(rows).assign_attrs(drive="literal")
    io.write(tmp_path / "fragments.nc", dataset, "fragments")
    found = io.read(tmp_path / "fragments.nc", "fragments")
    assert set(COLUMNS) < set(kinds.kind_of("fragments").variables)
    for name in dataset.variables:
        np.testing.assert_array_equal(found[name].values, dataset[name].values)


def test_fragments_of_the_queue_are_read(tmp_path):
    shutil.copy(SPUN_UP, tmp_path)
    (file,) = spun_up_files(tmp_path)
    table = spun_up_fragments([file])
    assert len(table) == file.sizes["fragment"] and table["grain"].max() + 1 == file.sizes["row"]
    np.testing.assert_allclose(table["fragment_mass"].sum(), file["fragment_mass"].values.sum())
    gone = table[table["half"]].groupby("grain")["mass_fraction"].sum()
    assert (gone <= 1).all() and (gone[table.groupby("grain")["mass_fraction"].sum() >= 0.5] >= 0.5).all()


def test_classes_of_size_have_the_names_of_their_sizes():
    nm = np.arange(50, 551, 50)
    found = size_class(pd.Series(nm * 1e-9))
    for name in SIZE_CLASSES:
        first, last = (int(word) for word in name.removesuffix(" nm").split(" to "))
        assert nm[found == name].tolist() == list(range(first, last + 1, 50))
