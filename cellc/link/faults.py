"""Binds the faults of a rehearsal: what they hit, when they begin, and by how much."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.cell.rehearsal import Fault, Step, StepEvent
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.link.fault_names import Target
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.faults import (
    FAULT_KEYS,
    CancelFault,
    DelayFault,
    DisplaceFault,
    EventSpec,
    FaultSpec,
    JumpClockFault,
    ScaleSpeedFault,
    SkipCyclesFault,
    SlowFault,
    first_key,
)

SENDS_GOALS = ("move", "grip")
"""Steps whose goal a controller accepts, so that joints move."""


def link_fault(
    fault: FaultSpec,
    document: SourceDocument,
    path: YamlPath,
    targets: Mapping[str, Target],
    steps: tuple[Step, ...],
) -> Outcome[Fault]:
    """Bind one fault.

    Args:
        targets: what each kind of fault may hit.
        steps: of the rehearsal, which the fault may wait for.
    """
    kind = first_key(fault, FAULT_KEYS)
    assert kind is not None  # a fault is told by its key
    name, problems = _target(fault, kind, document, path, targets)
    at = fault.at
    event = _event(at) if isinstance(at, EventSpec) else None
    bound = Fault(
        name=name,
        path=path,
        span=document.locate(path),
        kind=kind,
        at_s=None if isinstance(at, EventSpec) else at.si,
        event=event,
        lasting_s=None if fault.lasting is None else fault.lasting.si,
        cycles=fault.skip_cycles if isinstance(fault, SkipCyclesFault) else None,
        delay_s=fault.by.si if isinstance(fault, DelayFault) else None,
        jump_s=fault.by.si if isinstance(fault, JumpClockFault) else None,
        displacement=fault.by.si if isinstance(fault, DisplaceFault) else None,
        velocity=fault.to.si if isinstance(fault, SlowFault) else None,
        factor=fault.to.si if isinstance(fault, ScaleSpeedFault) else None,
    )
    return Outcome(bound, (*problems, *_misplaced(event, steps, document, (*path, "at"))))


def _target(
    fault: FaultSpec, kind: str, document: SourceDocument, path: YamlPath, targets: Mapping[str, Target]
) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return the name in the contract of what a fault hits, and what is wrong with the reference."""
    if isinstance(fault, CancelFault):
        return fault.cancel, ()
    if isinstance(fault, SkipCyclesFault):
        return "", ()
    written, target = str(getattr(fault, kind)), targets[kind]
    if written in target.names:
        return target.names[written], ()
    return written, (unknown_name(target.code, written, target.noun, target.names, document, (*path, kind)),)


def _event(written: EventSpec) -> StepEvent:
    return StepEvent(written.step, written.when, 0.0 if written.after is None else written.after.si)


def _misplaced(
    event: StepEvent | None, steps: tuple[Step, ...], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    """Report an event that never comes: of a step that is not there, or that sends no goal."""
    if event is None or not steps:
        return ()
    if event.step > len(steps):
        message = f"there is no step {event.step}, the rehearsal has {len(steps)}"
        return (_never(message, f"write a step from 1 to {len(steps)}", document, (*path, "step")),)
    step = steps[event.step - 1]
    if event.when == "started" or step.kind in SENDS_GOALS:
        return ()
    fitting = [number for number, other in enumerate(steps, start=1) if other.kind in SENDS_GOALS]
    message = f"step {event.step} is a `{step.kind}`, which sends no goal, so that it is never `{event.when}`"
    listed = ", ".join(map(str, fitting))
    help_ = f"write `started`, or a step that sends a goal: {listed}" if fitting else "write `started`"
    return (_never(message, help_, document, (*path, "when")),)


def _never(message: str, help_: str, document: SourceDocument, path: YamlPath) -> Diagnostic:
    return Diagnostic(
        code="event-never-comes",
        severity=Severity.ERROR,
        message=message,
        span=document.locate(path),
        yaml_path=path,
        help=help_,
    )
