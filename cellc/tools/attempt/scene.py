"""What a step is judged by: what was said and seen meanwhile, and the safety state at an instant."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractBand
from cellc.contract.vocabulary import AttemptOutcome, Need
from cellc.mock.stops import recovery_state
from cellc.tools.attempt.follow import HOLDS, Change, Followed, Line, Snapshot
from cellc.tools.attempt.steps import Made

_ERROR = 40
NORMAL, PROTECTIVE, EMERGENCY, FAULT = "normal", "protective_stop", "emergency_stop", "fault"
STOPPED = "stopped"
"""Of a component that leaves active alike in several stops: which one it is, its lifecycle does not tell."""
STOPS = {
    PROTECTIVE: AttemptOutcome.PROTECTIVE_STOP,
    EMERGENCY: AttemptOutcome.EMERGENCY_STOP,
    FAULT: AttemptOutcome.HARDWARE_FAULT,
}


@dataclass(frozen=True, slots=True)
class Scene:
    """What a step is judged by.

    Attributes:
        until_ns: when the next step began, or the end of the bag.
        bands: where the joints of grippers must be that hold a part from an earlier step.
        components: names of hardware components, and of devices behind an adapter.
        controllers: names of controllers.
        acting_on: dynamic frame whose observations must keep arriving, from an earlier move.
    """

    contract: Contract
    followed: Followed
    from_ns: int
    until_ns: int
    bands: tuple[ContractBand, ...]
    components: frozenset[str]
    controllers: frozenset[str]
    planner: str
    acting_on: str | None = None

    def lines(self) -> Iterator[Line]:
        """Yield what was said meanwhile."""
        yield from (line for line in self.followed.lines if self.from_ns <= line.at_ns <= self.until_ns)

    def task_line(self) -> Line | None:
        """Return the last error that neither a controller nor hardware nor the planner said meanwhile."""
        others = {*self.components, *self.controllers, self.planner}
        said = [line for line in self.lines() if line.level >= _ERROR and line.node not in others]
        return said[-1] if said else None

    def last(self, made: Made) -> Snapshot:
        """Return what was known as the step was ended: at its cancel request, at its end, or at the end of the bag."""
        line = self.task_line()
        for goal in reversed(made.goals):
            after = None if line is None or not made.is_good else line.before
            return goal.canceling or after or goal.ended or self.followed.end
        if line is not None and line.before is not None and not made.plans:
            return line.before
        return made.plans[-1].before if made.plans else self.followed.end


def _meant(contract: Contract, component: str, lifecycle: str) -> str:
    """Return the safety state that a lifecycle state of a component, or of a device behind an adapter, means."""
    if lifecycle == "active":
        return NORMAL
    devices = [each for name, each in contract.devices.items() if component in (name, each.hardware_component)]
    stops = {recovery_state(name) for each in devices for name, stop in each.stops.items() if stop.leaves == lifecycle}
    return STOPPED if len(stops) > 1 else next(iter(stops), PROTECTIVE if lifecycle == "inactive" else FAULT)


def _stop_of(contract: Contract, change: Change) -> str:
    """Return the stop that ends what a device needs; STOPPED where several do."""
    device = contract.devices.get(change.subject)
    stops = {} if device is None else device.stops
    names = {recovery_state(name) for name, stop in stops.items() if change.kind in stop.ends}
    return next(iter(names)) if len(names) == 1 else STOPPED


def safety_at(
    contract: Contract, followed: Followed, components: frozenset[str], at_ns: int
) -> tuple[str | None, str, int]:
    """Return the safety state at an instant, what shows it, and since when; None where nothing of the bag tells."""
    found: dict[str, tuple[str, str, int]] = {}
    known = False
    for change in followed.changes:
        if change.at_ns <= at_ns and change.kind == "Hardware Components":
            known = True
            state = _meant(contract, change.subject, change.state)
            found[change.subject] = state, f"hardware component {change.subject} is {change.state}", change.at_ns
        elif change.at_ns <= at_ns and change.kind == Need.NO_STOP:
            known = True
            text = f"{change.topic} of {change.subject}: {change.state}"
            found[change.topic] = (NORMAL if change.state == HOLDS else _stop_of(contract, change)), text, change.at_ns
    for line in followed.lines:
        said = line.text.removeprefix("reports ")
        became = line.text.removeprefix(f"{line.node} became ").partition(":")[0]
        if line.at_ns <= at_ns and line.node in components and became != line.text.partition(":")[0]:
            state = _meant(contract, line.node, became)
            found[line.node] = state, f"hardware component {line.text}", line.at_ns
        # What ends at that instant lasted until it.
        was_said = line.at_ns < at_ns if said == NORMAL else line.at_ns <= at_ns
        if was_said and line.node in components and said in (NORMAL, *STOPS):
            found[line.node] = said, f"hardware component {line.node} {line.text}", line.at_ns
    for state in (EMERGENCY, FAULT, PROTECTIVE, STOPPED):
        for shown, words, since_ns in found.values():
            if shown == state:
                return state, words, since_ns
    return (NORMAL if known else None), "", 0
