"""Tables 1 and 2."""

import numpy as np
import pytest

from ratd.experiments.spin_up import composition
from ratd.experiments.spin_up.composition import (
    TABLE_1_COLUMNS,
    TABLE_2_COLUMNS,
    rounding,
    table1,
    table2,
)
from ratd.pipeline import io


@pytest.mark.parametrize(("text", "half"), [("0.27", 0.005), ("169", 0.5), ("1.60", 0.005), ("0.2", 0.05)])
def test_rounding_is_half_of_the_last_digit(text, half):
    assert rounding(text) == pytest.approx(half)


def test_table1_counts_atoms():
    """By hand: per mole 0.82 Mg, 0.78 Fe, 1 Si, 3.6 O."""
    table = table1().set_index("ratio")
    expected = {"Mg/O": 0.82 / 3.6, "Si/O": 1 / 3.6, "Fe/O": 0.78 / 3.6, "Mg/Fe": 0.82 / 0.78, "(Mg+Fe)/Si": 1.6}
    assert table["abundance"].to_dict() == pytest.approx(expected)
    np.testing.assert_allclose(table["abundance"] / table["abundance_printed"], table["abundance_over_printed"])
    assert table.loc["Mg/O", "hensley_2021"] == 0.19 and np.isnan(table.loc["Si/O", "voshchinnikov_2010"])


def test_table2_has_what_is_used_and_what_is_printed_in_the_same_units():
    table = table2().set_index("material")
    others = table.drop(index="co-S")
    for name in composition.PROPERTIES:
        np.testing.assert_allclose(others[f"{name}_over_printed"], 1.0, rtol=1e-12)
    assert table.loc["co-S", "youngs_modulus"] == pytest.approx(168.24e9)
    assert table.loc["co-S", "youngs_modulus_printed"] == pytest.approx(169e9)
    assert table.loc["co-S", "density_over_printed"] == pytest.approx(3714.6 / 3707)
    assert table["mole_fraction"].sum() == pytest.approx(1.0)


def test_both_can_be_written_and_read(tmp_path):
    for kind, table, columns in (("table1", table1(), TABLE_1_COLUMNS), ("table2", table2(), TABLE_2_COLUMNS)):
        io.write(tmp_path / "a.nc", table.rename_axis("entry").to_xarray().drop_vars("entry"), kind)
        back = io.read(tmp_path / "a.nc", kind)
        assert list(back.variables) == list(columns)
        for name, (units, _) in columns.items():
            assert back[name].attrs.get("units", "") == units
            np.testing.assert_array_equal(back[name].values, table[name].to_numpy(back[name].dtype))
