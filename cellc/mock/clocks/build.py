"""Makes the clocks that a contract declares."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from cellc.contract.clock import ContractClock
from cellc.mock.clocks.clock import Clock, Segment
from cellc.mock.clocks.clocks import Clocks


def build_clocks(
    declared: Mapping[str, ContractClock], clock_of: Mapping[str, str], now_ns: Callable[[], int]
) -> Clocks:
    """Return the clocks of a cell as they are when it is switched on.

    Args:
        declared: clocks of the contract by name.
        clock_of: clock of each node, controller and device; one that is not declared counts as not stated.
        now_ns: the simulated time.
    """
    clocks = {name: clock_from(name, entry) for name, entry in declared.items()}
    return Clocks(clocks, {node: clock for node, clock in clock_of.items() if clock in clocks}, now_ns)


def clock_from(name: str, entry: ContractClock) -> Clock:
    """Return a clock that starts at its offset and drifts; one that is disciplined drifts no further than its bound.

    A stated offset beyond the bound stays: that is a discipline that failed before the rehearsal began.
    """
    offset_ns = round(entry.offset_s * 1e9)
    begun = Segment(0, offset_ns, 1.0 + entry.drift)
    segments = [begun]
    if entry.drift != 0.0 and entry.max_offset_s is not None:
        bound_ns = round(entry.max_offset_s * 1e9)
        room_ns = max(0, bound_ns - offset_ns if entry.drift > 0.0 else bound_ns + offset_ns)
        held_ns = round(room_ns / abs(entry.drift))
        segments.append(Segment(held_ns, begun.read(held_ns), 1.0))
    return Clock(name, entry.domain, segments, simulated=entry.simulated)
