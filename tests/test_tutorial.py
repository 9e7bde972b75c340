"""The pages of the tutorial, as a reader would type them; the documentation site is built without a warning."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from ratd.aggregates.particles import read_particles
from tiny_pipeline import ROOT

PAGES = ROOT / "docs" / "tutorial"
BLOCK = re.compile(r'^```(\w+)(?: title="([\w.]+)")?\n(.*?)^```$', re.M | re.S)


def follow(page, folder):
    """Do what a page says in a folder: write its files, run its commands and its Python; all that was printed."""
    said = ""
    environment = os.environ | {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"}
    blocks = BLOCK.findall((PAGES / page).read_text(encoding="utf-8"))
    assert blocks
    for language, title, text in blocks:
        if title:
            (folder / title).write_text(text)
        elif language in ("bash", "python"):
            command = ["bash", "-euo", "pipefail", "-c", text] if language == "bash" else [sys.executable, "-c", text]
            done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=600)
            assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"
            said += done.stdout
    return said


def test_the_omega_of_my_aggregate(tmp_path):
    said = follow("omega_of_my_aggregate.md", tmp_path)
    assert re.search(r"omega_disr = [\d.]+e\+08 ± \S+ rad/s", said)
    # from Python it is that of the start that was not moved, which is one of those of the mean
    mean = float(re.search(r"omega_disr = (\S+)", said)[1])
    assert float(re.search(r"(\S+) rad/s\n$", said)[1]) == pytest.approx(mean, rel=0.2)
    assert {"mine.png", "mine_spin_up.nc", "mine_spin_up.png", "mine_spin_up.html"} <= set(os.listdir(tmp_path))


def test_the_pressure_of_my_cluster(tmp_path):
    said = follow("pressure_of_my_cluster.md", tmp_path)
    assert re.search(r"P at phi 0\.1 = \S+ ± \S+ Pa", said)
    assert re.search(r"[\d.]+ Pa at the filling factor 0\.19\d+\n", said) and "took most of the work" in said
    assert 0.1 < float(re.search(r"(\S+) times P_0", said)[1]) < 3.0
    assert float(re.search(r"(\S+) Pa is its tensile strength", said)[1]) > 0.0
    assert {"mine_compressed.nc", "mine_compressed.png", "mine_compressed.html"} <= set(os.listdir(tmp_path))


def test_only_co_s_and_then_figure_7_in_my_style(tmp_path):
    for name in ("config", "profiles", "workflow", "Snakefile"):
        copy = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copy(ROOT / name, tmp_path / name)
    follow("only_co_s.md", tmp_path)
    results = tmp_path / "results" / "mine"
    table = (results / "ensemble" / "prescribed" / "grains.csv").read_text().splitlines()
    assert len(table) == 1 + 2 * 3 and all("co-S" in line for line in table[1:])
    assert {path.name for path in results.glob("figures/*.png")} == {"figure2_prescribed.png", "figure7_prescribed.png"}
    follow("figure_7_in_my_style.md", tmp_path)
    assert (tmp_path / "mine.pdf").read_bytes()[:5] == b"%PDF-"


def test_in_3d(tmp_path):
    follow("in_3d.md", tmp_path)
    assert (tmp_path / "chain_spin_up.html").read_text().startswith("<!doctype html>")
    first, last = (read_particles(tmp_path / "chain_snapshots.xyz", frame=frame) for frame in (0, -1))
    assert len(first.radius) >= len(last.radius) > 0


def test_every_page_is_followed_here_or_needs_a_cluster():
    """What the page on clusters says of Slurm is tried in tests/workflow/test_slurm.py."""
    followed = set(re.findall(r'follow\("([\w.]+)"', Path(__file__).read_text()))
    assert {path.name for path in PAGES.glob("*.md")} == followed | {"on_my_cluster.md"}


def test_the_site_is_built_without_a_warning(tmp_path):
    pytest.importorskip("mkdocstrings")
    build = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(tmp_path / "site")]
    done = subprocess.run(
        build, cwd=ROOT, env=os.environ | {"NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    site = tmp_path / "site"
    assert "read_particles" in (site / "api" / "index.html").read_text()
    # formulae are there without a network
    laws = (site / "model" / "laws" / "index.html").read_text()
    assert laws.count("<math") > 100 and "<msqrt>" in laws and "arithmatex" not in laws
    fetched = re.findall(r'<script[^>]+src="(https?:)?//', laws)
    assert fetched == []
