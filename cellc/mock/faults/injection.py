"""A fault of a rehearsal: begun at its time or with its event, ended after its duration, and when that was."""

from __future__ import annotations

from functools import partial

from cellc.contract.rehearsals import FaultEntry
from cellc.mock.faults.fault import Fault
from cellc.mock.plant import Plant


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

    def schedule(self, plant: Plant, start_ns: int) -> None:
        """Let the fault begin, counted from ``start_ns`` or from its event."""
        event = self.entry.event
        if event is None:
            self._begin_at(plant, start_ns + round((self.entry.at_s or 0.0) * 1e9))
        elif event.after_s > 0.0:
            delay_ns = round(event.after_s * 1e9)
            plant.progress.expect(event.step, event.when, lambda: self._begin_at(plant, plant.now_ns + delay_ns))
        else:
            plant.progress.expect(event.step, event.when, partial(self._begin, plant))

    def _begin_at(self, plant: Plant, at_ns: int) -> None:
        plant.simulation.at(at_ns, partial(self._begin, plant))

    def _begin(self, plant: Plant) -> None:
        self.begun_ns = plant.now_ns
        self._fault.begin(plant)
        if self.entry.lasting_s is not None:
            end_ns = plant.now_ns + round(self.entry.lasting_s * 1e9)
            plant.simulation.at(end_ns, partial(self._fault.end, plant))
