"""The queue of spin-ups: it goes on where it was, whatever the order and the number of processes."""

import numpy as np
import pytest

from ratd.base.errors import InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up import study
from ratd.experiments.spin_up.grain_table import spun_up_files, spun_up_table
from ratd.experiments.spin_up.plan import Plan, load
from ratd.pipeline import blocks, io, queue
from tiny_pipeline import ROOT


def plan(folder, **own):
    """Two grains each of two types, small, under one drive."""
    config = {
        "materials": ["q-S"],
        "types": ["BA", "BAM2"],
        "sizes_nm": [80],
        "seeds": {"first": 0, "number": 2},
        "block_size": 1,
        "growth": {
            "median_nm": 20, "sigma_ln": 0.844, "smallest_nm": 10, "largest_nm": 100, "migration": "random"
        },
        "drives": ["prescribed"],
        "run": {
            "stretch": 2e-13, "epsilon": None, "angular_acceleration": None, "timestep_factor": 0.125, "records": 50,
            "max_steps": None,
        },
        "snapshots": {"every": 10, "grains": []},
    }  # fmt: skip
    return Plan(config | own, MATERIALS, str(folder / "results"))


def rows(path):
    return blocks.rows(io.read(path, "spun_up"), "spun_up")


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")

    def stop(text):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        queue.work(study.tasks(plan(folder), folder), say=stop)
    said = []
    assert queue.work(study.tasks(plan(folder), folder), say=said.append) == 0
    assert len(said) == 3
    return folder


def test_one_seed_of_all_cells_comes_before_the_next(tmp_path):
    wanted = study.tasks(plan(tmp_path), tmp_path)
    assert [(task.table.path.name, task.key[1]) for task in wanted] == [
        (f"q-S_{kind}.nc", seed) for seed in (0.0, 1.0) for kind in ("BA", "BAM2")
    ]


def test_rows_hold_marks_and_fragments(done):
    for kind in ("BA", "BAM2"):
        first, second = rows(done / "prescribed" / f"q-S_{kind}.nc")
        assert [first.attrs["seed"], second.attrs["seed"]] == [0, 1]
        for row in (first, second):
            assert 0.0 < row["omega_first_loss"].item() <= row["omega_mass_75"].item()
            assert row["steps_first_loss"].item() <= row["steps_mass_75"].item() < row.attrs["steps"]
            assert row["axis_ratio_first_loss"].item() > 1.0
            assert row["fragment_mass"].sum() <= row.attrs["initial_mass"] * (1 + 1e-9) and row.sizes["fragment"]
            assert len(row["source"].item()) == 16


def test_the_table_of_an_ensemble_is_read_from_the_rows(done):
    table = spun_up_table(spun_up_files(done / "prescribed"))
    assert table["type"].tolist() == ["BA", "BA", "BAM2", "BAM2"] and table["seed"].tolist() == [0, 1, 0, 1]
    (first, *_) = rows(done / "prescribed" / "q-S_BA.nc")
    assert table["omega_mass_75"][0] == first["omega_mass_75"].item() and table["steps"][0] == first.attrs["steps"]
    assert table["n_monomers"][0] == first.attrs["initial_n_monomers"]


def test_what_was_stopped_has_the_bytes_of_two_processes_at_work(done, tmp_path):
    assert queue.work(study.tasks(plan(tmp_path), tmp_path), say=lambda text: None, processes=2) == 0
    for kind in ("BA", "BAM2"):
        name = f"prescribed/q-S_{kind}.nc"
        assert (tmp_path / name).read_bytes() == (done / name).read_bytes()


def test_rows_of_another_spin_up_are_refused(done):
    other = plan(done)
    other.config["run"]["stretch"] = 1e-13
    with pytest.raises(InputError, match="q-S_BA.nc: holds rows with other settings than the config has"):
        study.tasks(other, done)


def test_rows_are_of_the_law_that_the_config_names(done, tmp_path):
    other = plan(tmp_path, types=["BAM2"], seeds={"first": 0, "number": 1})
    other.config["run"]["law"] = {"normal_force": "DMT"}
    assert queue.work(study.tasks(other, tmp_path), say=lambda text: None) == 0
    (row,) = rows(tmp_path / "prescribed" / "q-S_BAM2.nc")
    (own, _) = rows(done / "prescribed" / "q-S_BAM2.nc")
    assert row.attrs["seed"] == own.attrs["seed"] and row.attrs["initial_mass"] == own.attrs["initial_mass"]
    # the greatest pull is 4/3 of that of JKR
    assert 1.05 < row["omega_first_loss"].item() / own["omega_first_loss"].item() < 1.25
    with pytest.raises(InputError, match="holds rows with other settings"):
        study.tasks(other, done)


STUDIES = sorted(path.stem for path in (ROOT / "config" / "studies").glob("*.yaml"))


@pytest.mark.parametrize("name", STUDIES)
def test_a_study_is_the_file_of_its_name(name, monkeypatch):
    """Also: rows that are there were made with the config that is there."""
    monkeypatch.chdir(ROOT)
    own = load(*(path.format(study=name) for path in study.CONFIG))
    assert own.results == f"results/{name}"
    wanted = study.tasks(own, study.DATA.format(study=name))
    assert {task.table.path.parts[:4] for task in wanted} == {("docs", "reproduction", "data", name)}


def test_the_command_takes_a_study_by_its_name(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    assert study.main(["--study", "dmt", "--list"]) == 0
    assert capsys.readouterr().out.startswith("docs/reproduction/data/dmt/prescribed/q-S_BA.nc: ")
    assert study.main(["--list"]) == 0
    assert capsys.readouterr().out.startswith("docs/reproduction/data/spun_up/prescribed/a-C_BA.nc: ")
    assert study.main(["--study", "none", "--list"]) == 1
    assert "config/studies/none.yaml: cannot be read" in capsys.readouterr().err


def test_the_config_of_the_study_is_the_whole_paper(tmp_path):
    wanted = study.tasks(load(*(path.format(study=study.ENSEMBLE) for path in study.CONFIG)), tmp_path)
    drives = np.array([task.table.path.parent.name for task in wanted])
    assert np.sum(drives == "prescribed") == 2970 and np.sum(drives == "literal") == 495
    assert len({(task.table.path, task.key) for task in wanted}) == len(wanted)
