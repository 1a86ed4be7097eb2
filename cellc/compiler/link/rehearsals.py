"""Binds rehearsals: whose steps they take, their faults, and their steps to what the cell has of these names."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
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
from cellc.compiler.spec.quantity import Quantity
from cellc.compiler.spec.rehearsals import RehearsalSpec, StepSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.fault_declaration import FaultTarget
from cellc.contract.frozen import dataclass
from cellc.contract.steps import StepTarget
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
    kind, at = step.kind, (*path, step.kind.value)
    bound = Step(name=str(step.target), path=path, span=document.locate(path), kind=kind)
    if isinstance(step.target, Quantity):
        return Outcome(replace(bound, name="", duration_s=step.target.si))
    if kind.target is StepTarget.POSTURE:
        known = (*names.poses, *names.goals)
        problem = _missing("unknown-goal", bound.name, "pose or goal", known, document, at)
        return Outcome(replace(bound, command="together" if step.more else None), problem)
    if kind.target is StepTarget.FRAME:
        frame = names.frames.bind(bound.name, at)
        return Outcome(replace(bound, name=frame.value or bound.name), frame.diagnostics)
    if kind.target is StepTarget.FINGERS:
        gripper = str(step.more or (names.grippers[0] if len(names.grippers) == 1 else ""))
        problem = _missing(
            "unknown-device", gripper, "gripper", names.grippers, document, (*path, "device") if step.more else path
        )
        if not gripper:
            message = f"`grip` names no gripper, and the cell has {len(names.grippers) or 'none'}"
            problem = tuple(replace(diagnostic, message=message) for diagnostic in problem)
        return Outcome(replace(bound, name=gripper, command=bound.name), problem)
    if kind.target in (StepTarget.SWITCHED, StepTarget.SENSED):
        bound = replace(bound, state=str(step.more))
        return Outcome(bound, _unswitched(bound, kind.target, document, names))
    if kind.target is StepTarget.SERVICE:
        return Outcome(bound, _missing("unknown-interface", bound.name, "service", names.services, document, at))
    return Outcome(bound)


def _unswitched(step: Step, target: StepTarget, document: SourceDocument, names: _Names) -> tuple[Diagnostic, ...]:
    """Report a device that no outputs switch, or whose sensors tell nothing, and a state that it does not have."""
    outputs = target is StepTarget.SWITCHED
    fits = {name: facts for name, facts in names.switched.items() if (facts.signals if outputs else facts.inputs)}
    if step.name not in fits:
        noun = "device with outputs" if outputs else "device with sensors that are wired"
        path = (*step.path, step.kind.value)
        return _missing("unknown-device", step.name, noun, tuple(fits), document, path)
    known = fits[step.name].states if outputs else fits[step.name].distinct_states
    return _missing("unknown-state", step.state or "", "state", tuple(known), document, (*step.path, "state"))


def _missing(
    code: str, name: str, noun: str, known: tuple[str, ...], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    return () if name in known else (unknown_name(code, name, noun, known, document, path),)
