"""Binds faults of rehearsals to what they hit, under the name that the contract has for it, when, and by how much."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import get_args

from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.entity import Entity
from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.motion import Fault, Step, StepEvent
from cellc.compiler.cell.stops import stops_of
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.faults import EventSpec, FaultSpec, PhaseSpec
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.fault_declaration import FaultTarget
from cellc.contract.faults import FaultKind, GoalStep, stop_state
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind, Moment, Need

SENDS_GOALS = get_args(GoalStep)
Names = Mapping[str, str]
"""What a user writes → what the contract calls it."""


def link_fault(
    fault: FaultSpec,
    document: SourceDocument,
    path: YamlPath,
    targets: Mapping[FaultTarget, Names],
    steps: tuple[Step, ...],
) -> Outcome[Fault]:
    """Bind one fault.

    Args:
        targets: what faults may hit.
        steps: of the rehearsal, which the fault may wait for.
    """
    at, amount = fault.at, fault.amount
    name, problems = _target(fault, document, path, targets)
    event = _event(at) if isinstance(at, EventSpec) else None
    bound = Fault(
        name=name,
        path=path,
        span=document.locate(path),
        kind=fault.kind,
        at_s=None if isinstance(at, EventSpec | PhaseSpec) else at.si,
        event=event,
        phase=at.phase if isinstance(at, PhaseSpec) else None,
        lasting_s=si(fault.lasting),
        cycles=fault.target if isinstance(fault.target, int) else None,
        amount=si(amount),
        linear=amount is not None and amount.linear,
    )
    return Outcome(bound, (*problems, *_misplaced(event, steps, document, (*path, "at"))))


def _target(
    fault: FaultSpec, document: SourceDocument, path: YamlPath, targets: Mapping[FaultTarget, Names]
) -> tuple[str, tuple[Diagnostic, ...]]:
    """Return the name in the contract of what a fault hits, and what is wrong with the reference."""
    written, target = fault.target, fault.kind.hits.target
    if isinstance(written, int):
        return "", ()
    names = targets[target]
    if written in names:
        return names[written], ()
    code = f"unknown-{target.reference}"
    return written, (unknown_name(code, written, target.noun, names, document, (*path, fault.kind.value)),)


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


def fault_targets(
    spec: CellSpec,
    devices: tuple[Device, ...],
    managers: tuple[ControllerManager, ...],
    interfaces: tuple[Interface, ...],
    frames: FrameNames,
) -> Mapping[FaultTarget, Names]:
    """Return what each fault may hit: as a user writes it, and its name in the contract."""
    return {
        **_of_devices(devices),
        **_of_graph(managers, interfaces),
        **_of_parts(spec, devices),
        FaultTarget.FRAME: frames.by_reference,
        FaultTarget.CLOCK: _clocks(spec),
        FaultTarget.GOAL: _same(spec.motion.goals),
        FaultTarget.STEP: _same(SENDS_GOALS),
    }


def _of_parts(spec: CellSpec, devices: tuple[Device, ...]) -> dict[FaultTarget, Names]:
    """Return the parts that fingers tell from others, and the grippers that may take one."""
    grasps = {name: frame.grasp for name, frame in spec.frames.items() if frame.grasp is not None}
    parts = [name for name, grasp in grasps.items() if grasp.width is not None and grasp.tolerance is not None]
    grippers = [device for device in devices if device.gripper is not None] if parts else []
    return {FaultTarget.PART: _same(parts), FaultTarget.GRIPPER: _named(grippers)}


def _of_devices(devices: tuple[Device, ...]) -> dict[FaultTarget, Names]:
    """Return the devices and joints that faults may hit."""
    jointed = [device for device in devices if device.actuated_joints]
    claimed = [
        device for device in jointed if device.control.hardware is not None and device.control.hardware.kept_by_a_claim
    ]
    return {
        FaultTarget.STREAM: _named(
            device for device in devices if device.sensing.camera is not None or device in jointed
        ),
        FaultTarget.STOPPABLE: _named(jointed),
        FaultTarget.PROTECTED: _stopping(jointed, FaultKind.PROTECTIVE_STOP),
        FaultTarget.GUARDED: _stopping(jointed, FaultKind.SAFEGUARD_STOP),
        FaultTarget.POWERED: _stopping(jointed, FaultKind.EMERGENCY_STOP),
        FaultTarget.PAUSING: _named(device for device in claimed if Need.NOT_PAUSED in _claim_needs(device)),
        FaultTarget.SCALED: _named(device for device in jointed if device.control.speed_scaling is not None),
        FaultTarget.ARM: _named(device for device in jointed if device.kind == "arm"),
        FaultTarget.PROGRAMMED: _named(claimed),
        FaultTarget.BRAKED: _named(device for device in jointed if Need.BRAKES_OPEN in _claim_needs(device)),
        FaultTarget.SENSED: _named(
            device for device in devices if device.switched is not None and device.switched.inputs
        ),
        FaultTarget.JOINT: _joints(devices),
        FaultTarget.PROGRAMMED_JOINT: _joints(claimed),
    }


def _stopping(devices: Iterable[Device], kind: FaultKind) -> Names:
    """Return the devices that know a state in which a fault stops them."""
    return _named(
        device for device in devices if stop_state(kind, {state.name for state in stops_of(device)}) is not None
    )


def _claim_needs(device: Device) -> Collection[Need]:
    claim = None if device.control.hardware is None else device.control.hardware.effects.get(Moment.CLAIM)
    return () if claim is None else claim.needs


def _of_graph(managers: tuple[ControllerManager, ...], interfaces: tuple[Interface, ...]) -> dict[FaultTarget, Names]:
    """Return the controllers, switches, servers and interfaces that faults may hit."""
    controllers = [controller for manager in managers for controller in manager.controllers]
    switches = [switch for manager in managers for switch in manager.switches]
    commanded = _named(controller for controller in controllers if controller.action is not None)
    return {
        FaultTarget.CONTROLLER: _named(controllers),
        FaultTarget.COMMANDED: commanded,
        FaultTarget.SWITCH: _named((*controllers, *switches)),
        FaultTarget.SERVER: {**_servers(interfaces), **commanded},
        FaultTarget.INTERFACE: _named(interfaces),
    }


def _named(entities: Iterable[Entity]) -> Names:
    return _same(entity.name for entity in entities)


def _same(names: Iterable[str]) -> Names:
    return {name: name for name in names}


def _joints(devices: Iterable[Device]) -> Names:
    return {f"{device.name}/{joint.local_name}": joint.name for device in devices for joint in device.joints}


def _servers(interfaces: Iterable[Interface]) -> Names:
    """Return the nodes that serve an action or a service."""
    serving = (interface for interface in interfaces if interface.kind is not InterfaceKind.TOPIC)
    return _same(source.node for interface in serving for source in interface.sources)


def _clocks(spec: CellSpec) -> Names:
    """Return hosts, devices that state a clock, and the domains of both."""
    stamps = {name: device.stamp.clock for name, device in spec.devices.items() if device.stamp is not None}
    domains = {host.clock.domain for host in spec.hosts.values()} | set(stamps.values())
    return _same(("ros", *spec.hosts, *stamps, *sorted(domains - {UNKNOWN})))
