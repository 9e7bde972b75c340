"""The queue: order, what is left, what fails; its files are tested with those of the experiments."""

import fcntl
import time
from functools import partial
from types import SimpleNamespace

import pytest

from files import make_grain
from ratd.aggregates.files import grain_row
from ratd.base.errors import GrainError, InputError
from ratd.base.materials import MATERIALS
from ratd.pipeline import queue
from ratd.pipeline.queue import Table, Task, command, key, state, work

MODULE = SimpleNamespace(__spec__=SimpleNamespace(name="none"), __doc__="Nothing.")


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


def comes_apart():
    raise GrainError("the aggregate comes apart")


def is_misused():
    raise InputError("x is 3; allowed: 1 or 2")


def test_a_grain_that_cannot_be_made_ends_nothing_else_and_bad_input_ends_all():
    table, said = Kept(), []
    tasks = [Task(table, key(0), comes_apart), Task(table, key(1), partial(row, 1))]
    assert work(tasks, say=said.append) == 1
    assert table.rows == [key(1)] and said[0].startswith("failed: the aggregate comes apart")
    with pytest.raises(InputError, match="x is 3"):
        work([Task(table, key(2), is_misused)], say=said.append)


def test_a_row_that_took_long_is_written_at_once(monkeypatch):
    monkeypatch.setattr(queue, "WRITE_EVERY", 0.1)
    table = Kept()
    written = []
    work(
        [Task(table, key(0), partial(late, 0)), Task(table, key(1), partial(row, 1))],
        say=lambda _: written.append(table.written),
    )
    assert written == [1, 1]


def test_an_error_of_the_program_ends_the_queue_and_nothing_is_lost():
    table = Kept()
    tasks = [Task(table, key(0), partial(row, 0)), Task(table, key(1), lambda: 1 / 0)]
    with pytest.raises(ZeroDivisionError):
        work(tasks, say=lambda text: None)
    assert table.rows == [key(0)] and table.written == 1


def divides():
    return 1 / 0


def late(number):
    time.sleep(0.3)
    return row(number)


def test_an_error_in_one_process_keeps_what_another_is_at_work_on():
    table = Kept()
    tasks = [Task(table, key(0), partial(late, 0)), Task(table, key(1), divides), Task(table, key(2), partial(row, 2))]
    with pytest.raises(ZeroDivisionError):
        work(tasks, say=lambda text: None, processes=2)
    assert table.rows[:1] == [key(0)] and table.written == 1


@pytest.mark.parametrize("processes", [1, 2])
def test_no_row_is_begun_when_the_time_is_up(processes):
    table = Kept()
    tasks = [Task(table, key(number), partial(row, number)) for number in range(3)]
    over = time.monotonic() - 1.0
    assert work(tasks, until=over, say=lambda text: None, processes=processes) == 3 and not table.rows


def test_keys_that_differ_by_rounding_are_the_same():
    assert key(0.1 + 0.2, 3) == key(0.3, 3.0) != key(0.3, 4)


def test_keys_of_near_numbers_differ():
    assert key(12345) != key(12346) and key(350e-9) != key(350.001e-9)
    # seeds have more digits than a float that is rounded
    assert key(3e-7, 2147483640) != key(3e-7, 2147483641)


def test_a_table_that_gets_no_row_any_more_is_still_written():
    first, second = Kept(), Kept()
    tasks = [Task(first, key(0), partial(row, 0))]
    tasks += [Task(second, key(number), partial(row, number)) for number in range(3)]
    work(tasks, say=lambda text: None)
    assert first.asked == second.asked == 4


def test_a_command_that_waited_reads_what_the_other_one_left(tmp_path):
    """The tables are read with the lock held: rows that were made meanwhile are not made again."""
    held = []
    lock = tmp_path / "data/.lock"

    def tasks(plan, folder):
        with open(lock, "a") as handle, pytest.raises(BlockingIOError):
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        held.append(folder)
        return []

    data = str(tmp_path / "data")
    how = {"config": (), "data": data, "load": lambda: SimpleNamespace(results=tmp_path), "tasks": tasks}
    assert command([], module=MODULE, what="rows", **how) == 0 and held == [data]


def test_a_command_tells_of_what_is_left_and_takes_minutes_and_processes(tmp_path, monkeypatch, capsys):
    seen = {}

    def leave_all(wanted, *, until, say, processes):
        seen.update(until=until, processes=processes)
        return len(wanted)

    monkeypatch.setattr(queue, "work", leave_all)
    monkeypatch.setattr(queue.time, "monotonic", lambda: 1000.0)
    how = {"module": MODULE, "what": "rows", "config": (), "data": str(tmp_path / "data")}
    how["load"] = lambda: SimpleNamespace(results=tmp_path)
    assert command(["--minutes", "2", "--processes", "3"], tasks=lambda plan, folder: [1], **how) == 3
    assert seen == {"until": 1120.0, "processes": 3}
    assert command([], tasks=lambda plan, folder: [], **how) == 0 and seen == {"until": None, "processes": 1}
    with pytest.raises(SystemExit):
        command(["--processes", "0"], tasks=lambda plan, folder: [], **how)
    assert "--processes: '0'; allowed: a whole number of at least 1" in capsys.readouterr().err


def test_rows_that_come_soon_after_each_other_are_written_together(monkeypatch):
    now, written = [0.0], []
    monkeypatch.setattr(queue.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(queue.io, "write", lambda path, block, kind: written.append((now[0], block.sizes["row"])))
    table = Table("none.nc", "grains", ("seed",), MATERIALS["q-S"], {})
    for seed, now[0] in enumerate((1.0, 10.0, 20.0, 22.0, 42.0, 43.0)):
        table.add(grain_row(make_grain(seed), 1e8))
        table.write_if_due()
    assert written == [(1.0, 1), (22.0, 4), (43.0, 6)]
