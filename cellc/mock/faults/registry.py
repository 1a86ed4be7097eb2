"""What a fault is, its injection into a rehearsal, and every fault of the mock, named once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from typing import Protocol, runtime_checkable

from cellc.contract.attempt import AttemptRecord
from cellc.contract.contract import Contract
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.errors import FaultMissedError, MockError
from cellc.mock.faults import frames, goals, joints, network, parts, programs, samples, sensors, stops
from cellc.mock.faults.cases import FaultCase
from cellc.mock.faults.ports import FaultPorts


class Fault(Protocol):
    """Something that goes wrong in a running cell; ``begin`` and ``end`` are called at their times."""

    def begin(self, ports: FaultPorts) -> None:
        """Let it go wrong from now on."""
        ...

    def end(self, ports: FaultPorts) -> None:
        """Let it be right again, for a fault that lasts."""
        ...


@runtime_checkable
class FaultType(Protocol):
    """What the class of a fault offers beside: the kind that it plays, and its cases."""

    kind: FaultKind

    def of(self, entry: FaultEntry, contract: Contract) -> Fault | None:
        """Return the fault of an entry; None where the entry names what this fault cannot hit."""
        ...

    def cases(self, contract: Contract) -> Iterator[FaultCase]:
        """Yield the fault with every target that a cell has, and what its steps may make of it."""
        ...


class Injection:
    """One entry of rehearsals.json with its fault.

    Attributes:
        start_ns: when the fault began; None before, and for ever where its event never comes.
    """

    def __init__(self, entry: FaultEntry, fault: Fault) -> None:
        """Bind a fault to its entry; nothing happens before ``schedule``."""
        self.entry = entry
        self.start_ns: int | None = None
        self._fault = fault
        self._missed = ""

    @property
    def touched(self) -> bool:
        """Tell whether the fault began, or tried to."""
        return self.start_ns is not None or bool(self._missed)

    def describe_absence(self) -> str:
        """Say why the fault never began."""
        name = f"fault `{self.entry.kind} {self.entry.target}`"
        event = self.entry.event
        if self._missed:
            return f"{name} never began: {self._missed}"
        if self.entry.phase is not None:
            return f"{name} never began: the bring-up has no phase `{self.entry.phase}`"
        if event is None:
            return f"{name} never began: the rehearsal was over before {self.entry.at_s:g} s"
        return f"{name} never began: step {event.step} was never `{event.when}`, or was over too soon"

    def schedule(self, ports: FaultPorts, start_ns: int) -> None:
        """Let the fault begin, counted from ``start_ns`` or from its event."""
        event = self.entry.event
        if self.entry.phase is not None:
            ports.start.expect(self.entry.phase, partial(self._begin, ports))
        elif event is None:
            self._begin_at(ports, start_ns + round((self.entry.at_s or 0.0) * 1e9))
        elif event.after_s > 0.0:
            delay_ns = round(event.after_s * 1e9)
            ports.milestones.expect(
                event.step, event.when, lambda: self._begin_at(ports, ports.schedule.now_ns + delay_ns)
            )
        else:
            ports.milestones.expect(event.step, event.when, partial(self._begin, ports))

    def _begin_at(self, ports: FaultPorts, at_ns: int) -> None:
        ports.schedule.at(at_ns, partial(self._begin, ports))

    def _begin(self, ports: FaultPorts) -> None:
        try:
            self._fault.begin(ports)
        except FaultMissedError as missed:
            self._missed = str(missed)
            return
        self.start_ns = ports.schedule.now_ns
        if self.entry.lasting_s is not None:
            end_ns = ports.schedule.now_ns + round(self.entry.lasting_s * 1e9)
            ports.schedule.at(end_ns, partial(self._fault.end, ports))


def any_started(injections: Iterable[Injection]) -> bool:
    """Tell whether a fault has started, or was to begin and changed the cell on its way."""
    return any(injection.touched for injection in injections)


_MODULES = (samples, frames, network, goals, joints, stops, programs, sensors, parts)
FAULTS: Mapping[FaultKind, FaultType] = {
    played.kind: played
    for module in _MODULES
    for played in vars(module).values()
    if isinstance(played, FaultType) and getattr(played, "__module__", "") == module.__name__
}
"""The classes of these modules that have a kind."""


def build_fault(entry: FaultEntry, contract: Contract) -> Fault:
    """Return the fault of an entry; raise MockError where it has no moment or names what it cannot hit."""
    if [entry.at_s, entry.event, entry.phase].count(None) != 2:
        reason = f"fault `{entry.kind}` needs either a time or an event that starts it"
        raise MockError(contract.files.rehearsals, reason)
    fault = FAULTS[entry.kind].of(entry, contract)
    if fault is None:
        reason = f"fault `{entry.kind}` names `{entry.target}`, which it cannot hit in this cell"
        raise MockError(contract.files.rehearsals, reason)
    return fault


def possible_faults(contract: Contract) -> tuple[FaultCase, ...]:
    """Return every fault that a cell can meet, with what each of its steps may make of it."""
    return tuple(case for kind in FaultKind if kind in FAULTS for case in FAULTS[kind].cases(contract))


def response_s(injections: Sequence[Injection], records: Sequence[AttemptRecord]) -> float | None:
    """Return the time from the last fault taking effect to the bounded end of the attempt that it ended.

    A cancel takes effect when it is requested and ends when the joints stand still. Any other fault takes effect when
    it begins, or when the attempt begins that meets it, and ends with the attempt.
    """
    attempts = records[:-1]
    if not attempts:
        return None
    ended = next((record for record in attempts if record.outcome != AttemptOutcome.SUCCEEDED), attempts[-1])
    # What began after that end did not cause it.
    starts = [
        injection.start_ns
        for injection in injections
        if injection.start_ns is not None and injection.start_ns <= ended.ended_ns
    ]
    if not starts:
        return None
    if ended.outcome == AttemptOutcome.CANCELED and ended.cancel is not None:
        return ended.cancel.latency_s
    return (ended.ended_ns - max(*starts, ended.started_ns)) / 1e9
