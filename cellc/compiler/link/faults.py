"""Binds faults of rehearsals to what they hit, under the name that the contract has for it, when, and by how much."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from cellc.compiler.cell.control import ControllerManager
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.entity import Entity
from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.motion import Fault, Step, StepEvent
from cellc.compiler.link.frames import FrameNames
from cellc.compiler.link.names import unknown_name
from cellc.compiler.link.quantities import si
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.faults import (
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
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, YamlPath
from cellc.contract.vocabulary import UNKNOWN, InterfaceKind, Moment, Need

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
    assert kind is not None  # a fault is reported by its key
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
    name, target = str(getattr(fault, kind)), targets[kind]
    if name in target.names:
        return target.names[name], ()
    return name, (unknown_name(target.code, name, target.noun, target.names, document, (*path, kind)),)


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
    names = ["ros", *spec.hosts, *stamps, *sorted(domains - {UNKNOWN})]
    return dict(zip(names, names, strict=True))
