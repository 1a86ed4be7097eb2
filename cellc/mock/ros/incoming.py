"""Reads the messages of nodes under test: object poses and transforms, as they are serialized on the wire."""

from __future__ import annotations

import struct
from collections.abc import Iterator

from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose

_HEADER = 4
_ORDER = {0: ">", 1: "<"}
"""Byte order by representation identifier: CDR_BE and CDR_LE (RTPS 2.5, table 10.3)."""
_NANOSECONDS = 1_000_000_000
_MOST_TRANSFORMS = 100_000


class MalformedMessageError(CellcError):
    """Bytes that are no message of the type of their topic."""


@dataclass(frozen=True, slots=True)
class StampedPose:
    """A geometry_msgs/PoseStamped, or a TransformStamped with its child; m and a quaternion x, y, z, w."""

    stamp_ns: int
    frame: str
    pose: Pose
    child: str = ""


def pose_stamped(data: bytes) -> StampedPose:
    """Read a geometry_msgs/PoseStamped.

    Raises:
        MalformedMessageError: it is another message, or cut short.
    """
    reader = _Reader(data)
    stamp_ns, frame = reader.time(), reader.string()
    return StampedPose(stamp_ns, frame, reader.pose())


def transforms(data: bytes) -> tuple[StampedPose, ...]:
    """Read a tf2_msgs/TFMessage.

    Raises:
        MalformedMessageError: it is another message, or cut short.
    """
    return tuple(_transforms(_Reader(data)))


def _transforms(reader: _Reader) -> Iterator[StampedPose]:
    count = reader.uint32()
    if count > _MOST_TRANSFORMS:
        raise MalformedMessageError(f"{count} transforms in one message")
    for _ in range(count):
        stamp_ns, frame, child = reader.time(), reader.string(), reader.string()
        yield StampedPose(stamp_ns, frame, reader.pose(), child)


class _Reader:
    """Takes values from one message; each is aligned to its own size, counted from the end of the header."""

    def __init__(self, data: bytes) -> None:
        order = _ORDER.get(data[1]) if len(data) >= _HEADER and data[0] == 0 else None
        if order is None:
            raise MalformedMessageError("an unknown representation")
        self._data, self._at, self._order = data, _HEADER, order

    def uint32(self) -> int:
        """Take a uint32, or the length of a sequence."""
        (value,) = self._numbers("I", 4, 1)
        return int(value)

    def time(self) -> int:
        """Take a builtin_interfaces/Time, in ns."""
        (seconds,) = self._numbers("i", 4, 1)
        return int(seconds) * _NANOSECONDS + self.uint32()

    def string(self) -> str:
        """Take a string."""
        size = self.uint32()
        taken = self._data[self._at : self._at + size]
        if len(taken) < size or not taken.endswith(b"\x00"):
            raise MalformedMessageError("a string without its end")
        self._at += size
        return taken[:-1].decode(errors="replace")

    def pose(self) -> Pose:
        """Take a Pose or a Transform, which are alike on the wire."""
        x, y, z, qx, qy, qz, qw = self._numbers("d", 8, 7)
        return Pose((x, y, z), (qx, qy, qz, qw))

    def _numbers(self, code: str, size: int, count: int) -> tuple[float, ...]:
        self._at += -(self._at - _HEADER) % size
        try:
            values = struct.unpack_from(f"{self._order}{count}{code}", self._data, self._at)
        except struct.error:
            raise MalformedMessageError("a message that is too short") from None
        self._at += size * count
        return values
