"""Bounds of times: watchdogs, waits, budgets and targets that no cell means."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.graph.commissioning import tip_bounds
from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule
from cellc.contract.vocabulary import Distro, InterfaceKind

_Owners = Iterator[tuple[YamlPath, object]]
_CONTROLLERS = ("control.controllers.*", "managers.*.controllers.*")


def _controllers(graph: CellGraph) -> _Owners:
    return ((controller.path, controller) for controller in graph.cell.controllers)


def _adapters(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.control.adapter is not None:
            yield (*device.path, "adapter"), device.control.adapter


def _solvers(graph: CellGraph) -> Iterator[Figure]:
    for group in graph.cell.groups:
        yield Figure((*group.path, "ik_timeout"), group.solver.timeout_s, 5e-4, 3.0)


def _servo(graph: CellGraph) -> _Owners:
    return iter(()) if graph.cell.servo is None else iter(((("motion", "servo"), graph.cell.servo),))


def _sensors(graph: CellGraph) -> _Owners:
    return (((*device.path, "stamp"), device.sensing) for device in graph.cell.devices)


def _stamps(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.sensing.stamp is not None:
            yield (*device.path, "stamp"), device.sensing.stamp.clock


def _hosts(graph: CellGraph) -> _Owners:
    return (((*host.path, "clock"), host.clock) for host in graph.cell.hosts.values())


def _switched(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.switched is not None:
            yield (*device.path, "switching"), device.switched


def _frames(graph: CellGraph) -> _Owners:
    return ((frame.path, frame) for frame in graph.cell.frames if frame.buffer_s is not None)


def _written(graph: CellGraph) -> _Owners:
    return ((interface.path, interface) for interface in graph.cell.interfaces if not interface.derived)


def _profiles(graph: CellGraph) -> _Owners:
    for interface in graph.cell.interfaces:
        for end in () if interface.derived else (*interface.sources, *interface.sinks):
            yield end.path, end.qos


def _of_ends(key: str) -> tuple[str, ...]:
    return tuple(f"interfaces.*.{end}.*.{key}" for end in ("from", "to", "client"))


def _kpis(graph: CellGraph) -> _Owners:
    yield ("kpis",), graph.cell.kpis


def _first_motions(graph: CellGraph) -> _Owners:
    return ((motion.path, motion) for motion in graph.cell.bringup.first_motions)


def _rehearsals(graph: CellGraph) -> _Owners:
    return ((rehearsal.path, rehearsal) for rehearsal in graph.cell.rehearsals)


def _answers(graph: CellGraph) -> Iterator[Figure]:
    for interface in graph.cell.interfaces:
        if interface.timeout_s is not None and not interface.derived:
            most = 7200.0 if interface.kind is InterfaceKind.ACTION else 600.0
            yield Figure((*interface.path, "timeout"), interface.timeout_s, 5e-3, most)


def _ages(graph: CellGraph) -> Iterator[Figure]:
    for interface in graph.cell.interfaces:
        if interface.max_age_s is not None and not interface.derived:
            most = max(10.0, 100.0 / interface.rate_hz if interface.rate_hz else 0.0)
            yield Figure((*interface.path, "max_age"), interface.max_age_s, most=most)


def _adapted_motion(graph: CellGraph) -> Iterator[Figure]:
    """Yield how far the tip of an adapted arm can go on after its last command."""
    tips = graph.once(tip_bounds)
    for device in graph.cell.devices:
        adapter = device.control.adapter
        if adapter is None or not adapter.command_timeout_s:
            continue
        joints = {joint.name for joint in device.joints}
        moved = [tips[group.name] for group in graph.cell.groups if joints.intersection(group.joints)]
        related = (Related("its speed follows from these limits", graph.cell.locate(*device.path, "limits")),)
        path = (*device.path, "adapter", "command_timeout")
        yield Figure(path, max(moved, default=0.0) * adapter.command_timeout_s, most=0.5, related=related)


def _servo_motion(graph: CellGraph) -> Iterator[Figure]:
    servo = graph.cell.servo
    if servo is not None:
        related = (Related("at this speed", graph.cell.locate("motion", "servo", "linear")),)
        way = servo.linear * servo.command_timeout_s
        yield Figure(("motion", "servo", "command_timeout"), way, most=0.1, related=related)


def _within_rehearsals(graph: CellGraph) -> Iterator[Figure]:
    """Yield the times of faults and steps, which the end of their rehearsal bounds."""
    for rehearsal in graph.cell.rehearsals:
        most = rehearsal.timeout_s
        for step in rehearsal.steps:
            if step.duration_s is not None:
                yield Figure((*step.path, "wait"), step.duration_s, 1e-3, most)
        for fault in rehearsal.faults:
            if fault.at_s is not None:
                yield Figure((*fault.path, "at"), fault.at_s, most=most)
            if fault.event is not None:
                yield Figure((*fault.path, "at", "after"), fault.event.after_s, most=most)
            if fault.lasting_s is not None:
                yield Figure((*fault.path, "lasting"), fault.lasting_s, 1e-3, most)


_LATENCY_S, _POINTS = 0.1, 3
"""Of trajectories Servo sends so many points within what it expects of latency, and exits at its start where a period
is longer: moveit2@2.12.4 moveit_ros/moveit_servo/src/servo.cpp, Servo::validateParams; Humble has no such check."""


def _servo_period(graph: CellGraph) -> Iterator[Figure]:
    servo = graph.cell.servo
    if servo is not None:
        points = servo.type.endswith("JointTrajectory") and graph.cell.distro != Distro.HUMBLE
        because = "a third of the latency that Servo expects, which it exits without" if points else ""
        most = _LATENCY_S / _POINTS if points else 0.1
        yield Figure(("motion", "servo", "period"), servo.period_s, 5e-4, most, because=because)


_INJECTED = ("rehearsals.*.inject", "rehearsals.*.inject.*")
_CYCLE = "from one cycle of a controller to what an arm may hang after the end of its trajectory"
BOUNDS = (
    stated(tuple(f"{place}.goal_time" for place in _CONTROLLERS), _controllers, "goal_time_s", 0.02, 20.0, "s", _CYCLE),
    stated("devices.*.adapter.goal_time", _adapters, "goal_time_s", 0.01, 60.0, "s", _CYCLE),
    stated("devices.*.adapter.stop_time", _adapters, "stop_time_s", 5e-3, 5.0, "s", "in which arms come to rest"),
    stated("devices.*.adapter.command_timeout", _adapters, "command_timeout_s", 1e-3, 1.0, "s", "as watchdogs have it"),
    Bound(
        ("devices.*.adapter.command_timeout",),
        "the way of the tip after the last command",
        "mm",
        "at the speed that the joints allow",
        _adapted_motion,
    ),
    Bound(
        ("motion.servo.command_timeout",),
        "the way of the tip after the last command",
        "mm",
        "at the largest speed that Servo commands",
        _servo_motion,
    ),
    stated("motion.servo.command_timeout", _servo, "command_timeout_s", 1e-3, 1.0, "s", "as watchdogs have it"),
    Bound(("motion.servo.period",), "`period`", "ms", "in which arms take set points", _servo_period),
    Bound(("motion.groups.*.ik_timeout",), "`ik_timeout`", "ms", "in which a solver finds or gives up", _solvers),
    stated("devices.*.stamp.exposure", _sensors, "exposure_s", 1e-6, 1.0, "ms", "what sensors expose"),
    stated("devices.*.stamp.max_offset", _stamps, "max_offset_s", 1e-7, 0.1, "ms", "to which clocks are synchronized"),
    stated("hosts.*.clock.max_offset", _hosts, "max_offset_s", 1e-8, 0.1, "ms", "to which clocks are synchronized"),
    stated("devices.*.switching.time", _switched, "time_s", 5e-4, 30.0, "s", "as valves, locks and drives take"),
    stated("devices.*.switching.within", _switched, "within_s", 5e-3, 120.0, "s", "as clients wait for them"),
    stated("frames.*.buffer", _frames, "buffer_s", 0.01, 600.0, "s", "what listeners keep of transforms"),
    stated(
        "interfaces.*.cancel_within", _written, "cancel_within_s", 1e-3, 10.0, "s", "from one cycle to a stop by hand"
    ),
    Bound(("interfaces.*.timeout",), "`timeout`", "s", "in which servers answer", _answers),
    Bound(("interfaces.*.max_age",), "`max_age`", "s", "10 s or a hundred samples", _ages),
    stated("interfaces.*.transport", _written, "transport_s", 0.0, 1.0, "s", "what samples take on their way"),
    stated(_of_ends("deadline"), _profiles, "deadline_s", 1e-4, 600.0, "s", "between samples of a cell"),
    stated(_of_ends("lifespan"), _profiles, "lifespan_s", 1e-4, 3600.0, "s", "for which samples are of use"),
    stated(_of_ends("lease_duration"), _profiles, "lease_duration_s", 1e-3, 600.0, "s", "in which a node is missed"),
    stated("kpis.plan_to_execute", _kpis, "plan_to_execute_s", 1e-3, 60.0, "s", "as planners take"),
    stated("kpis.cancel", _kpis, "cancel_s", 2e-3, 10.0, "s", "from one cycle to a stop by hand"),
    stated("kpis.recovery_time", _kpis, "recovery_time_s", 0.5, 14400.0, "s", "in which a person brings a cell back"),
    stated(
        ("bringup.first_motion.timeout", "bringup.first_motion.*.timeout"),
        *(_first_motions, "timeout_s", 0.1, 300.0, "s", "for which a person waits with a hand on the stop"),
    ),
    stated("rehearsals.*.timeout", _rehearsals, "timeout_s", 0.01, 7200.0, "s", "as tasks take"),
    stated("rehearsals.*.within", _rehearsals, "within_s", 1e-3, 600.0, "s", "in which a fault shows"),
    Bound(
        (
            "rehearsals.*.steps.*.wait",
            *(f"{place}.{key}" for place in _INJECTED for key in ("at", "at.after", "lasting")),
        ),
        "the time",
        "s",
        "within the timeout of its rehearsal",
        _within_rehearsals,
    ),
)


@rule(Severity.WARNING, assumes=("frame-cycle", "missing-velocity-limit", "unprovoked-failure"), gives_way=True)
def implausible_time(graph: CellGraph) -> Findings:
    """Yield times that are outside of what such times are, and paths that an arm goes on for in them."""
    yield from outside(graph, BOUNDS)
