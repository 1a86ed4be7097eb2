"""What a fault is, and its injection: begun at its time or with its event, ended after its duration."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Protocol

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.case import FaultCase
from cellc.mock.faults.ports import FaultPorts
from cellc.vocabulary import FaultKind


class Fault(Protocol):
    """Something that goes wrong in a running cell; ``begin`` and ``end`` are called at their times."""

    def begin(self, ports: FaultPorts) -> None:
        """Let it go wrong from now on."""
        ...

    def end(self, ports: FaultPorts) -> None:
        """Let it be right again, for a fault that lasts."""
        ...


class FaultType(Protocol):
    """What the class of a fault offers beside; ``registry.FAULTS`` names every class."""

    kind: FaultKind

    def of(self, entry: FaultEntry, contract: Contract) -> Fault | None:
        """Return the fault of an entry; None where the entry names what this fault cannot hit."""
        ...

    def cases(self, contract: Contract) -> Iterator[FaultCase]:
        """Yield the fault with every target that a cell has, and what its steps may make of it."""
        ...


class Injection:
    """One entry of rehearsals.json with the fault that it stands for.

    Attributes:
        begun_ns: when the fault began; None before, and for ever where its event never comes.
    """

    def __init__(self, entry: FaultEntry, fault: Fault) -> None:
        """Bind a fault to its entry; nothing happens before ``schedule``."""
        self.entry = entry
        self.begun_ns: int | None = None
        self._fault = fault

    def describe_absence(self) -> str:
        """Say why the fault never began."""
        name = f"fault `{self.entry.kind} {self.entry.target}`"
        event = self.entry.event
        if event is None:
            return f"{name} never began: the rehearsal was over before {self.entry.at_s:g} s"
        return f"{name} never began: step {event.step} was never `{event.when}`, or was over too soon"

    def schedule(self, ports: FaultPorts, start_ns: int) -> None:
        """Let the fault begin, counted from ``start_ns`` or from its event."""
        event = self.entry.event
        if event is None:
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
        self.begun_ns = ports.schedule.now_ns
        self._fault.begin(ports)
        if self.entry.lasting_s is not None:
            end_ns = ports.schedule.now_ns + round(self.entry.lasting_s * 1e9)
            ports.schedule.at(end_ns, partial(self._fault.end, ports))
