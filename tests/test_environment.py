"""The pinned environment: complete, the same everywhere, and what is installed here."""

import re
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import yaml

from ratd.validation import peer_lammps

ROOT = Path(__file__).parents[1]


def lines():
    text = (ROOT / "environment.txt").read_text()
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def pinned():
    return dict(line.split("==") for line in lines() if not line.startswith("-e"))


def test_every_line_is_pinned_and_the_project_is_included():
    assert lines()[-1] == "-e ."
    assert all(re.fullmatch(r"[A-Za-z0-9_.-]+==[0-9][A-Za-z0-9.]*", line) for line in lines()[:-1])


def test_what_the_project_asks_for_is_pinned():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert {re.match(r"[\w.-]+", name).group() for name in project["dependencies"]} <= set(pinned())


def test_lammps_is_pinned_and_named_where_it_is_missing():
    text = (ROOT / "environment-lammps.txt").read_text()
    pins = dict(line.split("==") for line in text.splitlines() if not line.startswith("#"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert set(project["optional-dependencies"]["lammps"]) == set(pins)
    assert not set(pins) & set(pinned())
    assert peer_lammps.INSTALL in text


def test_what_tests_need_beside_is_pinned_once():
    text = (ROOT / "environment-tests.txt").read_text()
    pins = dict(line.split("==") for line in text.splitlines() if line and not line.startswith("#"))
    assert pins and not set(pins) & set(pinned())
    assert "pip install -r environment-tests.txt" in text


def test_what_is_installed_is_what_is_pinned():
    assert {name: metadata.version(name) for name in pinned()} == pinned()


def test_environment_of_conda_has_the_same_versions():
    environment = yaml.safe_load((ROOT / "workflow" / "envs" / "ratd.yaml").read_text())
    *packages, project = environment["dependencies"][-1]["pip"]
    assert project == "../.."
    assert dict(package.split("==") for package in packages).items() <= pinned().items()


def test_small_numbers_are_compared_by_their_part():
    """As pytest has it, every energy below 1e-12 J would equal every other."""
    assert 0.0 != pytest.approx(1.47e-17, rel=5e-3) and 1.48e-17 != pytest.approx(1.47e-17)
    assert 1.4701e-17 == pytest.approx(1.47e-17, rel=1e-3) and 1e-13 == pytest.approx(0.0, abs=1e-12)
