"""The data of the document: what is collected, what stays, and what need not be spun up again."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from ratd.reproduction.collect import Collection
from ratd.reproduction.collected import AT_REST, Collected
from ratd.reproduction.kept import read_kept

from files import make_run
from ratd.base.errors import FileError, InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.fragmentation import FRAGMENT_COLUMNS
from ratd.experiments.spin_up.grain_table import GRAIN_COLUMNS, grain_table, table_dataset
from ratd.pipeline import io
from ratd.pipeline.config import load, merge

ROOT = Path(__file__).parents[1]
CELL = ("q-S", "BA", "100")
NAMES = {"material": "q-S", "type": "BA", "size_nm": 100}
PROVENANCE = {"code_hash": "0123", "versions": "ratd 0"}


@pytest.fixture(autouse=True)
def in_root(monkeypatch):
    monkeypatch.chdir(ROOT)


def plan_with(number=4, figure5_seed=1, **changes):
    """Plan of one cell with some seeds, which the figures 4 and 5 show."""
    plan = load("config/config.yaml")
    seeds = {"first": 0, "number": number, "fewer": []}
    cell = {"materials": ["q-S"], "types": ["BA"], "sizes_nm": [100], "seeds": seeds, "block_size": 3}
    figures = {"figure4": NAMES, "figure5": None if figure5_seed is None else NAMES | {"seed": figure5_seed}}
    own = cell | {"small_grains": None, "figures": plan.config["figures"] | figures}
    return replace(plan, config=merge(plan.config | own, changes))


def write_runs(path, seeds, source="a", plan=None):
    """A file of made-up runs; the numbers of a run depend on its seed alone."""
    made = []
    for seed in seeds:
        run = make_run(seed, n_records=4 + seed, n_snapshots=2)
        run.attrs |= {"a_eff": 100e-9, "cut_bound": 1e8}
        made.append(run)
    rows = [io.run_row(run) for run in made]
    settings = json.dumps((plan or plan_with()).spin_up("prescribed", *CELL, "0-2"))
    attributes = {"code_hash": source, "settings": settings}
    io.write(path, io.block(rows, "spinup", MATERIALS["q-S"], attributes), "spinup")
    return made


def write_grown(path, number):
    """Table of made-up grains as grown."""
    columns = {name: 1.0 + np.arange(number) for name in GRAIN_COLUMNS}
    columns |= {"material": "q-S", "type": "BA", "a_eff": 100e-9, "seed": range(number)}
    table = grain_table(pd.DataFrame(columns))
    io.write(path, table_dataset(table).assign_attrs(code_hash="b"), "table")


def collect(folder, plan, seeds, source="a", grown=None):
    """Collect runs of these seeds; grains as grown where a number is given."""
    collection = Collection(folder, plan, PROVENANCE)
    if grown:
        write_grown(folder.parent / "grown.nc", grown)
    collection.grown(*([folder.parent / "grown.nc"] if grown else []))
    path = folder.parent / "runs.nc"
    if seeds:
        write_runs(path, seeds, source, plan)
    collection.runs([path] if seeds else [], "prescribed")
    collection.finish("make it")


def content(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_collection_holds_marks_fragments_records_and_pictures(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(), range(4), grown=4)
    made = write_runs(tmp_path / "runs.nc", range(4))
    table = io.read_table(folder / "ensemble/prescribed/grains.nc")
    assert table["seed"].tolist() == [0, 1, 2, 3] and table["n_monomers"].tolist() == [1, 2, 3, 4]
    assert table["steps"].tolist() == [run.attrs["steps"] for run in made]
    assert io.read_fit(folder / "ensemble/prescribed/table3.nc").attrs["drive"] == "prescribed"
    fragments = io.read(folder / "fragments/prescribed.nc", "fragments")
    assert fragments["seed"].values.tolist() == [0, 1, 2, 3] and set(FRAGMENT_COLUMNS) < set(fragments.variables)
    course = io.read_runs(folder / "figure4/prescribed.nc")
    assert [run.attrs["seed"] for run in course] == [0, 1, 2, 3] and not any("snapshot" in run.sizes for run in course)
    np.testing.assert_array_equal(course[1]["total_stress"].values, made[1]["total_stress"].values)
    shown = io.read_runs(folder / "figure5/prescribed.nc")
    assert [run.attrs["seed"] for run in shown] == [1] and 0 < shown[0].sizes["snapshot"] <= 2
    readme = (folder / "README.md").read_text()
    assert "make it" in readme and "`fragments/prescribed.nc`" in readme and str(tmp_path) not in readme
    assert (
        f"| prescribed | 4 | a | {Collected(folder, plan_with()).grains['prescribed', *CELL][0].marks_source} |"
        in readme
    )


def test_collecting_again_gives_the_same_bytes_and_leaves_nothing_old(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(), range(4), grown=4)
    first = content(folder)
    (folder / "ensemble" / "old.nc").write_text("old")
    collect(folder, plan_with(), range(4), grown=4)
    assert content(folder) == first
    # a study may come from other results than the ensemble
    (folder / "calibration.nc").write_text("a study")
    collect(folder, plan_with(), range(4), grown=4)
    assert (folder / "calibration.nc").read_text() == "a study"
    assert "`calibration.nc`" in (folder / "README.md").read_text()


def test_grains_collected_in_pieces_are_those_collected_at_once(tmp_path):
    """Whatever the pieces and their order, all files but the README, which says what was kept, have the same bytes."""
    whole, pieces = tmp_path / "whole", tmp_path / "pieces"
    collect(whole, plan_with(), range(4), grown=4)
    for seeds in ([1, 3], [0], [], [2]):
        collect(pieces, plan_with(), seeds, grown=None if (pieces / "grown.nc").is_file() else 4)
    first, second = content(whole), content(pieces)
    assert first.pop("README.md") != second.pop("README.md")
    assert second == first


def test_only_what_is_not_there_is_missing(tmp_path):
    folder = tmp_path / "data"
    assert Collected(folder, plan_with()).missing("prescribed") == [(CELL, "0-2"), (CELL, "3-3")]
    assert not Collected(folder, plan_with()).grown
    collect(folder, plan_with(number=2), range(2), grown=2)
    assert Collected(folder, plan_with(number=2)).missing("prescribed") == []
    assert Collected(folder, plan_with(number=2)).grown
    # more seeds: what is there is cut out of the block
    more = Collected(folder, plan_with(number=5))
    assert more.missing("prescribed") == [(CELL, "2-2"), (CELL, "3-4")] and more.blocks == ["2-2", "3-4"]
    assert not more.grown
    # one job of a GPU has whole blocks
    assert Collected(folder, plan_with(number=5, engine="cuda")).missing("prescribed") == [(CELL, "0-2"), (CELL, "3-4")]
    assert Collected(folder, plan_with(number=2, engine="cuda")).missing("prescribed") == []


@pytest.mark.parametrize(
    "changes",
    [
        {"spin_up": {"timestep_factor": 0.1}},
        {"spin_up": {"epsilon": {"BA": 0.01}}},
        {"growth": {"migration": "nearest"}},
    ],
)
def test_grains_of_another_law_are_made_anew(tmp_path, changes):
    folder = tmp_path / "data"
    collect(folder, plan_with(), range(4), grown=4)
    other = plan_with(**changes)
    assert Collected(folder, other).missing("prescribed") == [(CELL, "0-2"), (CELL, "3-3")]
    assert Collected(folder, other).grown == ("growth" not in changes)
    # the law of another type, and what figures that are drawn from all grains show, do not matter
    for same in ({"spin_up": {"epsilon": {"BAM1": 0.01}}}, {"figures": {"figure8": None}}):
        assert Collected(folder, plan_with(**same)).missing("prescribed") == []
    collect(folder, other, [3], grown=4)
    assert Collected(folder, other).seeds("prescribed", CELL) == {3}
    assert io.read_table(folder / "ensemble/prescribed/grains.nc")["seed"].tolist() == [3]
    assert Collected(folder, plan_with()).seeds("prescribed", CELL) == set()


def test_a_killed_collection_claims_no_grain_that_is_not_there(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(), range(4), grown=4)
    Collection(folder, plan_with(spin_up={"timestep_factor": 0.1}), PROVENANCE)  # and no further
    assert Collected(folder, plan_with()).seeds("prescribed", CELL) == set()
    assert Collected(folder, plan_with()).seeds(AT_REST, CELL) == set(range(4))


def test_grains_that_figures_show_anew_are_made_anew(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(figure5_seed=None), range(4), grown=4)
    assert Collected(folder, plan_with(figure5_seed=2)).missing("prescribed") == [(CELL, "2-2")]
    collect(folder, plan_with(figure5_seed=2), [2])
    assert [run.attrs["seed"] for run in io.read_runs(folder / "figure5/prescribed.nc")] == [2]
    collect(folder, plan_with(figure5_seed=None), [])
    assert not (folder / "figure5").exists() or not list((folder / "figure5").iterdir())
    assert Collected(folder, plan_with(figure5_seed=2)).missing("prescribed") == [(CELL, "2-2")]


def test_results_of_another_law_are_refused(tmp_path):
    """Asked to look at times alone, Snakemake takes files for up to date that were made with other settings."""
    collection = Collection(tmp_path / "data", plan_with(), PROVENANCE)
    write_runs(tmp_path / "runs.nc", [0], plan=plan_with(spin_up={"timestep_factor": 0.1}))
    with pytest.raises(FileError, match=r"runs\.nc: was made with timestep_factor = 0\.1, but the config has 0\.125"):
        collection.runs([tmp_path / "runs.nc"], "prescribed")


def test_source_of_each_piece_is_told(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(), [0, 1, 2], source="a", grown=4)
    collect(folder, plan_with(), [1, 3], source="c")
    found = Collected(folder, plan_with())
    assert [origin.source for _, origin in sorted(found.grains["prescribed", *CELL].items())] == ["a", "c", "a", "c"]
    assert [(drive, number, source) for drive, number, source, _ in found.summary()] == [
        (AT_REST, 4, "b"),
        ("prescribed", 2, "a"),
        ("prescribed", 2, "c"),
    ]


def test_damaged_or_foreign_index_is_one_sentence(tmp_path):
    folder = tmp_path / "data"
    collect(folder, plan_with(), range(4), grown=4)
    index = folder / "collected.csv"
    text = index.read_text()
    index.write_text(text.replace("drive,", "engine,"))
    with pytest.raises(InputError, match=r"collected\.csv: is damaged in line 1; allowed: drive,material"):
        Collected(folder, plan_with())
    index.write_text(text[:-20])
    with pytest.raises(InputError, match=r"collected\.csv: is damaged in line \d+; allowed: a value for each column"):
        Collected(folder, plan_with())
    index.write_text(text)
    collected = Collected(folder, plan_with())
    collected.add("prescribed", CELL, 7, "a")
    with pytest.raises(FileError, match=r"grains\.nc: lacks q-S BA 100 nm seed 7, which collected\.csv names"):
        read_kept(folder, "prescribed", collected)
