"""A fault that a cell can meet, what each step may make of it, and how soon."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import FaultEntry, FaultEvent, StepEntry
from cellc.mock.faults.cell_steps import CellStep, cell_steps
from cellc.vocabulary import AttemptOutcome


@dataclass(frozen=True, slots=True)
class Ending:
    """How a step may end that meets a fault.

    Attributes:
        outcomes: names of outcomes; ``succeeded`` among them means that the step may bear the fault.
        within_s: bound from the fault's effect, which is its begin or the start of the step, whatever is later, to the
            end of the step; None where only the timeout of the rehearsal bounds it.
    """

    outcomes: frozenset[AttemptOutcome]
    within_s: float | None = None


BORNE = Ending(frozenset({AttemptOutcome.SUCCEEDED}))
"""A step that the fault does not concern."""


def ends_in(*outcomes: AttemptOutcome, within_s: float | None) -> Ending:
    """Return the ending of a step that the fault concerns."""
    return Ending(frozenset(outcomes), within_s)


@dataclass(frozen=True, slots=True)
class FaultCase:
    """A fault without a time, and the ending of each step that it may hit.

    Attributes:
        entry: kind, target and parameters; neither ``at_s`` nor ``event``.
        endings: by kind and target of a step; every step that a rehearsal of the cell can take is there.
        at_once: a step that executes already meets the fault just as well as one that has not asked for its goal.
    """

    entry: FaultEntry
    endings: Mapping[tuple[str, str], Ending]
    at_once: bool = False

    @property
    def name(self) -> str:
        """The fault in words: its kind, what it hits, and which way a clock jumps."""
        jump_s = self.entry.jump_s
        direction = "" if jump_s is None else "forwards" if jump_s > 0.0 else "back"
        return " ".join(part for part in (self.entry.kind, self.entry.target, direction) if part)

    def at(self, step: int, when: str = "started", after_s: float = 0.0) -> FaultEntry:
        """Return the fault as it begins with a step; ``when`` is started, accepted or moving."""
        event = FaultEvent.model_validate({"step": step, "when": when, "after_s": after_s})
        return self.entry.model_copy(update={"event": event})

    def ending(self, step: StepEntry) -> Ending:
        """Return how one step may end that meets the fault."""
        return self.endings.get((step.kind, step.target), BORNE)

    def outcomes(self, steps: Sequence[StepEntry], first: int, when: str = "started") -> frozenset[AttemptOutcome]:
        """Return the outcomes of a run whose step ``first``, counted from 1, is the first to meet the fault."""
        endings = self._endings(steps, first, when)
        failures = frozenset(
            outcome for ending in _met(endings) for outcome in ending.outcomes - {AttemptOutcome.SUCCEEDED}
        )
        borne = all(AttemptOutcome.SUCCEEDED in ending.outcomes for ending in endings)
        return failures | {AttemptOutcome.SUCCEEDED} if borne else failures

    def within_s(self, steps: Sequence[StepEntry], first: int, when: str = "started") -> float | None:
        """Return the bound of the response of such a run; None where only the rehearsal's timeout bounds it."""
        failing = [ending for ending in _met(self._endings(steps, first, when)) if ending.outcomes != BORNE.outcomes]
        bounds = [ending.within_s for ending in failing if ending.within_s is not None]
        return max(bounds) if failing and len(bounds) == len(failing) else None

    def _endings(self, steps: Sequence[StepEntry], first: int, when: str) -> list[Ending]:
        """Return the endings of a step and of those after it.

        A step that executes already has done its asking, and may be over before the fault is noticed.
        """
        endings = [self.ending(step) for step in steps[first - 1 :]]
        if endings and when != "started" and not self.at_once:
            endings[0] = Ending(endings[0].outcomes | {AttemptOutcome.SUCCEEDED}, endings[0].within_s)
        return endings


def _met(endings: Sequence[Ending]) -> list[Ending]:
    """Return the endings up to the first step that cannot bear the fault."""
    met: list[Ending] = []
    for ending in endings:
        met.append(ending)
        if AttemptOutcome.SUCCEEDED not in ending.outcomes:
            break
    return met


def fault_case(
    entry: FaultEntry, contract: Contract, ending: Callable[[CellStep], Ending], *, at_once: bool = False
) -> FaultCase:
    """Return the case of a fault; ``ending`` says of each step of the cell how it may end."""
    endings = {(step.kind, step.target): ending(step) for step in cell_steps(contract)}
    return FaultCase(entry, endings, at_once)
