"""The pipeline as a whole, on a few very small grains: what runs when, kill and resume, the same bytes."""

import os
import re
import shutil
import signal
import subprocess
import time

import pytest
import yaml
from rocrate.rocrate import ROCrate

import browser
from ratd.experiments.spin_up import run_files
from ratd.pipeline import io
from ratd.pipeline.partial import partial_folder
from ratd.pipeline.provenance import file_hash
from tiny_pipeline import ROOT, TINY, Pipeline

GRAINS = "results/tiny/grains/q-S/BAM2/50nm/seeds_0-5.nc"
RUNS = "results/tiny/spinup/prescribed/q-S/BAM2/50nm/seeds_0-5.nc"
FIGURES = {"figure2", "figure4", "figure5", "figure6", "figure7", "figure8", "grain_page"}
COMMON_FIGURES = {"figure1", "figure10"}
OF_SNAPSHOTS = {"figure5", "grain_page"}
OF_RUNS = {"figure4"} | OF_SNAPSHOTS
OF_STUDIES = {"figure9", "draw_calibration"}
STUDIES = {"parameters", "parameter_table", "calibration_runs", "calibration"}


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A pipeline that has run to its end on two cores."""
    pipeline = Pipeline(tmp_path_factory.mktemp("finished"))
    done = pipeline.run()
    assert done.returncode == 0, done.stdout
    return pipeline


@pytest.fixture
def copy_of(finished, tmp_path):
    """A copy of the finished pipeline that a test may change."""
    shutil.copytree(finished.folder, tmp_path / "copy", symlinks=True)
    pipeline = object.__new__(Pipeline)
    pipeline.folder, pipeline.environment = tmp_path / "copy", dict(os.environ)
    return pipeline


def test_every_stage_leaves_its_files(finished):
    files = set(finished.files())
    assert {GRAINS, RUNS, "results/tiny/config.yaml"} <= files
    assert "results/tiny/disruption/prescribed/q-S/BA/50nm.nc" in files
    assert {f"results/tiny/ensemble/prescribed/table3.{suffix}" for suffix in ("nc", "csv")} <= files
    for number in (2, 4, 5, 6, 7, 8, 9):
        assert (finished.folder / f"results/tiny/figures/figure{number}_prescribed.pdf").read_bytes()[:5] == b"%PDF-"
        assert (finished.folder / f"results/tiny/figures/figure{number}_prescribed.png").read_bytes()[1:4] == b"PNG"
    page = (finished.folder / "results/tiny/figures/grain_prescribed.html").read_text()
    assert page.startswith("<!doctype html>") and "q-S BAM2 50 nm, seed 1" in page
    assert not [name for name in files if ".partial" in name or name.endswith(".tmp")]
    assert yaml.safe_load((finished.folder / "results/tiny/config.yaml").read_text())["spin_up"]["types"] == [
        "BA",
        "BAM2",
    ]


def test_files_tell_what_they_were_made_with(finished):
    grains = io.read(finished.folder / GRAINS, "grains")
    runs = io.read(finished.folder / RUNS, "spinup")
    assert runs.attrs["input_hash"] == file_hash(finished.folder / GRAINS)
    assert '"stretch":1e-12' in runs.attrs["settings"] and "stretch" not in grains.attrs["settings"]
    assert grains["seed"].values.tolist() == runs["seed"].values.tolist() == list(range(6))
    snapshots = [run.sizes.get("snapshot", 0) > 0 for run in run_files.runs(runs)]
    assert snapshots == [seed == 1 for seed in range(6)]


def test_logs_tell_how_far_a_job_is(finished):
    log = (finished.folder / "results/tiny/logs/spinup/prescribed/q-S/BAM2/50nm/seeds_0-5.log").read_text()
    assert re.search(r"seed 5: done in .* s \(6 of 6 grains\)", log) and "6 grains written" in log


def test_second_run_does_nothing(finished):
    before = {path: path.stat().st_mtime_ns for path in (finished.folder / "results").rglob("*")}
    done = finished.run()
    assert done.returncode == 0 and "Nothing to be done" in done.stdout
    assert {path: path.stat().st_mtime_ns for path in (finished.folder / "results").rglob("*")} == before


def test_touching_and_explaining_source_does_nothing(copy_of):
    source = copy_of.own_source()
    for folder in ("src", "workflow", "config"):
        for path in (copy_of.folder / folder).rglob("*.*"):
            path.touch()
    for path in (source / "experiments" / "spin_up" / "run.py", source / "aggregates" / "growth.py"):
        path.write_text(path.read_text() + "\n# a remark at the end\n")
    assert copy_of.planned() == {}


def test_change_of_a_plotting_function_reruns_figures_only(copy_of):
    before = copy_of.files()
    style = copy_of.own_source() / "pictures" / "style.py"
    style.write_text(re.sub(r'"axes.linewidth": [0-9.]+', '"axes.linewidth": 1.5', style.read_text()))
    assert set(copy_of.planned()) == FIGURES | COMMON_FIGURES | OF_STUDIES
    done = copy_of.run()
    assert done.returncode == 0, done.stdout
    after = copy_of.files()
    changed = {name for name in after if after[name] != before[name]}
    assert changed and all(name.startswith("results/tiny/figures/") for name in changed)


def test_change_of_the_contact_law_reruns_spin_ups_and_what_follows(copy_of):
    law = next((copy_of.own_source() / "laws").glob("jkr*.py"))
    law.write_text(law.read_text() + "\nNEW_CONSTANT = 1.0\n")
    planned = copy_of.planned()
    assert set(planned) == {"spin_up", "disrupt", "ensemble", "pairs", "figure10"} | FIGURES | STUDIES | OF_STUDIES
    assert planned["spin_up"] == 2


def test_change_of_the_growth_reruns_everything(copy_of):
    growth = copy_of.own_source() / "aggregates" / "growth.py"
    growth.write_text(growth.read_text() + "\nNEW_CONSTANT = 1.0\n")
    expected = {"grow", "spin_up", "disrupt", "ensemble", "figure1"} | FIGURES | STUDIES | OF_STUDIES
    assert set(copy_of.planned()) == expected


@pytest.mark.parametrize(
    ("module", "rerun"),
    [("disrupt", {"disrupt", "ensemble"} | FIGURES - OF_RUNS), ("figures/figure6", {"figure6"})],
)
def test_change_of_the_function_of_a_rule_reruns_its_stage_and_what_follows(copy_of, module, rerun):
    path = copy_of.own_source() / "experiments" / "spin_up" / f"{module}.py"
    path.write_text(path.read_text() + "\nNEW_CONSTANT = 1.0\n")
    assert set(copy_of.planned()) == rerun


def test_change_of_a_script_reruns_all_that_it_makes(copy_of):
    path = copy_of.folder / "workflow" / "scripts" / "figure.py"
    path.write_text(path.read_text() + "\nprint()\n")
    assert set(copy_of.planned()) == FIGURES - {"grain_page"} | COMMON_FIGURES | OF_STUDIES


@pytest.mark.parametrize(
    ("change", "rerun"),
    [
        ({"figures": TINY["figures"] | {"figure6": None}}, set()),
        # figure 9 spins up as the ensemble does
        (
            {"run": {"stretch": 2e-12}},
            {"spin_up", "disrupt", "ensemble", "parameters", "parameter_table", "figure9"} | FIGURES,
        ),
        ({"ensemble": {"bootstrap": 30}}, {"ensemble"} | FIGURES - OF_RUNS),
        ({"seeds": {"first": 0, "number": 7}}, {"grow", "spin_up", "disrupt", "ensemble"} | FIGURES - OF_SNAPSHOTS),
    ],
)
def test_change_of_the_config_reruns_what_depends_on_it(copy_of, change, rerun):
    copy_of.write_config(TINY | change)
    planned = copy_of.planned()
    assert set(planned) - {"write_config"} == rerun
    # further seeds are grown and spun up beside those that are there
    if "seeds" in change:
        assert planned["grow"] == planned["spin_up"] == 2


def test_all_seeds_of_one_size_by_file_name(finished):
    target = "results/tiny/disruption/prescribed/q-S/BA/50nm.nc"
    assert finished.planned("--forceall", target) == {"grow": 1, "spin_up": 1, "disrupt": 1}


def wait_for(found, process, seconds=300):
    """Wait until `found` returns something true, while a process runs."""
    end = time.monotonic() + seconds
    while not found():
        assert process.poll() is None and time.monotonic() < end, "it did not come to that"
        time.sleep(0.002)


def test_kill_in_the_middle_then_the_same_command_again(finished, tmp_path):
    """On one core, killed twice: in the middle of a block with all its processes, and Snakemake alone."""
    pipeline = Pipeline(tmp_path)
    for stage in (GRAINS, RUNS):
        target = tmp_path / stage
        folder = partial_folder(target)
        process = pipeline.start("--cores", "1")
        wait_for(lambda folder=folder: len(list(folder.glob("seed_*.nc"))) >= 1, process)
        if stage == RUNS:
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()  # the script that it started goes on, and is still at work when the next one starts
        process.wait()
        pieces = {path.name: path.stat().st_mtime_ns for path in folder.glob("seed_*.nc")}
    assert not target.exists() and len(pieces) == 1
    assert list((tmp_path / ".snakemake" / "locks").iterdir())  # what Snakemake would ask to be unlocked

    process = pipeline.start("--cores", "1")
    wait_for(target.exists, process)
    for name, time_written in pieces.items():
        assert (folder / name).stat().st_mtime_ns == time_written
    assert process.wait(timeout=600) == 0, (tmp_path / "output.txt").read_text()
    log = (tmp_path / "results/tiny/logs/spinup/prescribed/q-S/BAM2/50nm/seeds_0-5.log").read_text()
    assert f"{len(pieces)} of them were finished before" in log
    assert pipeline.files() == finished.files()


def test_damaged_input_ends_its_job_with_a_name_and_touches_nothing_else(copy_of):
    whole = copy_of.files()
    path = copy_of.folder / GRAINS
    path.write_bytes(path.read_bytes()[:1000])
    before = copy_of.files()
    done = copy_of.run(RUNS)
    assert done.returncode != 0
    assert f"error: {GRAINS}: is damaged" in done.stdout and "Traceback" not in done.stdout
    # once more at the end, where one looks
    last = done.stdout.splitlines()[-1]
    assert GRAINS in last and last.endswith("remove it, and the same command makes it anew")
    after = copy_of.files()
    assert after == {name: content for name, content in before.items() if name != RUNS}
    path.unlink()
    assert copy_of.run(RUNS).returncode == 0
    assert copy_of.files() == whole


def test_a_file_of_other_grains_in_the_place_of_an_input_is_refused(copy_of):
    shutil.copy(copy_of.folder / GRAINS.replace("BAM2", "BA"), copy_of.folder / GRAINS)
    done = copy_of.run(RUNS)
    assert done.returncode != 0
    assert done.stdout.splitlines()[-1].endswith(
        f"error: {GRAINS}: has the type BA, but lies where BAM2 belongs: remove it, and the same command makes it anew"
    )


def test_results_copied_elsewhere_are_used_if_they_are_what_the_plan_makes(copy_of):
    shutil.rmtree(copy_of.folder / ".snakemake")
    assert copy_of.planned() == {}
    copy_of.write_config(TINY | {"run": {"stretch": 2e-12}, "figures": TINY["figures"] | {"figure6": None}})
    done = copy_of.run("--dry-run")
    assert done.returncode != 0
    *_, last = done.stdout.splitlines()
    assert last.startswith(
        "results/tiny: files that Snakemake has no record of were made with other settings or another"
    )
    assert "2 in results/tiny/spinup" in last and "for example results/tiny/" in last
    assert "with --forcerun parameters spin_up makes them anew" in last
    expected = {"parameters", "parameter_table", "figure9", "spin_up", "disrupt", "ensemble"} | FIGURES - {"figure6"}
    assert set(copy_of.planned("--forcerun", "parameters", "spin_up")) == expected


def test_source_of_copied_results_is_that_of_now_or_they_are_named(copy_of):
    shutil.rmtree(copy_of.folder / ".snakemake")
    growth = copy_of.own_source() / "aggregates" / "growth.py"
    growth.write_text(growth.read_text() + "\nNEW_CONSTANT = 1.0\n")
    done = copy_of.run("--dry-run")
    assert done.returncode != 0 and "2 in results/tiny/grains" in done.stdout.splitlines()[-1]


def test_on_a_full_disk_the_last_line_says_so(tmp_path):
    """On a small disk in memory, which only root may make."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=3000k", "none", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("no small disk can be made here")
    try:
        pipeline = Pipeline(folder)
        # room for what Snakemake itself writes, not for the grains
        with open(folder / "filling", "wb") as filling:
            filling.write(bytes(shutil.disk_usage(folder).free - 60_000))
        done = pipeline.run(GRAINS)
        assert done.returncode != 0
        last = done.stdout.splitlines()[-1]
        assert last.startswith(f"grow q-S BAM2 50 nm 0-5: error: {GRAINS}")
        assert last.endswith(": cannot be written (No space left on device)")
        (folder / "filling").unlink()
        assert pipeline.run(GRAINS).returncode == 0
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def test_output_that_was_removed_is_made_again_with_the_same_bytes(copy_of):
    name = "results/tiny/disruption/prescribed/q-S/BA/50nm.nc"
    content = (copy_of.folder / name).read_bytes()
    (copy_of.folder / name).unlink()
    assert copy_of.run(name).returncode == 0
    assert (copy_of.folder / name).read_bytes() == content


@pytest.fixture(scope="module")
def report(finished, tmp_path_factory):
    """The report of a finished pipeline."""
    path = tmp_path_factory.mktemp("report") / "report.html"
    done = finished.run("--report", str(path))
    assert done.returncode == 0, done.stdout
    return path


def test_report_is_one_page_with_captions(report):
    page = report.read_text()
    for number in (2, 4, 5, 6, 7, 8, 9):
        caption = (ROOT / "workflow" / "report" / f"figure{number}.rst").read_text()
        first_words = re.search(r"\w[\w ]+\w", caption).group()
        assert f"figure{number}_prescribed.png" in page and first_words in page


def test_report_in_a_browser(report):
    """An opening text, all tables, the figures in the order of their numbers."""

    def rows(page, category):
        page.goto(report.resolve().as_uri())
        # of the menu: the opening text says "Interactive" too, and may stand before the menu does
        # with a key and not the mouse: the page sets its style while it runs, and what moves may be missed
        page.get_by_role("link", name=category, exact=True).press("Enter")
        page.wait_for_selector("tbody tr")
        return [row.split("\t")[0].strip() for row in page.locator("tbody tr").all_inner_texts()]

    with browser.opened(report) as page:
        page.wait_for_selector("text=Dust aggregates, every monomer integrated.")
        tables = ["Calibration of the drive literal", "Runs of figure 9, drive prescribed", "Table 1", "Table 2"]
        assert rows(page, "Tables") == [*tables, "Table 3, drive prescribed"]
        assert rows(page, "Spin-up") == ["1", "2", "4", "5", "6", "7", "8", "9", "10", "study"]
        assert rows(page, "Interactive") == ["one grain coming apart"]


def test_results_are_described_as_a_crate(copy_of):
    done = copy_of.run("crate")
    assert done.returncode == 0, done.stdout
    crate = ROCrate(copy_of.folder / "results" / "tiny")
    (run,) = crate.get_by_type("CreateAction")
    made = {file.id for file in run["result"]}
    assert {RUNS.removeprefix("results/tiny/"), "figures/figure7_prescribed.png"} <= made
    assert [file.id for file in run["object"]] == ["config.yaml"]
