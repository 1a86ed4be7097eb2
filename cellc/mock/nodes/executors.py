"""Callbacks that wait for each other: what shares a thread or a mutually exclusive group executes one at a time."""

from __future__ import annotations

from collections.abc import Callable

from cellc.contract.entities import Processing
from cellc.mock.engine.simulation import Simulation


class Executors:
    """Of all nodes whose callbacks the contract states; each callback takes as long as is stated, in order of arrival.

    Timers and services are left out: the mock executes neither in nodes of the cell.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Bind the executors of one run."""
        self._simulation = simulation
        self._free_ns: dict[str, int] = {}

    def execute(self, processing: Processing, done: Callable[[], None]) -> None:
        """Call ``done`` when a callback has ended that is ready now."""
        now_ns = self._simulation.now_ns
        begin_ns = max(now_ns, self._free_ns.get(processing.line, now_ns)) if processing.line else now_ns
        end_ns = begin_ns + round(processing.takes_s * 1e9)
        self._free_ns[processing.line] = end_ns
        self._simulation.at_background(end_ns, done)
