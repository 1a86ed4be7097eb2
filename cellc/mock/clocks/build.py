"""Makes the clocks that a contract declares."""

from __future__ import annotations

from collections.abc import Callable

from cellc.contract.contract import Contract, ContractClock
from cellc.mock.clocks.clock import Clock, Segment
from cellc.mock.clocks.clocks import Clocks


def build_clocks(contract: Contract, now_ns: Callable[[], int]) -> Clocks:
    """Return the clocks of a cell as they are when it is switched on."""
    clocks = {name: _clock(name, entry) for name, entry in contract.clocks.items()}
    known = {node: clock for node, clock in contract.clock_of.items() if clock in clocks}
    return Clocks(clocks, known, now_ns)


def _clock(name: str, entry: ContractClock) -> Clock:
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
