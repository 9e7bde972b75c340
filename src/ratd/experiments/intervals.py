"""How often a run that goes on keeps a checkpoint and says how far it is, and when it warns that it is long."""

import time

__all__ = ["CHECKPOINT", "FORECAST", "LONG", "PROGRESS", "Interval"]

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
        self.start = self.last = time.monotonic()

    def passed(self):
        """Whether it is time; if so, the next interval begins."""
        now = time.monotonic()
        if now - self.last < self.seconds:
            return False
        self.last = now
        return True

    def elapsed(self):
        """Seconds since the beginning."""
        return time.monotonic() - self.start
