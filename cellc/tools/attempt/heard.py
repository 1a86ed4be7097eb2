"""Messages of a bag as values of our own, whatever distribution defined them; times are ns of the stamping clock."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from cellc.contract.extras import BAGS, gate
from cellc.contract.vocabulary import Distro
from cellc.tools.attempt.bag import Definition, Raw

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

Vector = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class JointSample:
    """A sensor_msgs/JointState, rad or m."""

    stamp_ns: int
    names: tuple[str, ...]
    positions: Vector


@dataclass(frozen=True, slots=True)
class ControllerSample:
    """A state of a trajectory controller: positions of reference, feedback and error, rad or m.

    Attributes:
        scaling: speed scaling factor, 0 to 1; None where the distribution does not state one.
    """

    stamp_ns: int
    joints: tuple[str, ...]
    reference: Vector
    feedback: Vector
    error: Vector
    scaling: float | None


@dataclass(frozen=True, slots=True)
class Edges:
    """Transforms: stamp and child of each."""

    edges: tuple[tuple[int, str], ...]


@dataclass(frozen=True, slots=True)
class ObservedPose:
    """A geometry_msgs/PoseStamped without its pose."""

    stamp_ns: int
    frame: str


@dataclass(frozen=True, slots=True)
class GoalStates:
    """The goals of an action: id, acceptance on the clock of the server, and state of action_msgs/GoalStatus."""

    goals: tuple[tuple[str, int, int], ...]


@dataclass(frozen=True, slots=True)
class Statuses:
    """A diagnostic_msgs/DiagnosticArray: level, name, message and values of each status."""

    statuses: tuple[tuple[int, str, str, Mapping[str, str]], ...]


@dataclass(frozen=True, slots=True)
class Said:
    """A line on /rosout."""

    level: int
    node: str
    text: str


@dataclass(frozen=True, slots=True)
class Fields:
    """The numbers and truth values of a message of any other type, by the names of their fields."""

    values: Mapping[str, float]


Heard = JointSample | ControllerSample | Edges | ObservedPose | GoalStates | Statuses | Said | Fields


def _ns(stamp: Any) -> int:
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def _vector(values: Any) -> Vector:
    return np.asarray(values, dtype=np.float64)


def _joint_state(message: Any) -> Heard:
    return JointSample(_ns(message.header.stamp), tuple(message.name), _vector(message.position))


def _controller_state(message: Any) -> Heard:
    is_later = hasattr(message, "speed_scaling_factor")  # Humble has desired and actual
    reference = message.reference if hasattr(message, "reference") else message.desired
    feedback = message.feedback if hasattr(message, "feedback") else message.actual
    return ControllerSample(
        _ns(message.header.stamp),
        tuple(message.joint_names),
        _vector(reference.positions),
        _vector(feedback.positions),
        _vector(message.error.positions),
        float(message.speed_scaling_factor) if is_later else None,
    )


def _edges(message: Any) -> Heard:
    return Edges(tuple((_ns(each.header.stamp), each.child_frame_id) for each in message.transforms))


def _pose(message: Any) -> Heard:
    return ObservedPose(_ns(message.header.stamp), message.header.frame_id)


def _goal_states(message: Any) -> Heard:
    return GoalStates(
        tuple(
            (_uuid(each.goal_info.goal_id.uuid), _ns(each.goal_info.stamp), int(each.status))
            for each in message.status_list
        )
    )


def _uuid(octets: Any) -> str:
    text = bytes(bytearray(octets)).hex()
    return f"{text[:8]}-{text[8:12]}-{text[12:16]}-{text[16:20]}-{text[20:]}"


def _statuses(message: Any) -> Heard:
    return Statuses(
        tuple(
            (int(each.level), each.name, each.message, {value.key: value.value for value in each.values})
            for each in message.status
        )
    )


def _said(message: Any) -> Heard:
    return Said(int(message.level), message.name, message.msg)


def _fields(message: Any) -> Heard:
    found = {name: getattr(message, name) for name in message.__dataclass_fields__}
    return Fields({name: value for name, value in found.items() if isinstance(value, (bool, int, float))})


_READ: Mapping[str, Callable[[Any], Heard]] = {
    "sensor_msgs/msg/JointState": _joint_state,
    "control_msgs/msg/JointTrajectoryControllerState": _controller_state,
    "tf2_msgs/msg/TFMessage": _edges,
    "geometry_msgs/msg/PoseStamped": _pose,
    "action_msgs/msg/GoalStatusArray": _goal_states,
    "diagnostic_msgs/msg/DiagnosticArray": _statuses,
    "rcl_interfaces/msg/Log": _said,
}
KINDS = frozenset(_READ)
"""Types that are understood as a whole."""

_UNREADABLE = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, MemoryError, struct.error)


class Decoder:
    """Decodes messages by the definitions in their bag, or by those of a distribution where the bag has none.

    Attributes:
        unreadable: how many messages of each topic could not be decoded.
    """

    def __init__(self, definitions: Mapping[str, Definition], distro: Distro) -> None:
        """Bind the definitions of a bag."""
        with gate(BAGS):
            from rosbags.serde import SerdeError
            from rosbags.typesys import TypesysError
        self._broken: tuple[type[Exception], ...] = (SerdeError, TypesysError, *_UNREADABLE)
        self._definitions = definitions
        self._distro = distro
        self._stores: dict[str, Typestore] = {}
        self.unreadable: dict[str, int] = {}

    def decode(self, raw: Raw) -> Heard | None:
        """Return what a message says; None where it cannot be decoded."""
        try:
            if raw.kind not in self._stores:
                self._stores[raw.kind] = _store(raw.kind, self._definitions.get(raw.kind), self._distro)
            read = _READ.get(raw.kind, _fields)
            return read(self._stores[raw.kind].deserialize_cdr(raw.data, raw.kind))
        except self._broken:
            self.unreadable[raw.topic] = self.unreadable.get(raw.topic, 0) + 1
            return None


def _store(kind: str, definition: Definition | None, distro: Distro) -> Typestore:
    """Return a store that knows one type: as the bag defines it, as the distribution does, or as the mock writes it."""
    with gate(BAGS):
        from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore
    if definition is None:
        known = get_typestore(Stores[f"ROS2_{distro.upper()}"])
        if kind in known.fielddefs:
            return known
        from cellc.mock.evidence.bag.bag_file import schema

        definition = Definition("msg", schema(kind, distro))
    store = get_typestore(Stores.EMPTY)
    if definition.form == "msg":
        store.register(get_types_from_msg(definition.text, kind))
        return store
    for piece in definition.text.split("=" * 80 + "\n"):
        body = piece.partition("\n")[2] if piece.startswith("IDL: ") else piece
        if body.strip():
            store.register(get_types_from_idl(body))
    return store
