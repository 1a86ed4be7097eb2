"""All clocks of a cell: whose clock a node stamps with and ages on, jumps, and replay of a recording."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from cellc.mock.clocks.clock import Clock, perfect_clock

DEFAULT = "ros"
"""Name and domain of the clock of everything whose host the contract does not state."""


@dataclass(frozen=True, slots=True)
class TimeJump:
    """A clock was set: by ``delta_ns``, or to another source of time where ``source_changed``."""

    clock: Clock
    delta_ns: int
    at_ns: int
    source_changed: bool = False


class Clocks:
    """The clocks of the cell by name, and the clock of each node, device and controller.

    Attributes:
        jumps: every jump so far, in order.
    """

    def __init__(self, clocks: Mapping[str, Clock], clock_of: Mapping[str, str], now_ns: Callable[[], int]) -> None:
        """Bind the clocks.

        Args:
            clocks: by name.
            clock_of: name of the clock of each node, device and controller; others share one that starts perfect.
            now_ns: the simulated time.
        """
        self.jumps: list[TimeJump] = []
        self._clocks = {DEFAULT: perfect_clock(DEFAULT, DEFAULT), **clocks}
        self._default = self._clocks[DEFAULT]
        self._of = {node: self._clocks[name] for node, name in clock_of.items()}
        self._now_ns = now_ns
        self._listeners: list[Callable[[TimeJump], None]] = []

    def of(self, node: str) -> Clock:
        """Return the clock that a node, device or controller stamps with."""
        return self._of.get(node, self._default)

    def now_ns(self, node: str) -> int:
        """Return what a node calls now."""
        return self.of(node).read(self._now_ns())

    def age_ns(self, node: str, stamp_ns: int) -> int:
        """Return the age of a stamp on the clock of the node that consumes it; negative for one from the future."""
        return self.now_ns(node) - stamp_ns

    def stale_at_ns(self, node: str, stamp_ns: int, max_age_ns: int) -> int:
        """Return the first simulated instant, from now on, at which a node finds a stamp older than ``max_age_ns``."""
        return self.of(node).when(stamp_ns + max_age_ns + 1, self._now_ns())

    def names(self) -> tuple[str, ...]:
        """Return the names of all clocks, sorted; each belongs to a host or a device."""
        return tuple(sorted(self._clocks))

    def select(self, name: str) -> tuple[Clock, ...]:
        """Return the clocks that have this name or belong to the domain of this name.

        Raises:
            KeyError: there is none.
        """
        chosen = tuple(clock for clock in self._clocks.values() if name in (clock.name, clock.domain))
        if not chosen:
            raise KeyError(name)
        return chosen

    def listen(self, listener: Callable[[TimeJump], None]) -> None:
        """Call ``listener`` right after every jump."""
        self._listeners.append(listener)

    def jump(self, name: str, delta_ns: int) -> None:
        """Set a clock, or all clocks of a domain, forwards or, with a negative ``delta_ns``, back.

        Raises:
            KeyError: neither a clock nor a domain has this name.
        """
        at_ns = self._now_ns()
        for clock in self.select(name):
            clock.jump(delta_ns, at_ns)
            self._tell(TimeJump(clock, delta_ns, at_ns))

    def replay(self, recorded_ns: int, rate: float = 1.0) -> None:
        """Let every node live in the time of a recording from now on, as `use_sim_time` and a played bag do.

        Args:
            recorded_ns: stamp at which the recording begins.
            rate: seconds of the recording in one second.
        """
        at_ns = self._now_ns()
        for clock in self._clocks.values():
            delta_ns = recorded_ns - clock.read(at_ns)
            source_changed = not clock.simulated
            clock.restart(recorded_ns, rate, at_ns)
            clock.simulated = True
            self._tell(TimeJump(clock, delta_ns, at_ns, source_changed))

    def _tell(self, jump: TimeJump) -> None:
        self.jumps.append(jump)
        for listener in self._listeners:
            listener(jump)
