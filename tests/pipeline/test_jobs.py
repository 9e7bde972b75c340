"""Jobs: partial results, locks, logs."""

import logging
import subprocess
import sys
import textwrap
import time
from types import SimpleNamespace

import pandas as pd
import pytest
import xarray as xr

from files import make_grain
from ratd.aggregates import files as grain_files
from ratd.base.errors import FileError, InputError
from ratd.base.materials import MATERIALS
from ratd.experiments.spin_up.spin import told
from ratd.pipeline import first_error, io, jobs, partial
from tiny_pipeline import ROOT

SCRIPTS = ROOT / "workflow" / "scripts"
GROW = SCRIPTS / "run.py", "ratd.experiments.spin_up.grow:block", "grains"
SEEDS = [0, 1, 2]


@pytest.fixture(autouse=True)
def no_handlers_left():
    yield
    for handler in list(logging.getLogger("ratd.job").handlers):
        logging.getLogger("ratd.job").removeHandler(handler)
        handler.close()


def make_job(tmp_path, settings=None, task=None):
    """A job of the rule `grow` as Snakemake would give it to the script."""
    return SimpleNamespace(
        rule="grow",
        scriptdir=str(SCRIPTS),
        params=SimpleNamespace(task=task or jobs.task(*GROW), settings=settings or {"a_eff": 1}),
        wildcards={"material": "q-S", "size": "50"},
        input=[],
        output={"table": str(tmp_path / "table.nc"), "table_csv": str(tmp_path / "table.csv")},
        log=[str(tmp_path / "job.log")],
    )


def run_block(tmp_path, target, settings=None, die_at=None, seeds=SEEDS):
    """Run a block of grains; return the seeds that were computed. `die_at` raises at that seed."""
    made = []

    def make(seed, checkpoint):
        if seed == die_at:
            raise KeyboardInterrupt
        checkpoint.write_text("half a grain")
        made.append(seed)
        return grain_files.grain_row(make_grain(seed), 1e8)

    with jobs.Job(make_job(tmp_path, settings)) as job:
        job.block(target, "grains", MATERIALS["q-S"], seeds, make)
    return made


def test_block_holds_all_grains_and_its_provenance(tmp_path):
    target = tmp_path / "deep" / "seeds_0-2.nc"
    assert run_block(tmp_path, target) == SEEDS
    assert [grain.seed for grain in grain_files.read_grains(target)] == SEEDS
    attributes = io.read(target, "grains").attrs
    assert attributes["settings"] == '{"a_eff":1}' and len(attributes["code_hash"]) == 16
    assert not list(target.parent.rglob("*.tmp")) and not list(target.parent.rglob("*.checkpoint"))


def test_a_killed_block_goes_on_and_gives_the_same_bytes(tmp_path):
    whole, target = tmp_path / "whole.nc", tmp_path / "seeds_0-2.nc"
    run_block(tmp_path, whole)
    with pytest.raises(KeyboardInterrupt):
        run_block(tmp_path, target, die_at=2)
    assert not target.exists()
    assert run_block(tmp_path, target) == [2]
    assert target.read_bytes() == whole.read_bytes()
    assert "2 of them were finished before" in (tmp_path / "job.log").read_text()


def test_a_grain_that_fails_does_not_stop_the_others_and_is_named(tmp_path):
    target = tmp_path / "seeds_0-2.nc"
    made = []

    def make(seed, checkpoint):
        if seed == 1:
            raise RuntimeError("it does not come to rest")
        made.append(seed)
        return grain_files.grain_row(make_grain(seed), 1e8)

    with pytest.raises(SystemExit), jobs.Job(make_job(tmp_path, None)) as job:
        job.block(target, "grains", MATERIALS["q-S"], SEEDS, make)
    assert made == [0, 2] and not target.exists()
    last = (tmp_path / "job.log").read_text().splitlines()[-1]
    assert last.endswith("1 of 3 grains failed, the others are kept: seed 1: it does not come to rest")
    assert run_block(tmp_path, target) == [1]


def test_partial_results_of_other_settings_are_not_used(tmp_path):
    target = tmp_path / "seeds_0-2.nc"
    with pytest.raises(KeyboardInterrupt):
        run_block(tmp_path, target, die_at=2)
    assert run_block(tmp_path, target, settings={"a_eff": 2}) == SEEDS


def test_checkpoint_of_other_settings_is_not_found(tmp_path):
    paths = []

    def make(seed, checkpoint):
        paths.append(checkpoint)
        return grain_files.grain_row(make_grain(seed), 1e8)

    for size in (1, 2):
        with jobs.Job(make_job(tmp_path, {"a_eff": size})) as job:
            job.block(tmp_path / "x.nc", "grains", MATERIALS["q-S"], [0], make)
    assert paths[0] != paths[1] and paths[0].parent == paths[1].parent


def test_damaged_partial_result_is_made_anew(tmp_path):
    target = tmp_path / "seeds_0-2.nc"
    with pytest.raises(KeyboardInterrupt):
        run_block(tmp_path, target, die_at=2)
    piece = partial.partial_folder(target) / "seed_1.nc"
    piece.write_bytes(piece.read_bytes()[:-50])
    assert run_block(tmp_path, target) == [1, 2]


def test_short_grains_share_a_piece(tmp_path, monkeypatch):
    """The first one has a piece of its own, the others come before enough time has gone by for a second one."""
    monkeypatch.setattr(partial, "WORK_BETWEEN_PIECES", 1e6)
    target, seeds = tmp_path / "seeds_0-4.nc", [0, 1, 2, 3, 4]
    with pytest.raises(KeyboardInterrupt):
        run_block(tmp_path, target, die_at=4, seeds=seeds)
    folder = partial.partial_folder(target)
    pieces = sorted(folder.glob("*.nc"))
    assert [[grain.seed for grain in grain_files.read_grains(piece)] for piece in pieces] == [[0], [1, 2, 3]]
    assert [path.name[:6] for path in folder.glob("*.checkpoint")] == []
    assert run_block(tmp_path, target, seeds=seeds) == [4]
    pieces[1].unlink()
    target.unlink()
    assert run_block(tmp_path, target, seeds=seeds) == [1, 2, 3]
    assert [grain.seed for grain in grain_files.read_grains(target)] == seeds


def test_long_grains_have_a_piece_each(tmp_path, monkeypatch):
    monkeypatch.setattr(partial, "WORK_BETWEEN_PIECES", 0)
    target = tmp_path / "seeds_0-2.nc"
    run_block(tmp_path, target)
    assert len(list(partial.partial_folder(target).glob("*.nc"))) == 3


def test_grains_stand_in_the_order_of_their_seeds_and_not_of_the_names_of_pieces(tmp_path, monkeypatch):
    """As text 10 comes before 9."""
    monkeypatch.setattr(partial, "WORK_BETWEEN_PIECES", 0)
    target, seeds = tmp_path / "seeds_9-11.nc", [9, 10, 11]
    run_block(tmp_path, target, seeds=seeds)
    assert [grain.seed for grain in grain_files.read_grains(target)] == seeds


def test_bad_input_ends_with_one_sentence(tmp_path, capsys):
    with pytest.raises(SystemExit) as end, jobs.Job(make_job(tmp_path)):
        raise InputError("size is -1; allowed: above 0")
    assert end.value.code == 1
    for text in (capsys.readouterr().err, (tmp_path / "job.log").read_text()):
        assert text.endswith("error: size is -1; allowed: above 0\n") and "Traceback" not in text


def test_any_other_error_is_logged_with_its_place(tmp_path):
    with pytest.raises(ZeroDivisionError), jobs.Job(make_job(tmp_path)):
        1 / 0  # noqa: B018
    assert "Traceback" in (tmp_path / "job.log").read_text()


def test_messages_on_the_terminal_name_the_job(tmp_path, capsys):
    with jobs.Job(make_job(tmp_path)) as job:
        job.log.info("50 % done")
    assert capsys.readouterr().err == "grow q-S 50 nm: 50 % done\n"


def test_source_that_was_changed_in_the_meantime_ends_the_job(tmp_path, capsys):
    with pytest.raises(SystemExit), jobs.Job(make_job(tmp_path, task=jobs.task(*GROW) | {"hash": "0" * 16})):
        pass
    assert "start the same command again" in capsys.readouterr().err


def test_progress_speaks_now_and_then(tmp_path, capsys, monkeypatch):
    now = 100.0
    monkeypatch.setattr(jobs.time, "monotonic", lambda: now)
    with jobs.Job(make_job(tmp_path)) as job:
        progress = told(job.progress("seed 7"))
        progress(1e8, 1.0, 100.0, 10)
        now += jobs.PROGRESS_INTERVAL
        progress(1.234e8, 0.755, 300.0, 2000)
        progress(1.3e8, 0.7, 290.0, 2100)
    assert capsys.readouterr().err == (
        "grow q-S 50 nm: seed 7: omega 1.23e+08 rad/s, mass left 76 %, about 5 min to go, 2000 steps\n"
    )


def test_a_kind_that_the_rule_does_not_name_is_not_written(tmp_path, capsys):
    """Its layout would be missing in the hash of the source."""
    with pytest.raises(SystemExit), jobs.Job(make_job(tmp_path)) as job:
        job.write("table_csv", pd.DataFrame({"a": [1.5]}))
        job.write("table", xr.Dataset())
    assert "ratd.experiments.spin_up.grow:block writes table, which its rule does not name; allowed: grains" in (
        capsys.readouterr().err
    )
    assert (tmp_path / "table.csv").read_text() == "a\n1.5\n" and not (tmp_path / "table.nc").exists()


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0, "about 0 s"),
        (100, "about 100 s"),
        (600, "about 10 min"),
        (9000, "about 2 h"),
        (400000, "about 5 d"),
        (None, "unknown time"),
        (float("nan"), "unknown time"),
        (float("inf"), "unknown time"),
    ],
)
def test_duration_in_words(seconds, words):
    assert jobs.duration(seconds) == words


def start_python(source, *arguments):
    """Start source in another process and wait until it has written a line."""
    process = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(source), *map(str, arguments)], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "ready\n"
    return process


HOLD_LOCK = """
    import logging, sys, time
    from pathlib import Path
    from ratd.pipeline.partial import locked
    with locked(sys.argv[1], print):
        print("ready", flush=True)
        time.sleep(float(sys.argv[2]))
        Path(sys.argv[1] + ".done").write_text("")
"""


def test_lock_makes_the_second_one_wait(tmp_path, caplog):
    process = start_python(HOLD_LOCK, tmp_path / "lock", 0.5)
    with caplog.at_level(logging.INFO), partial.locked(tmp_path / "lock", logging.getLogger().info):
        assert (tmp_path / "lock.done").exists()
    assert "waiting for it" in caplog.text
    process.wait()


def test_lock_ends_with_a_killed_process(tmp_path):
    process = start_python(HOLD_LOCK, tmp_path / "lock", 1000)
    process.kill()
    process.wait()
    start = time.monotonic()
    with partial.locked(tmp_path / "lock", logging.getLogger().info):
        assert time.monotonic() - start < 100
    assert not (tmp_path / "lock.done").exists()


def test_tidy_removes_partial_results_of_finished_files_only(tmp_path):
    finished, unfinished, at_work = (tmp_path / "a" / f"{name}.nc" for name in ("finished", "unfinished", "at_work"))
    for target in (finished, unfinished, at_work):
        partial.partial_folder(target).mkdir(parents=True)
        for name in ("seed_0.nc", "lock", "seed_1.0123456789abcdef.checkpoint", "seed_2.nc.17.tmp"):
            (partial.partial_folder(target) / name).write_text("")
    for target in (finished, at_work):
        target.write_text("")
    process = start_python(HOLD_LOCK, partial.partial_folder(at_work) / "lock", 1000)
    partial.tidy(tmp_path)
    assert not partial.partial_folder(finished).exists()
    assert (partial.partial_folder(unfinished) / "seed_0.nc").exists()
    assert (partial.partial_folder(at_work) / "seed_0.nc").exists()
    process.kill()
    process.wait()


LIVE_SNAKEMAKE = """
    import sys, time
    from ratd.pipeline.jobs import release_stale_locks
    release_stale_locks(sys.argv[1])
    print("ready", flush=True)
    time.sleep(1000)
"""


def test_locks_of_a_killed_snakemake_are_removed_and_those_of_a_live_one_are_not(tmp_path):
    folder = tmp_path / ".snakemake"
    process = start_python(LIVE_SNAKEMAKE, folder)
    lock = folder / "locks" / "0.output.lock"
    lock.parent.mkdir()
    lock.write_text("results/file\n")
    second = start_python(LIVE_SNAKEMAKE, folder)  # such as a dry run beside it
    assert lock.exists()
    process.kill()
    process.wait()
    third = start_python(LIVE_SNAKEMAKE, folder)
    assert lock.exists()  # the second one is still there
    for process in (second, third):
        process.kill()
        process.wait()
    fourth = start_python(LIVE_SNAKEMAKE, folder)
    assert not lock.exists()
    fourth.kill()
    fourth.wait()


def test_tidy_leaves_what_it_did_not_make(tmp_path):
    # the last of them with a name as of its own, but no lock
    for name in ("film.mp4", "notes.nc", "data.nc", "others.nc"):
        (tmp_path / name).write_text("")
        folder = partial.partial_folder(tmp_path / name)
        folder.mkdir()
        (folder / ("seed_0.nc" if name == "others.nc" else "frame_0.png")).write_text("")
    (partial.partial_folder(tmp_path / "notes.nc") / "lock").write_text("")
    before = sorted(tmp_path.rglob("*"))
    partial.tidy(tmp_path)
    assert sorted(tmp_path.rglob("*")) == before


def test_the_first_error_of_a_run_is_kept(tmp_path):
    place = tmp_path / "ratd.first_error"
    first_error.keep("nobody made room", place)
    assert first_error.kept(place) == ""
    first_error.begin(place)
    size = place.stat().st_size
    for sentence in ("the first,\nin two lines, 100 µm", "the second"):
        first_error.keep(sentence, place)
    assert first_error.kept(place) == "the first, in two lines, 100 µm" and place.stat().st_size == size
    first_error.begin(place)
    assert first_error.kept(place) == ""


def test_an_error_that_is_too_long_fills_the_room_and_no_more(tmp_path):
    place = tmp_path / "ratd.first_error"
    first_error.begin(place)
    first_error.keep("µ" * 3000, place)
    assert place.stat().st_size == first_error.ROOM and set(first_error.kept(place)) == {"µ"}


def test_a_failed_job_keeps_its_error(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    first_error.begin()
    with pytest.raises(SystemExit), jobs.Job(make_job(tmp_path)):
        raise InputError("a is b; allowed: c")
    with pytest.raises(ZeroDivisionError), jobs.Job(make_job(tmp_path)):
        print(1 / 0)
    assert first_error.kept() == "grow q-S 50 nm: error: a is b; allowed: c"


def test_an_error_is_not_hidden_by_that_of_keeping_what_was_done(tmp_path, monkeypatch):
    def full(*arguments):
        raise FileError("x.nc: cannot be written (No space left on device)")

    def make(seed, checkpoint):
        if seed == 1:
            monkeypatch.setattr(io, "write", full)
            raise RuntimeError("the grain is lost")
        return grain_files.grain_row(make_grain(seed), 1e8)

    monkeypatch.chdir(tmp_path)
    first_error.begin()
    with pytest.raises(SystemExit), jobs.Job(make_job(tmp_path)) as job:
        job.block(tmp_path / "x.nc", "grains", MATERIALS["q-S"], [0, 1], make)
    assert "seed 1: the grain is lost" in first_error.kept()


def test_a_log_that_cannot_be_written_stops_nothing(tmp_path):
    job = make_job(tmp_path)
    job.log = [str(tmp_path / "none" / "job.log")]
    with jobs.Job(job) as running:
        running.write("table_csv", "a text")
    assert (tmp_path / "table.csv").read_text() == "a text"
