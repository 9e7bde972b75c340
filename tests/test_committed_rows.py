"""Rows that the queues have left in docs were made with the config that is there, so that each queue can go on."""

from importlib import import_module

import pytest

from ratd.pipeline import queue
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
    """It knows every row and every file that is there: what it did not know it would compute again, for weeks."""
    tasks = []
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(queue, "state", lambda own, what: tasks.extend(own))
    assert import_module(name).main(["--list"]) == 0, capsys.readouterr().err
    tables = {task.table.path: task.table for task in tasks}
    for path, table in tables.items():
        wanted = {task.key for task in tasks if task.table.path == path}
        assert len(table.keys) == len(table.rows) and table.keys <= wanted, path
    files = {file for path in tables for file in path.parent.glob("*.nc")}
    assert files and files <= tables.keys()
