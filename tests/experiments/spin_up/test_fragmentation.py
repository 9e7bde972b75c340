"""Fragments up to disruption and up to half of the mass."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from ratd.experiments.spin_up.fragmentation import SIZE_CLASSES, fragmentation, size_class, spun_up_fragments
from ratd.experiments.spin_up.grain_table import spun_up_files

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


def file_of(rows, type="BA"):
    """A file of the queue as far as fragments go: of each row a_eff [m], seed, omega_disr and its (mass, omega)."""
    a_eff, seed, omega_disr, fragments = zip(*rows, strict=True)
    mass, omega = np.array([one for own in fragments for one in own], dtype=float).reshape(-1, 2).T
    return xr.Dataset(
        {
            "a_eff": ("row", list(a_eff)),
            "seed": ("row", list(seed)),
            "omega_disr": ("row", list(omega_disr)),
            "initial_mass": ("row", [10.0] * len(rows)),
            "initial_n_monomers": ("row", [20] * len(rows)),
            "row_size_fragment": ("row", [len(own) for own in fragments]),
            "fragment_mass": ("fragment", mass),
            "fragment_n_monomers": ("fragment", np.arange(1, len(mass) + 1)),
            "fragment_omega": ("fragment", omega),
        },
        attrs={"material": "q-S", "type": type},
    )


def test_the_table_tells_the_stages_of_each_grain_apart():
    rows = [
        (1e-7, 4, 5.5, [(1, 5), (3, 6), (2, 7)]),
        (1e-7, 5, 5.5, []),
        (1e-7, 6, 6.0, [(6, 5), (2, 6)]),
    ]
    table = spun_up_fragments([file_of(rows)])
    assert table["seed"].tolist() == [4, 4, 4, 6, 6] and table["grain"].tolist() == [0, 0, 0, 2, 2]
    assert table["mass_fraction"].tolist() == pytest.approx([0.1, 0.3, 0.2, 0.6, 0.2])
    assert table["disruption"].tolist() == [True, False, False, True, True]
    assert table["half"].tolist() == [True, True, True, True, False]
    assert (table["weight"] == 1).all() and (table["n_monomers"] == 20).all()
    # a cell of one grain counts as much as one of three, and grains of another file go on with the numbers
    table = spun_up_fragments([file_of([*rows, (5e-8, 7, 5.5, [(1, 5)])]), file_of([(1e-7, 4, 5.5, [(1, 5)])], "BAM1")])
    assert table["weight"].tolist() == pytest.approx([5 / 9] * 5 + [5 / 3] * 2)
    assert table["grain"].tolist() == [0, 0, 0, 2, 2, 3, 4] and table["type"].tolist() == ["BA"] * 6 + ["BAM1"]


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
