"""Rows that the queues have left in docs were made with the config that is there, so that each queue can go on."""

from importlib import import_module

import pytest

from tiny_pipeline import ROOT

QUEUES = (
    "ratd.experiments.spin_up.study",
    "ratd.experiments.spin_up.shapes",
    "ratd.experiments.collision.study",
    "ratd.validation.pulling",
    "ratd.validation.lammps_spin_up",
    "ratd.validation.lammps_single",
)


@pytest.mark.parametrize("name", QUEUES)
def test_a_queue_goes_on_where_it_was(name, monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    assert import_module(name).main(["--list"]) == 0, capsys.readouterr().err
    counts = [line.rpartition(": ")[2].split() for line in capsys.readouterr().out.splitlines()]
    assert counts and all(int(there) <= int(wanted) for there, _, wanted, *_ in counts)
