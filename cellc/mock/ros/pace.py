"""How the time of a run goes beside that of the host: in lockstep with the nodes under test, or at a pace."""

from __future__ import annotations

from time import monotonic, sleep

LATE_S = 0.02
"""A host that is later than this is reported: nodes saw time jump."""


class Pacer:
    """Lets the time of a run pass no faster than its pace.

    Attributes:
        latest_s: by how much the host was late at most.
    """

    def __init__(self, pace: float) -> None:
        """Begin with the first instant that is kept."""
        self.latest_s = 0.0
        self._pace = pace
        self._start: tuple[float, int] | None = None

    def keep(self, now_ns: int) -> None:
        """Sleep until an instant of the run has come."""
        if self._start is None:
            self._start = monotonic(), now_ns
        began_s, began_ns = self._start
        early_s = began_s + (now_ns - began_ns) / 1e9 / self._pace - monotonic()
        if early_s > 0.0:
            sleep(early_s)
        else:
            self.latest_s = max(self.latest_s, -early_s)
