"""Bounds of speeds: against what the joints of a group reach, and against what can be seen to move."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.commissioning import tip_bounds
from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule
from cellc.contract.fault_declaration import Amount

_Owners = Iterator[tuple[YamlPath, object]]
_SERVO: YamlPath = ("motion", "servo")


def _of_servo(graph: CellGraph) -> tuple[float, float, tuple[Related, ...]]:
    """Return the speed of the tip in m/s and of the fastest joint that Servo's group has, and where it is limited."""
    servo = graph.cell.servo
    group = next((group for group in graph.cell.groups if servo is not None and group.name == servo.group), None)
    if group is None:
        return 0.0, 0.0, ()
    joints = graph.cell.joints_by_name
    own = [joints[name] for name in group.joints if name in joints]
    fastest = max((joint.velocity or 0.0 for joint in own if not joint.slides), default=0.0)
    limits = (*own[0].path[:2], "limits") if own else ()
    related = (Related("the limits of its joints", graph.cell.locate(*limits)),) if graph.cell.states(*limits) else ()
    return graph.once(tip_bounds)[group.name], fastest, related


def _linear(graph: CellGraph) -> Iterator[Figure]:
    tip, _, related = graph.once(_of_servo)
    if graph.cell.servo is not None and tip:
        yield Figure((*_SERVO, "linear"), graph.cell.servo.linear, 1e-4, min(tip, 2.0), related=related)


def _turning(graph: CellGraph) -> Iterator[Figure]:
    _, fastest, related = graph.once(_of_servo)
    servo = graph.cell.servo
    if servo is not None and fastest:
        yield Figure((*_SERVO, "rotational"), servo.rotational, 1e-3, fastest, related=related)
        yield Figure((*_SERVO, "joint"), servo.joint, 1e-3, fastest, related=related)


def _shares(graph: CellGraph) -> _Owners:
    return (((*device.path, "limits"), device.limits.limit_shares) for device in graph.cell.devices)


def _caps(graph: CellGraph) -> _Owners:
    if graph.cell.bringup.caps is not None:
        yield ("bringup", "commissioning"), graph.cell.bringup.caps


def _tip_cap(graph: CellGraph) -> Iterator[Figure]:
    caps = graph.cell.bringup.caps
    if caps is not None and caps.tip_speed is not None:
        yield Figure(("bringup", "commissioning", "velocity"), caps.tip_speed, 5e-3)


def _assessed(graph: CellGraph) -> _Owners:
    if graph.cell.safety.risk_assessment is not None:
        yield ("safety", "risk_assessment"), graph.cell.safety.risk_assessment


def _grips(graph: CellGraph) -> _Owners:
    for device in graph.cell.devices:
        if device.gripper is not None:
            yield (*device.path, "grip"), device.gripper


def _saturated(graph: CellGraph) -> Iterator[Figure]:
    """Yield the speeds at which the mock saturates joints, and to which faults slow them."""
    joints = graph.cell.joints_by_name
    for device in graph.cell.devices:
        for simulated in device.mock.simulated_joints:
            if simulated.velocity is not None:
                most = max((joints[name].velocity or 0.0 for name in simulated.joints), default=0.0)
                yield Figure((*simulated.path, "velocity"), simulated.velocity.value, most * 1e-3, most * 10.0)
    for rehearsal in graph.cell.rehearsals:
        for fault in rehearsal.faults:
            by, joint = fault.kind.by, joints.get(fault.name)
            if by is not None and by.amount is Amount.VELOCITY and joint is not None and fault.amount is not None:
                most = joint.velocity or 0.0
                yield Figure((*fault.path, "to"), fault.amount, most * 1e-3, most)


_JOINTS = "what the fastest joint of its group reaches"
_SLOWEST = "below which a motion takes minutes"
_CRAWLS = "below which nothing is seen to move"
BOUNDS = (
    Bound(("motion.servo.linear",), "`linear`", "m/s", "what the tip of its group reaches, or 2 m/s", _linear),
    Bound(("motion.servo.rotational", "motion.servo.joint"), "the speed about an axis", "rad/s", _JOINTS, _turning),
    stated("devices.*.limits.velocity", _shares, "velocity", 0.01, float("inf"), "%", _SLOWEST),
    stated("devices.*.limits.acceleration", _shares, "acceleration", 0.01, float("inf"), "%", _SLOWEST),
    stated("bringup.commissioning.velocity", _caps, "velocity", 0.01, float("inf"), "%", _SLOWEST),
    stated("bringup.commissioning.acceleration", _caps, "acceleration", 0.01, float("inf"), "%", _SLOWEST),
    Bound(("bringup.commissioning.velocity",), "`velocity`", "mm/s", _CRAWLS, _tip_cap),
    stated("safety.risk_assessment.velocity", _assessed, "velocity", 0.01, 5.0, "m/s", "as tools near people move"),
    stated("devices.*.grip.speed", _grips, "grip_speed_m_s", 1e-3, 5.0, "m/s", "as jaws close"),
    Bound(
        ("devices.*.simulated_joints.*.velocity", "rehearsals.*.inject.to", "rehearsals.*.inject.*.to"),
        "the speed of the joint",
        "rad/s",
        "against what it may reach",
        _saturated,
    ),
)


@rule(
    Severity.WARNING,
    assumes=("limit-share-of-nothing", "missing-velocity-limit", "reversed-limits", "frame-cycle"),
    gives_way=True,
)
def implausible_speed(graph: CellGraph) -> Findings:
    """Yield speeds that no joint of the cell reaches, and such that nothing seems to move with."""
    yield from outside(graph, BOUNDS)


_TWINS = 4.0
"""Ratio of shares above which one of two equal arms is not meant."""


@rule(Severity.WARNING, assumes=("limit-share-of-nothing", "limit-share-above-full"))
def twins_apart(graph: CellGraph) -> Findings:
    """Yield the arm of two equal ones that may be many times as fast as the other."""
    twins: dict[object, list[Device]] = {}
    for device in graph.cell.devices:
        share = device.limits.limit_shares.velocity
        own = tuple((joint.type, round((joint.velocity or 0.0) / share, 6)) for joint in device.actuated_joints)
        if device.kind == "arm" and own and any(speed for _, speed in own):
            twins.setdefault((device.software.packages.driver, own), []).append(device)
    for same in (same for same in twins.values() if len(same) > 1):
        slowest = min(same, key=_velocity_share)
        for device in same:
            if _velocity_share(device) > _TWINS * _velocity_share(slowest):
                path, other = (*device.path, "limits", "velocity"), (*slowest.path, "limits", "velocity")
                message = f"`{device.name}` and `{slowest.name}` are equal arms and must have like limits of velocity,"
                got = f"got {_velocity_share(device):.0%} and {_velocity_share(slowest):.0%}"
                related = (Related("the other arm", graph.cell.locate(*other)),)
                yield found(graph, path, f"{message} {got}", related=related)


def _velocity_share(device: Device) -> float:
    return device.limits.limit_shares.velocity
