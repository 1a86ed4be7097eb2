"""Binds rehearsals: whose steps they take, their faults, and their steps to what the cell has of these names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.motion import Fault, Rehearsal, Step
from cellc.compiler.cell.switched import Switched
from cellc.compiler.link.faults import Names, fault_targets, link_fault
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.hopeless import until_hopeless
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.rehearsals import (
    AcknowledgeStep,
    CallStep,
    DetectStep,
    GripStep,
    MoveStep,
    RehearsalSpec,
    SenseStep,
    SetStep,
    StepSpec,
)
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.faults import FaultTarget
from cellc.contract.vocabulary import InterfaceKind

_Bound = TypeVar("_Bound", Step, Fault)

DEFAULT_TIMEOUT_S = 300.0
"""A rehearsal that neither moves nor fails for five simulated minutes is stuck."""


@dataclass(frozen=True, slots=True)
class _Names:
    """What steps and faults may name."""

    poses: tuple[str, ...]
    goals: tuple[str, ...]
    frames: FrameNames
    grippers: tuple[str, ...]
    switched: Mapping[str, Switched]
    services: tuple[str, ...]
    faults: Mapping[FaultTarget, Names]


def link_rehearsals(
    spec: CellSpec,
    document: SourceDocument,
    devices: tuple[Device, ...],
    managers: tuple[ControllerManager, ...],
    interfaces: tuple[Interface, ...],
    frames: FrameNames,
) -> Outcome[tuple[Rehearsal, ...]]:
    """Bind every rehearsal; one that uses another's steps gets a copy of them."""
    names = _Names(
        poses=tuple(spec.motion.poses),
        goals=tuple(spec.motion.goals),
        frames=frames,
        grippers=tuple(device.name for device in devices if device.gripper is not None),
        switched={device.name: device.switched for device in devices if device.switched is not None},
        services=tuple(interface.name for interface in interfaces if interface.kind is InterfaceKind.SERVICE),
        faults=fault_targets(spec, devices, managers, interfaces, frames),
    )
    rehearsals: list[Rehearsal] = []
    problems: list[Diagnostic] = []
    for name, rehearsal in until_hopeless(spec.rehearsals.items(), problems):
        bound = _rehearsal(name, rehearsal, spec, document, names)
        problems += bound.diagnostics
        if bound.value is not None:
            rehearsals.append(bound.value)
    return Outcome(tuple(rehearsals), tuple(problems))


def _rehearsal(
    name: str, written: RehearsalSpec, spec: CellSpec, document: SourceDocument, names: _Names
) -> Outcome[Rehearsal]:
    path = ("rehearsals", name)
    source = _steps_of(name, spec, document)
    if source.value is None:
        return Outcome(None, source.diagnostics)
    steps = _collected(
        _step(step, document, ("rehearsals", source.value, "steps", index), names)
        for index, step in enumerate(spec.rehearsals[source.value].steps)
    )
    injected = written.inject if isinstance(written.inject, tuple) else (written.inject,)
    faults = _collected(
        link_fault(fault, document, _place(written, (*path, "inject"), index), names.faults, steps.value or ())
        for index, fault in enumerate(injected)
    )
    rehearsal = Rehearsal(
        name=name,
        path=path,
        span=document.locate(path),
        steps=steps.value or (),
        faults=faults.value or (),
        expect=written.expect,
        within_s=si(written.within),
        bring_up=written.bring_up,
        timeout_s=DEFAULT_TIMEOUT_S if written.timeout is None else written.timeout.si,
        success=si(written.success),
        confidence=0.95 if written.confidence is None else written.confidence.si,
    )
    # A step list shared by `use` is reported where it is written, once.
    step_problems = steps.diagnostics if source.value == name else ()
    return Outcome(rehearsal, (*step_problems, *faults.diagnostics))


def _place(written: RehearsalSpec, path: YamlPath, index: int) -> YamlPath:
    return (*path, index) if isinstance(written.inject, tuple) else path


def _collected(outcomes: Iterable[Outcome[_Bound]]) -> Outcome[tuple[_Bound, ...]]:
    values: list[_Bound] = []
    problems: list[Diagnostic] = []
    for outcome in outcomes:
        problems += outcome.diagnostics
        if outcome.value is not None:
            values.append(outcome.value)
    return Outcome(tuple(values), tuple(problems))


def _steps_of(name: str, spec: CellSpec, document: SourceDocument) -> Outcome[str]:
    """Follow ``use`` to the rehearsal that holds the steps."""
    seen = [name]
    while (used := spec.rehearsals[seen[-1]].use) is not None:
        path = ("rehearsals", seen[-1], "use")
        if used not in spec.rehearsals:
            problem = unknown_name("unknown-rehearsal", used, "rehearsal", spec.rehearsals, document, path)
            return Outcome(None, (problem,) if seen[-1] == name else ())
        if used in seen:
            return Outcome(None, (_use_cycle([*seen, used], document, ("rehearsals", name, "use")),))
        seen.append(used)
    return Outcome(seen[-1])


def _use_cycle(seen: list[str], document: SourceDocument, path: YamlPath) -> Diagnostic:
    return Diagnostic(
        code="rehearsal-cycle",
        severity=Severity.ERROR,
        message="rehearsals use each other in a circle: " + " → ".join(f"`{name}`" for name in seen),
        span=document.locate(path),
        yaml_path=path,
        help="give one of them its own `steps`",
    )


def _step(step: StepSpec, document: SourceDocument, path: YamlPath, names: _Names) -> Outcome[Step]:
    span = document.locate(path)
    if isinstance(step, MoveStep):
        known = (*names.poses, *names.goals)
        problem = _missing("unknown-goal", step.move, "pose or goal", known, document, (*path, "move"))
        at_once = "together" if step.together else None
        return Outcome(Step(name=step.move, path=path, span=span, kind="move", command=at_once), problem)
    if isinstance(step, DetectStep):
        frame = names.frames.bind(step.detect, (*path, "detect"))
        return Outcome(Step(name=frame.value or step.detect, path=path, span=span, kind="detect"), frame.diagnostics)
    if isinstance(step, GripStep):
        gripper = step.device or (names.grippers[0] if len(names.grippers) == 1 else "")
        at = (*path, "device") if step.device else path
        problem = _missing("unknown-device", gripper, "gripper", names.grippers, document, at)
        if not gripper:
            message = f"`grip` names no gripper, and the cell has {len(names.grippers) or 'none'}"
            problem = tuple(replace(diagnostic, message=message) for diagnostic in problem)
        return Outcome(Step(name=gripper, path=path, span=span, kind="grip", command=step.grip), problem)
    if isinstance(step, SetStep | SenseStep):
        return _switched_step(step, document, path, names)
    if isinstance(step, CallStep):
        problem = _missing("unknown-interface", step.call, "service", names.services, document, (*path, "call"))
        return Outcome(Step(name=step.call, path=path, span=span, kind="call"), problem)
    if isinstance(step, AcknowledgeStep):
        return Outcome(Step(name=step.acknowledge, path=path, span=span, kind="acknowledge"))
    return Outcome(Step(name="", path=path, span=span, kind="wait", duration_s=step.wait.si))


def _switched_step(step: SetStep | SenseStep, document: SourceDocument, path: YamlPath, names: _Names) -> Outcome[Step]:
    """Bind a step to a device that outputs switch, or whose sensors tell the state that is waited for."""
    if isinstance(step, SetStep):
        kind, device, noun = "set", step.set, "device with outputs"
        fits = {name: switched for name, switched in names.switched.items() if switched.signals}
    else:
        kind, device, noun = "sense", step.sense, "device with sensors that are wired"
        fits = {name: switched for name, switched in names.switched.items() if switched.inputs}
    problem = _missing("unknown-device", device, noun, tuple(fits), document, (*path, kind))
    if device in fits:
        known = fits[device].states if kind == "set" else tuple(fits[device].distinct_states)
        problem = _missing("unknown-state", step.state, "state", tuple(known), document, (*path, "state"))
    span = document.locate(path)
    return Outcome(Step(name=device, path=path, span=span, kind=kind, state=step.state), problem)


def _missing(
    code: str, name: str, noun: str, known: tuple[str, ...], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    return () if name in known else (unknown_name(code, name, noun, known, document, path),)
