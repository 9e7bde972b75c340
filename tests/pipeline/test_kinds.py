"""The registry of kinds of files, and the check of datasets against it."""

import numpy as np
import pytest

from files import make_grain, make_run
from ratd.aggregates import files as grain_files
from ratd.base.errors import FileError, InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up import grain_table, marks, run_files
from ratd.pipeline import blocks, io, kinds

SI = {
    "1",
    "m",
    "m2",
    "s",
    "m s-1",
    "kg",
    "kg m2",
    "kg m2 s-1",
    "kg m-3",
    "J",
    "J m-2",
    "N",
    "Pa",
    "rad",
    "rad s-1",
    "rad s-2",
}
EVERY_VARIABLE = [(kind, name) for kind in kinds.HOMES for name in kinds.kind_of(kind).variables]


def test_every_variable_has_a_meaning_and_si_units():
    for kind, name in EVERY_VARIABLE:
        variable = kinds.kind_of(kind).variables[name]
        assert variable.long_name, (kind, name)
        assert variable.dtype in ("f8", "i8", "u8", "i4", "i1", "str"), (kind, name)
        is_number = variable.dtype != "str" and not variable.flags
        assert (variable.units in SI) if is_number else (variable.units == ""), (kind, name)


@pytest.mark.parametrize("kind", kinds.HOMES)
def test_sample_dimensions_have_row_sizes_and_no_others(kind):
    layout = kinds.kind_of(kind)
    sizes = {name.removeprefix("row_size_") for name in layout.variables if name.startswith("row_size_")}
    assert sizes == set(layout.ragged)
    used = {dimension for variable in layout.variables.values() for dimension in variable.dims}
    assert set(layout.ragged) <= used


def test_one_name_has_one_unit_in_all_files_of_an_experiment():
    units = {}
    for kind, name in EVERY_VARIABLE:
        # columns of a check are its own
        if kind.startswith("validation_"):
            continue
        experiment = kinds.HOMES[kind].rpartition(".")[0]
        units.setdefault((experiment, name), set()).add(kinds.kind_of(kind).variables[name].units)
    assert {name: found for name, found in units.items() if len(found) > 1} == {}


def test_files_hold_all_that_disruption_and_ensemble_give():
    assert set(marks.VARIABLES) <= set(kinds.kind_of("disruption").variables)
    assert set(grain_table.COLUMNS) == set(kinds.kind_of("table").variables)
    # what follows from others, or is computed from the monomers when a file is read
    follows = {"material", "type", "filling_factor", "spin_share"}
    needed_of_a_grain = set(grain_table.GRAIN_COLUMNS) - follows
    assert needed_of_a_grain <= set(kinds.kind_of("grains").variables)


def test_an_unknown_kind_is_named():
    with pytest.raises(InputError, match="'spin' is no kind of file; allowed: built_clusters, calibration"):
        kinds.kind_of("spin")


def test_fingerprint_changes_with_its_own_kind_only(monkeypatch):
    before = {kind: kinds.fingerprint(kind) for kind in kinds.HOMES}
    assert len(set(before.values())) == len(before)
    variable = kinds.Variable((kinds.ROW,), "f8", "m", "a new one")
    monkeypatch.setitem(kinds.kind_of("disruption").variables, "new", variable)
    after = {kind: kinds.fingerprint(kind) for kind in kinds.HOMES}
    assert {kind for kind in before if before[kind] != after[kind]} == {"disruption"}


@pytest.fixture
def block(tmp_path):
    rows = [run_files.run_row(make_run(seed)) for seed in range(2)]
    path = tmp_path / "runs.nc"
    io.write(path, blocks.block(rows, "spinup", MATERIALS["q-S"]), "spinup")
    return io.read(path, "spinup")


def test_a_right_dataset_passes(block):
    kinds.check(block, "spinup", "here")


def with_values(block, name, values):
    block[name] = (block[name].dims, values, block[name].attrs)
    return block


def wrong_units(block):
    block["omega"].attrs["units"] = "Hz"
    return block


def without_attribute(block):
    del block.attrs["drive"]
    return block


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda b: b.drop_vars("omega"), "the variable 'omega' of a file of spinup is missing"),
        (lambda b: b.assign(more=("row", [1.0, 2.0])), "has no variable 'more'"),
        (lambda b: b.rename_dims(record="entry"), "'omega' has the dimensions ('entry',), but must have ('record',)"),
        (lambda b: with_values(b, "omega", b["omega"].values.astype("f4")), "'omega' is of type float32"),
        (lambda b: with_values(b, "steps", b["steps"].values.astype("i4")), "'steps' is of type int32"),
        (wrong_units, "'omega' has the units 'Hz', but must have 'rad s-1'"),
        (lambda b: with_values(b, "omega", b["omega"].values * np.nan), "'omega' holds values that are not finite"),
        (lambda b: with_values(b, "omega", b["omega"].values * np.inf), "'omega' holds values that are not finite"),
        (lambda b: with_values(b, "end_reason", np.array([0, 9], "i1")), "'end_reason' holds a flag"),
        (lambda b: with_values(b, "row_size_record", np.array([1, 2])), "row sizes along 'record' add up to 3"),
        (lambda b: with_values(b, "row_size_record", np.array([-1, 9])), "row sizes along 'record'"),
        (without_attribute, "the attribute 'drive'"),
    ],
)
def test_what_is_wrong_is_named(block, change, said):
    with pytest.raises(FileError) as error:
        kinds.check(change(block), "spinup", "some/file.nc")
    assert said in str(error.value)
    assert str(error.value).startswith("some/file.nc: ") and "\n" not in str(error.value)


def test_nan_passes_where_it_is_allowed():
    grain = make_grain(n=3)
    assert np.isnan(grain.shape.fractal_dimension)
    row = grain_files.grain_row(grain, 1e8)
    assert np.isnan(row["fractal_dimension"])
    assert blocks.block([row], "grains", MATERIALS["q-S"])["fractal_dimension"].isnull().all()
