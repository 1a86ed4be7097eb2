"""What an arrow of the cell's graph says about an interface."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.interface import Interface, InterfaceKind
from cellc.formats.numbers import shortest

TF_RATE_HZ = 20.0
"""Default of robot_state_publisher's ``publish_frequency``; the launch file states it."""

_TRANSFORMS = "tf2_msgs/msg/TFMessage"
# What a type says where the spec need not: TF names two frames in each transform, joints have none.
_FRAMES = {
    _TRANSFORMS: "in each transform",
    "sensor_msgs/msg/JointState": "joints",
    "control_msgs/action/FollowJointTrajectory": "joints",
    "control_msgs/action/GripperCommand": "joints",
    "control_msgs/action/ParallelGripperCommand": "joints",
    "std_msgs/msg/String": "none",
    "sensor_msgs/msg/Image": "of its header",
    "sensor_msgs/msg/PointCloud2": "of its header",
    "sensor_msgs/msg/CameraInfo": "of its header",
}
_UNSTAMPED = ("std_msgs/msg/",)
_PLAIN_TEXT = "std_msgs/msg/String"


def interface_facts(interface: Interface) -> Iterator[str]:
    """Yield type, frame, unit, rate, time source, owner and failure behaviour; what is not stated says so."""
    yield f"{interface.kind.value} {interface.type}, {_rate(interface)}"
    yield f"frame {frame_label(interface)}, unit {_unit(interface)}, time {_time(interface)}"
    yield f"owner {interface.owner or 'not stated'}; {', '.join(_failures(interface)) or 'failure not stated'}"


def frame_label(interface: Interface) -> str:
    """Return the frame of an interface: the stated one, otherwise what its type says."""
    return interface.frame or _FRAMES.get(interface.type, "not stated")


def _unit(interface: Interface) -> str:
    return interface.unit or ("none" if interface.type == _PLAIN_TEXT else "as the type")


def _time(interface: Interface) -> str:
    return interface.time_source or ("none, unstamped" if interface.type.startswith(_UNSTAMPED) else "not stated")


def _rate(interface: Interface) -> str:
    if interface.rate_hz is not None:
        return f"{shortest(interface.rate_hz)} Hz"
    if interface.kind is not InterfaceKind.TOPIC:
        return "on request"
    if _latched(interface):
        return "once, kept for whoever comes later"
    if interface.type == _TRANSFORMS:
        others = ", dynamic frames at their own" if len(interface.sources) > 1 else ""
        return f"{shortest(TF_RATE_HZ)} Hz{others}"
    return "rate not stated"


def _latched(interface: Interface) -> bool:
    return bool(interface.sources) and all(one.qos.durability == "transient_local" for one in interface.sources)


def _failures(interface: Interface) -> Iterator[str]:
    if interface.on_stale is not None:
        age = "" if interface.max_age_s is None else f" after {shortest(interface.max_age_s)} s"
        yield f"stale{age}: {interface.on_stale}"
    elif interface.kind is InterfaceKind.TOPIC and _latched(interface):
        yield "missing: its readers wait"
    if interface.on_timeout is not None:
        bound = "" if interface.timeout_s is None else f" after {shortest(interface.timeout_s)} s"
        yield f"timeout{bound}: {interface.on_timeout}"
    if interface.cancel_within_s is not None:
        yield f"cancel holds within {shortest(interface.cancel_within_s)} s"
    if interface.on_error is not None:
        yield f"error: {interface.on_error}"
