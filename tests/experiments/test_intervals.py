"""How long a run still takes."""

import math

import pytest

from ratd.experiments import intervals


@pytest.fixture
def clock(monkeypatch):
    """A clock that goes only when it is told to."""

    class Clock:
        now = 1000.0

        def monotonic(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(intervals, "time", clock)
    return clock


def test_an_even_pace_is_carried_on(clock):
    pace = intervals.Pace(0.2)
    for part in (0.3, 0.4, 0.7):
        clock.now += 600.0 * part - (clock.now - 1000.0) - 120.0
        assert pace.to_go(1.0 - part, part) == pytest.approx(600.0 * (1.0 - part))


def test_a_slow_beginning_is_forgotten(clock):
    """Ten minutes go by before anything is done, then a thousandth of all is done in each second."""
    pace = intervals.Pace(0.0)
    clock.now += 600.0
    told = {}
    for second in range(1, 1001):
        clock.now += 1.0
        told[second] = pace.to_go(1.0 - second / 1000.0, second / 1000.0)
    assert told[100] == pytest.approx(900.0 * 7.0)
    assert told[900] == pytest.approx(100.0)


def test_a_run_that_rests_is_told_by_what_it_did_before(clock):
    pace = intervals.Pace(0.0)
    clock.now += 10.0
    assert pace.to_go(0.5, 0.5) == pytest.approx(10.0)
    for _ in range(50):
        clock.now += 10.0
        found = pace.to_go(0.5, 0.5)
    assert found == pytest.approx(510.0)


def test_nothing_done_takes_for_ever_and_nothing_left_no_time(clock):
    pace = intervals.Pace(0.0)
    clock.now += 1.0
    assert pace.to_go(1.0, 0.0) == math.inf
    assert pace.to_go(-1e-20, 1.0) == 0.0
