"""The pipeline on a Slurm of one node, killed once in the middle."""

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import yaml

from ratd.aggregates.files import read_grains
from ratd.experiments.spin_up.grow import grown
from ratd.experiments.spin_up.plan import load
from ratd.experiments.spin_up.run_files import read_marks
from slurm import cluster
from tiny_pipeline import ROOT, TINY, Pipeline

GRAINS = "results/tiny/grains/q-S/BAM2/50nm/seeds_0-1.nc"
MARKS = "results/tiny/disruption/prescribed/q-S/BAM2/50nm.nc"
SMALL = {"types": ["BAM2"], "seeds": {"number": 2}, "figures": None, "snapshots": None}
QUICKLY = ("--slurm-status-command", "squeue", "--slurm-init-seconds-before-status-checks", "1", "--latency-wait", "10")
COMMAND = (sys.executable, "-m", "snakemake", "disruptions", "--workflow-profile", "profiles/slurm", *QUICKLY)


def test_the_pipeline_runs_on_slurm_and_goes_on_after_a_kill(tmp_path, monkeypatch):
    pytest.importorskip("snakemake_executor_plugin_slurm")
    with cluster(tmp_path / "slurm") as environment:
        folder = tmp_path / "run"
        folder.mkdir()
        Pipeline(folder).write_config(TINY | SMALL)
        command = [*COMMAND, "--configfile", "tiny.yaml"]
        with open(folder / "output.txt", "w") as output:
            how = {"cwd": folder, "env": environment, "stdout": output, "stderr": subprocess.STDOUT}
            process = subprocess.Popen(command, start_new_session=True, **how)
            end = time.monotonic() + 300
            while not (folder / GRAINS).exists():
                assert process.poll() is None and time.monotonic() < end, (folder / "output.txt").read_text()
                time.sleep(0.2)
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            assert not (folder / MARKS).exists()
            done = subprocess.run(command, timeout=400, **how)
        assert done.returncode == 0, (folder / "output.txt").read_text()
        jobs = subprocess.run(
            ["squeue", "--states=all", "--noheader"], env=environment, capture_output=True, text=True, check=True
        )
    assert len(jobs.stdout.splitlines()) >= 3  # growth, spin-up and marks
    assert [mark.attrs["seed"] for mark in read_marks(folder / MARKS)] == [0, 1]
    # what a node has grown is what is grown here
    monkeypatch.chdir(ROOT)
    settings = load("config/config.yaml", "config/spin_up.yaml", folder / "tiny.yaml").grow("q-S", "BAM2", "50")
    for seed, grain in enumerate(read_grains(folder / GRAINS)):
        assert np.array_equal(grain.position, grown(settings, seed).position)


def test_the_profile_for_slurm_keeps_what_the_default_one_says():
    default, slurm = (
        yaml.safe_load((ROOT / "profiles" / name / "config.yaml").read_text()) for name in ("default", "slurm")
    )
    assert default.items() <= slurm.items() and slurm["executor"] == "slurm" and slurm["retries"] > 0
