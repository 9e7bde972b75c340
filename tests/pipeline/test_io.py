"""Files: whole or not there, the same bytes each time, and never mistaken for another."""

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from files import grains_file, make_grain, make_run, runs_file
from ratd.aggregates import files as grain_files
from ratd.base.errors import FileError, InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up import run_files
from ratd.experiments.spin_up.cells import cell_statistics
from ratd.experiments.spin_up.eq33 import fit_ensemble, table3_dataset
from ratd.experiments.spin_up.grain_table import grain_table, table_dataset
from ratd.experiments.spin_up.run import spin_up
from ratd.experiments.spin_up.tables import read_grain_columns
from ratd.pipeline import blocks, io, kinds

HERE = Path(__file__).parents[1]
"""Where the helpers of the tests are."""


def run_python(source, *arguments, **environment):
    """Run source in another process that can import what the tests import."""
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(source), *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(HERE), os.environ.get("PYTHONPATH", "")])} | environment,
        capture_output=True,
        text=True,
        timeout=100,
    )


def test_grains_come_back_bit_for_bit(tmp_path):
    written = grains_file(tmp_path / "grains.nc")
    read = grain_files.read_grains(tmp_path / "grains.nc")
    assert [grain.n_monomers for grain in read] == [3, 4, 5]
    for old, new in zip(written, read, strict=True):
        assert np.array_equal(old.position, new.position) and np.array_equal(old.radius, new.radius)
        assert (old.material, old.type, old.seed, old.a_eff) == (new.material, new.type, new.seed, new.a_eff)
    columns = grain_table(read_grain_columns(tmp_path / "grains.nc"))["spin_share"]
    np.testing.assert_allclose(columns, grain_table(written)["spin_share"], rtol=1e-12)


def test_a_material_of_the_user_comes_back(tmp_path):
    material = MATERIALS["q-S"].__class__("ice", 0.1, 7e9, 0.25, 1000.0, 0.3e-9, 4e-12)
    grain = make_grain()
    grain.material = material
    io.write(tmp_path / "g.nc", blocks.block([grain_files.grain_row(grain, 1e8)], "grains", material), "grains")
    assert blocks.material_of(io.read(tmp_path / "g.nc", "grains")) == material


def test_runs_of_different_length_come_back_the_same(tmp_path):
    written = runs_file(tmp_path / "runs.nc")
    read = run_files.read_runs(tmp_path / "runs.nc")
    assert len(read) == 3
    for old, new in zip(written, read, strict=True):
        np.testing.assert_equal(new.attrs, old.attrs)
        xr.testing.assert_identical(new, old)
    assert read[1].sizes["snapshot"] == 2 and "snapshot" not in read[0].dims


@pytest.mark.parametrize("snapshot_every", [0, 50])
def test_a_real_run_comes_back_the_same(tmp_path, snapshot_every):
    run = spin_up(make_grain(n=4), epsilon=1.0, records=20, snapshot_every=snapshot_every)
    io.write(tmp_path / "runs.nc", blocks.block([run_files.run_row(run)], "spinup", MATERIALS["q-S"]), "spinup")
    (read,) = run_files.read_runs(tmp_path / "runs.nc")
    np.testing.assert_equal(read.attrs, run.attrs)
    xr.testing.assert_identical(read, run)


def test_what_is_not_finite_comes_back_where_it_is_allowed(tmp_path):
    run = make_run()
    run["porosity"][1] = np.nan
    io.write(tmp_path / "runs.nc", blocks.block([run_files.run_row(run)], "spinup", MATERIALS["q-S"]), "spinup")
    assert np.isnan(run_files.read_runs(tmp_path / "runs.nc")[0]["porosity"].values).tolist() == [
        False,
        True,
        False,
        False,
    ]


def test_table_cells_and_fit_come_back(tmp_path):
    grains = [grain_files.grain_row(make_grain(seed, n=4 + seed), 1e8).drop_dims("monomer") for seed in range(4)]
    table = grain_table(grains)
    table["omega_disr"] = [1e8, 1.1e8, 1.2e8, 0.9e8]
    table["missing_marks"] = ["", "γ: none", "", ""]
    cells = cell_statistics(table)
    fit = table3_dataset(fit_ensemble(table, n_bootstrap=5))
    for kind, dataset in (
        ("table", table_dataset(table)),
        ("cells", table_dataset(cells, "cell")),
        ("fit", fit),
    ):
        io.write(tmp_path / f"{kind}.nc", dataset, kind)
    read = run_files.read_table(tmp_path / "table.nc")
    assert read["missing_marks"].tolist() == table["missing_marks"].tolist()
    assert read["omega_disr"].tolist() == table["omega_disr"].tolist()
    assert read["seed"].tolist() == table["seed"].tolist()
    assert run_files.read_fit(tmp_path / "fit.nc")["A"].equals(fit["A"])
    assert len(io.read(tmp_path / "cells.nc", "cells")["a_eff"]) == len(cells)


def test_files_follow_the_conventions_they_name(tmp_path):
    runs_file(tmp_path / "runs.nc")
    with xr.open_dataset(tmp_path / "runs.nc", decode_cf=False) as file:
        assert file.attrs["Conventions"] == "CF-1.11"
        for name in ("title", "source", "references"):
            assert file.attrs[name]
        for name, array in file.variables.items():
            assert array.attrs["long_name"], name
            assert "units" in array.attrs or "flag_meanings" in array.attrs, name
        assert file["row_size_record"].attrs["sample_dimension"] == "record"
        assert file["row_size_record"].values.sum() == file.sizes["record"]
        assert file["end_reason"].attrs["flag_meanings"].split()[0] == "one_contact_left"


def test_same_content_gives_the_same_bytes_in_every_process(tmp_path):
    source = """
        import sys
        from files import grains_file, runs_file
        runs_file(sys.argv[1])
        grains_file(sys.argv[2])
    """
    for number in "12":
        done = run_python(source, tmp_path / f"r{number}", tmp_path / f"g{number}", PYTHONHASHSEED=number)
        assert done.returncode == 0, done.stderr
    runs_file(tmp_path / "r3")
    grains_file(tmp_path / "g3")
    for letter in "rg":
        assert len({(tmp_path / f"{letter}{number}").read_bytes() for number in "123"}) == 1


def test_nothing_in_a_file_tells_time_or_place(tmp_path):
    grains_file(tmp_path / "grains.nc")
    content = (tmp_path / "grains.nc").read_bytes()
    for word in (str(tmp_path), os.uname().nodename, os.environ.get("USER", "no user")):
        assert word.encode() not in content or len(word) < 4


def test_failure_in_the_middle_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "file"
    path.write_text("old")
    with pytest.raises(ZeroDivisionError), io.atomic(path) as temporary:
        temporary.write_text("new")
        1 / 0  # noqa: B018
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]
    io.write_text(path, "new")
    assert path.read_text() == "new" and list(tmp_path.iterdir()) == [path]


def test_full_disk_leaves_the_old_file_and_one_sentence(tmp_path):
    # a limit on the size of files stands in for the disk: writing fails at the same place
    source = """
        import resource, signal, sys
        from files import runs_file
        from ratd.base.errors import FileError
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (8192, 8192))
        try:
            runs_file(sys.argv[1])
        except FileError as error:
            sys.exit(f"FileError: {error}")
    """
    path = tmp_path / "runs.nc"
    runs_file(path)
    old = path.read_bytes()
    done = run_python(source, path)
    assert done.returncode == 1
    assert f"FileError: {path}: cannot be written" in done.stderr
    assert path.read_bytes() == old and list(tmp_path.iterdir()) == [path]


def test_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="file/below.nc: cannot be written"):
        grains_file(tmp_path / "file" / "below.nc")


def test_what_killed_processes_left_is_removed_and_what_live_ones_write_is_not(tmp_path):
    process = subprocess.Popen([sys.executable, "-c", "pass"])
    process.wait()
    dead = tmp_path / f"file[1].nc.{process.pid}.tmp"
    alive = tmp_path / f"file[1].nc.{os.getppid()}.tmp"
    other = tmp_path / f"file1.nc.{process.pid}.tmp"
    for left in (dead, alive, other):
        left.write_text("half")
    io.write_text(tmp_path / "file[1].nc", "whole")
    assert not dead.exists() and alive.exists() and other.exists()


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "grains.nc"
    grains_file(path)
    return path


def refusal(path, kind="grains"):
    with pytest.raises(FileError) as error:
        io.read(path, kind)
    message = str(error.value)
    assert message.startswith(f"{path}: ") and "\n" not in message
    return message


def test_file_that_is_not_there(tmp_path):
    assert "there is no such file" in refusal(tmp_path / "none.nc")


def test_file_that_is_no_netcdf(file):
    file.write_text("not a netCDF file")
    assert "damaged or no netCDF file" in refusal(file)


def test_empty_file(file):
    file.write_bytes(b"")
    assert "damaged or no netCDF file" in refusal(file)


@pytest.mark.parametrize("part", [0.3, 0.7, 0.99])
def test_file_cut_short(file, part):
    content = file.read_bytes()
    file.write_bytes(content[: int(part * len(content))])
    assert "damaged" in refusal(file)


def test_a_single_wrong_byte_in_the_values(file):
    radius = grain_files.read_grains(file)[1].radius
    content = file.read_bytes()
    place = content.index(radius.tobytes())
    file.write_bytes(content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])
    assert "damaged" in refusal(file)


def test_foreign_netcdf(tmp_path):
    path = tmp_path / "foreign.nc"
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(path)
    assert "was not written by ratd" in refusal(path)


def test_another_kind(file):
    assert "is a file of grains, but one of spinup is needed" in refusal(file, "spinup")


def test_another_format(file, monkeypatch):
    monkeypatch.setattr(kinds, "FORMAT", 99)
    assert "has the format 1, but this ratd reads format 99" in refusal(file)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.drop_vars("radius"), "the variable 'radius' of a file of grains is missing"),
        (lambda d: d.rename_dims(monomer="ball"), "has the dimensions ('ball',)"),
        (lambda d: d.assign(x=d["x"].assign_attrs(units="nm")), "'x' has the units 'nm', but must have 'm'"),
        (lambda d: d.assign(x=d["x"] * np.nan), "'x'"),
    ],
)
def test_file_of_the_right_kind_that_is_laid_out_wrongly(file, change, said):
    dataset = io.read(file, "grains")
    file.unlink()
    change(dataset).to_netcdf(file)
    assert said in refusal(file)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda d: d.assign(more=("row", [1.0, 2.0, 3.0])), "no variable 'more'"),
        (lambda d: d.drop_vars("radius"), "'radius' of a file of grains is missing"),
        (lambda d: d.assign(seed=("row", [0.5, 1.0, 2.0])), "'seed' holds values that int64 cannot hold"),
        (lambda d: d.assign(a_eff=("row", ["a", "b", "c"])), "'a_eff' is of type"),
        (lambda d: d.assign(a_eff=("row", [1.0, 2.0, np.nan])), "'a_eff' holds values that are not finite"),
        (lambda d: d.assign(a_eff=("row", [1.0, 2.0, 3.0], {"units": "nm"})), "'a_eff' has the units 'nm'"),
    ],
)
def test_wrong_content_is_not_written(file, change, said):
    dataset = io.read(file, "grains")
    old = file.read_bytes()
    with pytest.raises(InputError) as error:
        io.write(file, change(dataset), "grains")
    assert said in str(error.value)
    assert file.read_bytes() == old and list(file.parent.iterdir()) == [file]


def test_rows_that_do_not_belong_together_are_refused():
    first, second = run_files.run_row(make_run(0)), run_files.run_row(make_run(1))
    second.attrs["drive"] = "literal"
    with pytest.raises(InputError, match="the same drive"):
        blocks.block([first, second], "spinup", MATERIALS["q-S"])
    with pytest.raises(InputError, match="at least one grain"):
        blocks.block([], "spinup", MATERIALS["q-S"])


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda row: row.drop_attrs(deep=False), "lacks"),
        (lambda row: row.drop_vars("omega"), "lacks 'omega'"),
        (lambda row: row.assign(more=("record", np.zeros(4))), "no variable 'more'"),
        (lambda row: row.assign_attrs(end_reason="bored"), "'bored' is none of one contact left"),
    ],
)
def test_row_that_is_not_one_of_its_kind_is_refused(change, said):
    with pytest.raises(InputError, match=said):
        blocks.block([change(run_files.run_row(make_run()))], "spinup", MATERIALS["q-S"])


def test_file_is_read_only_if_it_was_made_alike(tmp_path):
    path = tmp_path / "grains.nc"
    attributes = {"code_hash": "1", "settings": "{}"}
    assert io.read_made_with(path, "grains", attributes) is None
    grains_file(path, attributes=attributes)
    assert io.read_made_with(path, "grains", attributes).identical(io.read(path, "grains"))
    assert io.read_made_with(path, "grains", attributes | {"code_hash": "2"}) is None
    path.write_bytes(path.read_bytes()[:-100])
    assert io.read_made_with(path, "grains", attributes) is None
