"""How often a run that goes on keeps a checkpoint and says how far it is, and how long it still takes."""

import math
import time

__all__ = ["CHECKPOINT", "FORECAST", "LONG", "PROGRESS", "Interval", "Pace"]

CHECKPOINT = 60.0
"""Seconds between two checkpoints."""
PROGRESS = 2.0
"""Seconds between two calls of `progress`."""
FORECAST = 30.0
"""Seconds after which it is foreseen how long a run takes."""
LONG = 86400.0
"""Seconds to go that its user is warned of."""


class Interval:
    """Says at most every so many seconds that it is time to do something; the first time after as many.

    Parameters
    ----------
    seconds : float
    """

    def __init__(self, seconds):
        self.seconds = seconds
        self.last = time.monotonic()

    def passed(self):
        """Whether it is time; if so, the next interval begins."""
        now = time.monotonic()
        if now - self.last < self.seconds:
            return False
        self.last = now
        return True


class Pace:
    """Says how long a run still takes, by its pace in the latter half of the time so far.

    So the beginning, in which code is compiled, and a part with other steps are soon forgotten.

    Parameters
    ----------
    done : float
        What is done when the run begins or goes on.
    """

    def __init__(self, done):
        self.marks = [(time.monotonic(), done)]
        self.begun = self.marks[0]

    def to_go(self, left, done):
        """Seconds in which so much more will be done, when so much is done now; infinite where nothing is yet."""
        now = time.monotonic()
        half = 0.5 * (self.begun[0] + now)
        while len(self.marks) > 1 and self.marks[1][0] <= half:
            del self.marks[0]
        since, before = self.marks[0] if self.marks[0][1] < done else self.begun
        self.marks.append((now, done))
        return max(0.0, left) * (now - since) / (done - before) if done > before else math.inf
