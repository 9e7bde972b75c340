"""The queue: order, what is left, what fails; its files are tested with those of the experiments."""

import fcntl
import time
from functools import partial
from types import SimpleNamespace

import pytest

from ratd.pipeline.queue import Task, command, key, state, work


class Kept:
    """A table in memory."""

    path = "kept.nc"

    def __init__(self, *keys):
        self.keys, self.rows, self.written, self.asked = set(keys), [], 0, 0

    def add(self, row):
        self.rows.append(row)
        self.keys.add(row)

    def write_if_due(self):
        self.asked += 1

    def write(self):
        self.written += 1


def row(number):
    return key(number), f"row {number}"


def fails():
    raise RuntimeError("a velocity is no finite number")


@pytest.mark.parametrize("processes", [1, 2])
def test_what_is_there_is_left_out_and_what_fails_is_told(processes):
    table, said = Kept(key(2)), []
    tasks = [Task(table, key(number), partial(row, number)) for number in range(4)] + [Task(table, key(4), fails)]
    assert state(tasks, "rows") == "kept.nc: 1 of 5 rows"
    assert work(tasks, say=said.append, processes=processes) == 1
    assert sorted(table.rows) == [key(0), key(1), key(3)] and table.written == 1
    assert len(said) == 4 and sum(text.startswith("failed: a velocity is no finite number, 0 s") for text in said) == 1


def test_an_error_of_the_program_ends_the_queue_and_nothing_is_lost():
    table = Kept()
    tasks = [Task(table, key(0), partial(row, 0)), Task(table, key(1), lambda: 1 / 0)]
    with pytest.raises(ZeroDivisionError):
        work(tasks, say=lambda text: None)
    assert table.rows == [key(0)] and table.written == 1


def test_no_row_is_begun_when_the_time_is_up():
    table = Kept()
    tasks = [Task(table, key(number), partial(row, number)) for number in range(3)]
    assert work(tasks, until=time.monotonic() - 1.0, say=lambda text: None, processes=2) == 3 and not table.rows


def test_keys_that_differ_by_rounding_are_the_same():
    assert key(0.1 + 0.2, 3) == key(0.3, 3.0) != key(0.3, 4)


def test_a_table_that_gets_no_row_any_more_is_still_written():
    first, second = Kept(), Kept()
    tasks = [Task(first, key(0), partial(row, 0))]
    tasks += [Task(second, key(number), partial(row, number)) for number in range(3)]
    work(tasks, say=lambda text: None)
    assert first.asked == second.asked == 4


def test_a_command_that_waited_reads_what_the_other_one_left(tmp_path):
    """The tables are read with the lock held: rows that were made meanwhile are not made again."""
    held = []
    lock = tmp_path / "queue.lock"

    def tasks(plan, folder):
        with open(lock, "a") as handle, pytest.raises(BlockingIOError):
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        held.append(folder)
        return []

    module = SimpleNamespace(__spec__=SimpleNamespace(name="none"), __doc__="Nothing.")
    how = {"config": (), "data": "data", "load": lambda: SimpleNamespace(results=tmp_path), "tasks": tasks}
    assert command([], module=module, what="rows", **how) == 0 and held == ["data"]
