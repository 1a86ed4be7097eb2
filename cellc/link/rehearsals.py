"""Binds the steps and faults of rehearsals to poses, goals, frames, devices and joints."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from cellc.cell.control import Controller
from cellc.cell.device import Device
from cellc.cell.rehearsal import Fault, Rehearsal, Step
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.link.frame_names import FrameNames
from cellc.link.unknown import unknown_name
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.rehearsals import (
    CancelFault,
    DelayFault,
    DetectStep,
    DropFrameFault,
    FaultSpec,
    FreezeFault,
    GripStep,
    MoveStep,
    ProtectiveStopFault,
    RehearsalSpec,
    RejectFault,
    SkipCyclesFault,
    StepSpec,
    StickFault,
    UnreachableFault,
)

_Bound = TypeVar("_Bound", Step, Fault)

DEFAULT_TIMEOUT_S = 300.0
"""A rehearsal that neither moves nor fails for five simulated minutes is stuck."""


@dataclass(frozen=True, slots=True)
class _Names:
    """What steps and faults may name."""

    poses: tuple[str, ...]
    goals: tuple[str, ...]
    frames: FrameNames
    sensors: tuple[str, ...]
    grippers: tuple[str, ...]
    devices: tuple[str, ...]
    controllers: tuple[str, ...]
    joints: dict[str, str]


def link_rehearsals(
    spec: CellSpec,
    document: SourceDocument,
    devices: tuple[Device, ...],
    controllers: tuple[Controller, ...],
    frames: FrameNames,
) -> Outcome[tuple[Rehearsal, ...]]:
    """Bind every rehearsal; one that uses another's steps gets a copy of them."""
    names = _collect(spec, devices, controllers, frames)
    rehearsals: list[Rehearsal] = []
    problems: list[Diagnostic] = []
    for name, written in spec.rehearsals.items():
        bound = _rehearsal(name, written, spec, document, names)
        problems += bound.diagnostics
        if bound.value is not None:
            rehearsals.append(bound.value)
    return Outcome(tuple(rehearsals), tuple(problems))


def _collect(
    spec: CellSpec, devices: tuple[Device, ...], controllers: tuple[Controller, ...], frames: FrameNames
) -> _Names:
    joints = {f"{device.name}/{joint.local_name}": joint.name for device in devices for joint in device.joints}
    return _Names(
        poses=tuple(spec.motion.poses),
        goals=tuple(spec.motion.goals),
        frames=frames,
        sensors=tuple(device.name for device in devices if device.facts.camera is not None),
        grippers=tuple(device.name for device in devices if device.facts.gripper is not None),
        devices=tuple(device.name for device in devices),
        controllers=tuple(controller.name for controller in controllers),
        joints=joints,
    )


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
        _fault(fault, document, (*path, "inject") if len(injected) == 1 else (*path, "inject", index), names)
        for index, fault in enumerate(injected)
    )
    rehearsal = Rehearsal(
        name=name,
        path=path,
        span=document.locate(path),
        steps=steps.value or (),
        faults=faults.value or (),
        expect=written.expect,
        within_s=None if written.within is None else written.within.si,
        timeout_s=DEFAULT_TIMEOUT_S if written.timeout is None else written.timeout.si,
    )
    # A step list shared by `use` is reported where it is written, once.
    step_problems = steps.diagnostics if source.value == name else ()
    return Outcome(rehearsal, (*step_problems, *faults.diagnostics))


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
        return Outcome(Step(name=step.move, path=path, span=span, kind="move"), problem)
    if isinstance(step, DetectStep):
        frame = names.frames.bind(step.detect, (*path, "detect"))
        return Outcome(Step(name=frame.value or step.detect, path=path, span=span, kind="detect"), frame.diagnostics)
    if isinstance(step, GripStep):
        gripper = step.device or (names.grippers[0] if len(names.grippers) == 1 else "")
        at = (*path, "device") if step.device else path
        problem = _missing("unknown-device", gripper, "gripper", names.grippers, document, at)
        return Outcome(Step(name=gripper, path=path, span=span, kind="grip", command=step.grip), problem)
    return Outcome(Step(name="", path=path, span=span, kind="wait", duration_s=step.wait.si))


def _fault(fault: FaultSpec, document: SourceDocument, path: YamlPath, names: _Names) -> Outcome[Fault]:
    kind, target, problems = _fault_target(fault, document, path, names)
    bound = Fault(
        name=target,
        path=path,
        span=document.locate(path),
        kind=kind,
        at_s=fault.at.si,
        lasting_s=None if fault.lasting is None else fault.lasting.si,
        cycles=fault.skip_cycles if isinstance(fault, SkipCyclesFault) else None,
        delay_s=fault.by.si if isinstance(fault, DelayFault) else None,
    )
    return Outcome(bound, problems)


def _fault_target(
    fault: FaultSpec, document: SourceDocument, path: YamlPath, names: _Names
) -> tuple[str, str, tuple[Diagnostic, ...]]:
    """Return the kind of a fault, the ROS name that it hits, and what is wrong with the reference."""
    if isinstance(fault, CancelFault):
        return "cancel", fault.cancel, ()
    if isinstance(fault, SkipCyclesFault):
        return "skip_cycles", "", ()
    if isinstance(fault, DropFrameFault):
        frame = names.frames.bind(fault.drop_frame, (*path, "drop_frame"))
        return "drop_frame", frame.value or fault.drop_frame, frame.diagnostics
    if isinstance(fault, StickFault):
        at = (*path, "stick")
        problems = _missing("unknown-joint", fault.stick, "joint", tuple(names.joints), document, at)
        return "stick", names.joints.get(fault.stick, fault.stick), problems
    kind, target, code, noun, known = _plain_target(fault, names)
    return kind, target, _missing(code, target, noun, known, document, (*path, kind))


def _plain_target(
    fault: FreezeFault | RejectFault | ProtectiveStopFault | UnreachableFault | DelayFault, names: _Names
) -> tuple[str, str, str, str, tuple[str, ...]]:
    if isinstance(fault, FreezeFault):
        return "freeze", fault.freeze, "unknown-device", "sensor", names.sensors
    if isinstance(fault, RejectFault):
        return "reject", fault.reject, "unknown-controller", "controller", names.controllers
    if isinstance(fault, ProtectiveStopFault):
        return "protective_stop", fault.protective_stop, "unknown-device", "device", names.devices
    if isinstance(fault, UnreachableFault):
        return "unreachable", fault.unreachable, "unknown-goal", "goal", names.goals
    return "delay", fault.delay, "unknown-device", "device", names.devices


def _missing(
    code: str, name: str, noun: str, known: tuple[str, ...], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    return () if name in known else (unknown_name(code, name, noun, known, document, path),)
