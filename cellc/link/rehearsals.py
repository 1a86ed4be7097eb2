"""Binds rehearsals: whose steps they take, their steps to poses, goals, frames and devices, and their faults.

A fault is bound to what it hits, under the name that the contract has for it, to when it begins, and by how much.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from cellc.cell.control import ControllerManager
from cellc.cell.device import Device
from cellc.cell.entity import Entity
from cellc.cell.interface import Interface, InterfaceKind
from cellc.cell.motion import Fault, Rehearsal, Step, StepEvent
from cellc.cell.switched import Switched
from cellc.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.link.frames import FrameNames
from cellc.link.names import unknown_name
from cellc.link.quantities import si
from cellc.source.document import SourceDocument
from cellc.spec.cell_spec import CellSpec
from cellc.spec.faults import (
    FAULT_KEYS,
    CancelFault,
    DelayFault,
    DisplaceFault,
    EventSpec,
    FaultSpec,
    JogFault,
    JumpClockFault,
    PhaseSpec,
    ScaleSpeedFault,
    SkipCyclesFault,
    SlowFault,
    first_key,
)
from cellc.spec.rehearsals import (
    AcknowledgeStep,
    DetectStep,
    GripStep,
    MoveStep,
    RehearsalSpec,
    SenseStep,
    SetStep,
    StepSpec,
)
from cellc.vocabulary import Moment, Need

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
    faults: Mapping[str, Target]


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
        faults=fault_targets(spec, devices, managers, interfaces, frames),
    )
    rehearsals: list[Rehearsal] = []
    problems: list[Diagnostic] = []
    for name, written in spec.rehearsals.items():
        bound = _rehearsal(name, written, spec, document, names)
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
        return Outcome(Step(name=step.move, path=path, span=span, kind="move"), problem)
    if isinstance(step, DetectStep):
        frame = names.frames.bind(step.detect, (*path, "detect"))
        return Outcome(Step(name=frame.value or step.detect, path=path, span=span, kind="detect"), frame.diagnostics)
    if isinstance(step, GripStep):
        gripper = step.device or (names.grippers[0] if len(names.grippers) == 1 else "")
        at = (*path, "device") if step.device else path
        problem = _missing("unknown-device", gripper, "gripper", names.grippers, document, at)
        if not gripper:
            message = f"`grip` names no gripper, and the cell has {len(names.grippers) or 'none'}"
            problem = tuple(replace(one, message=message) for one in problem)
        return Outcome(Step(name=gripper, path=path, span=span, kind="grip", command=step.grip), problem)
    if isinstance(step, SetStep | SenseStep):
        return _switched_step(step, document, path, names)
    if isinstance(step, AcknowledgeStep):
        return Outcome(Step(name=step.acknowledge, path=path, span=span, kind="acknowledge"))
    return Outcome(Step(name="", path=path, span=span, kind="wait", duration_s=step.wait.si))


def _switched_step(step: SetStep | SenseStep, document: SourceDocument, path: YamlPath, names: _Names) -> Outcome[Step]:
    """Bind a step to a device that outputs switch, or whose sensors tell the state that is waited for."""
    if isinstance(step, SetStep):
        kind, device, noun = "set", step.set, "device with outputs"
        fits = {name: one for name, one in names.switched.items() if one.signals}
    else:
        kind, device, noun = "sense", step.sense, "device with sensors that are wired"
        fits = {name: one for name, one in names.switched.items() if one.inputs}
    problem = _missing("unknown-device", device, noun, tuple(fits), document, (*path, kind))
    if device in fits:
        known = fits[device].states if kind == "set" else tuple(fits[device].told_states)
        problem = _missing("unknown-state", step.state, "state", tuple(known), document, (*path, "state"))
    span = document.locate(path)
    return Outcome(Step(name=device, path=path, span=span, kind=kind, state=step.state), problem)


def _missing(
    code: str, name: str, noun: str, known: tuple[str, ...], document: SourceDocument, path: YamlPath
) -> tuple[Diagnostic, ...]:
    return () if name in known else (unknown_name(code, name, noun, known, document, path),)


SENDS_GOALS = ("move", "grip")
"""Steps whose goal a controller accepts, so that joints move."""


def link_fault(
    fault: FaultSpec, document: SourceDocument, path: YamlPath, targets: Mapping[str, Target], steps: tuple[Step, ...]
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
        at_s=None if isinstance(at, EventSpec | PhaseSpec) else at.si,
        event=event,
        phase=at.phase if isinstance(at, PhaseSpec) else None,
        lasting_s=si(fault.lasting),
        cycles=fault.skip_cycles if isinstance(fault, SkipCyclesFault) else None,
        delay_s=fault.by.si if isinstance(fault, DelayFault) else None,
        jump_s=fault.by.si if isinstance(fault, JumpClockFault) else None,
        displacement=fault.by.si if isinstance(fault, DisplaceFault | JogFault) else None,
        velocity=fault.to.si if isinstance(fault, SlowFault) else None,
        linear=isinstance(fault, DisplaceFault | JogFault | SlowFault)
        and (fault.to if isinstance(fault, SlowFault) else fault.by).linear,
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
        message = f"there is no step {event.step}: the rehearsal has {len(steps)}"
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


Names = Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Target:
    """What one kind of fault may hit: a noun for messages, the code of an unknown one, and the names."""

    noun: str
    code: str
    names: Names


def fault_targets(
    spec: CellSpec,
    devices: tuple[Device, ...],
    managers: tuple[ControllerManager, ...],
    interfaces: tuple[Interface, ...],
    frames: FrameNames,
) -> Mapping[str, Target]:
    """Return what each kind of fault may hit; ``cancel`` and ``skip_cycles`` name nothing of the cell."""
    return {
        **_of_devices(devices),
        **_of_graph(managers, interfaces),
        "drop_frame": Target("frame", "unknown-frame", frames.by_reference),
        "double_frame": Target("frame", "unknown-frame", frames.by_reference),
        "jump_clock": Target("clock", "unknown-clock", _clocks(spec)),
        "unreachable": Target("goal", "unknown-goal", {name: name for name in spec.motion.goals}),
    }


def _of_devices(devices: tuple[Device, ...]) -> dict[str, Target]:
    """Return the faults that hit a device or one of its joints."""
    jointed = [device for device in devices if device.actuated_joints]
    seen = [device for device in devices if device.camera is not None or device in jointed]
    scaled = [device for device in jointed if device.speed_scaling is not None]
    arms = [device for device in jointed if device.kind == "arm"]
    claimed = [device for device in jointed if device.hardware is not None and device.hardware.kept_by_a_claim]
    braked = [device for device in jointed if Need.BRAKES_OPEN in _claim_needs(device)]
    sensed = [device for device in devices if device.switched is not None and device.switched.inputs]
    code = "unknown-device"
    streams = Target("camera or device with joints", code, _named(seen))
    programmed = Target("device that keeps set points while its program is stopped", code, _named(claimed))
    stoppable = Target("device with hardware", code, _named(jointed))
    joint = Target("joint", "unknown-joint", _joints(devices))
    return {
        **dict.fromkeys(("freeze", "delay", "cut_network"), streams),
        **dict.fromkeys(("stick", "slow", "displace"), joint),
        **dict.fromkeys(("protective_stop", "emergency_stop", "restart_driver"), stoppable),
        "scale_speed": Target("device with speed scaling", code, _named(scaled)),
        "wrong_payload": Target("arm", code, _named(arms)),
        **dict.fromkeys(("program_stop", "program_start", "stale_set_points"), programmed),
        "jog": Target("joint", "unknown-joint", _joints(claimed)),
        "silent_sensor": Target("device with sensors that are wired", code, _named(sensed)),
        "brakes_closed": Target("device whose claim needs open brakes", code, _named(braked)),
    }


def _claim_needs(device: Device) -> Collection[Need]:
    claim = None if device.hardware is None else device.hardware.effects.get(Moment.CLAIM)
    return () if claim is None else claim.needs


def _of_graph(managers: tuple[ControllerManager, ...], interfaces: tuple[Interface, ...]) -> dict[str, Target]:
    """Return the faults that hit a controller, a switch, a server or an interface."""
    controllers = [controller for manager in managers for controller in manager.controllers]
    switches = [switch for manager in managers for switch in manager.switches]
    acting = _named(controller for controller in controllers if controller.action is not None)
    code = "unknown-controller"
    return {
        "mismatch_qos": Target("interface", "unknown-interface", _named(interfaces)),
        "unresponsive": Target("server", "unknown-node", {**_servers(interfaces), **acting}),
        "reject": Target("controller", code, _named(controllers)),
        "second_commander": Target("controller with an action", code, acting),
        "switch": Target("switch or controller", code, {**_named(controllers), **_named(switches)}),
    }


def _named(entities: Iterable[Entity]) -> dict[str, str]:
    return {entity.name: entity.name for entity in entities}


def _joints(devices: Iterable[Device]) -> dict[str, str]:
    return {f"{device.name}/{joint.local_name}": joint.name for device in devices for joint in device.joints}


def _servers(interfaces: Iterable[Interface]) -> dict[str, str]:
    """Return the nodes that serve an action or a service."""
    serving = (interface for interface in interfaces if interface.kind is not InterfaceKind.TOPIC)
    nodes = [source.node for interface in serving for source in interface.sources]
    return dict(zip(nodes, nodes, strict=True))


def _clocks(spec: CellSpec) -> dict[str, str]:
    """Return hosts, devices that state a clock, and the domains of both."""
    stamps = {name: device.stamp.clock for name, device in spec.devices.items() if device.stamp is not None}
    domains = {host.clock.domain for host in spec.hosts.values()} | set(stamps.values())
    names = ["ros", *spec.hosts, *stamps, *sorted(domains - {"UNKNOWN"})]
    return dict(zip(names, names, strict=True))
