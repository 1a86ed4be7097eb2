"""An MCAP bag as rosbag2 writes it: channels with definitions and offered QoS, messages in order of time.

The definitions in `msg/` hold the fields of common_interfaces, geometry2 and control_msgs without their comments. Where
a distribution has another definition of a type, it is under `msg/<distribution>/`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import BinaryIO, Protocol

import yaml

from cellc.contract.entities import Qos
from cellc.contract.extras import EVIDENCE, gate
from cellc.contract.frozen import dataclass
from cellc.contract.qos import DEFAULT
from cellc.contract.store.regular_file import own_text

_PRIMITIVES = ("bool", "byte", "float64", "int32", "int8", "string", "uint32", "uint8")
"""Those that occur in the definitions here."""
_SEPARATOR = "=" * 80
_FIELD = re.compile(r"([A-Za-z][\w/]*)(?:\[[^\]]*\])? +\w+")

_INFINITE = {"sec": 9223372036, "nsec": 854775807}
"""RMW_DURATION_INFINITE: the largest int64 of nanoseconds."""
# Values of rmw_qos_*_policy_e in rmw/types.h.
_HISTORY = {"keep_last": 1, "keep_all": 2}
_RELIABILITY = {"reliable": 1, "best_effort": 2}
_DURABILITY = {"transient_local": 1, "volatile": 2}
_LIVELINESS = {"automatic": 1, "manual_by_topic": 3}
LATCHED = replace(DEFAULT, durability="transient_local", depth=1)
"""What robot_state_publisher offers for the description and for static transforms."""
PROFILE = "ros2"
LIBRARY = "cellc mock"
"""In place of the name and version of the MCAP library, so that another version writes the same file."""
_CHUNK_BYTES = 1 << 17
"""Bytes of a chunk: what a cut through the file costs."""
_KEPT = 2000
"""Messages that are put in the order of their arrival before they are written."""


def schema(name: str, distro: str) -> str:
    """Return the definition of a message and of all messages in it, in the ros2msg encoding of MCAP.

    Args:
        name: full name, such as `sensor_msgs/msg/JointState`.
        distro: ROS 2 distribution whose definition counts.
    """
    package, _, kind = name.split("/")
    parts = _with_parts(f"{package}/{kind}", distro, [])
    texts = [_text(parts[0], distro), *(f"MSG: {part}\n{_text(part, distro)}" for part in parts[1:])]
    return f"{_SEPARATOR}\n".join(texts)


def _with_parts(name: str, distro: str, found: list[str]) -> list[str]:
    """Return a message and the messages in it, each once, in the order in which they are met."""
    if name not in found:
        found.append(name)
        for part in _parts(name, distro):
            _with_parts(part, distro, found)
    return found


def _parts(name: str, distro: str) -> list[str]:
    package = name.split("/")[0]
    types = [match[1] for match in map(_FIELD.match, _text(name, distro).splitlines()) if match]
    return [kind if "/" in kind else f"{package}/{kind}" for kind in types if kind not in _PRIMITIVES]


def _text(name: str, distro: str) -> str:
    folder = Path(__file__).with_name("msg")
    definition = folder / distro / f"{name}.msg"
    return own_text(definition if definition.is_file() else folder / f"{name}.msg")


def offered_qos_profiles(qos: Qos) -> str:
    """Return the list of the one profile that is offered, as YAML.

    Policies are numbers: Humble reads nothing else, and later decoders try numbers first (ros2/rosbag2, `qos.cpp`).
    """
    profile = {
        "history": _HISTORY[qos.history],
        "depth": qos.depth,
        "reliability": _RELIABILITY[qos.reliability],
        "durability": _DURABILITY[qos.durability],
        "deadline": _duration(qos.deadline_s),
        "lifespan": _duration(qos.lifespan_s),
        "liveliness": _LIVELINESS[qos.liveliness],
        "liveliness_lease_duration": _duration(qos.lease_duration_s),
        "avoid_ros_namespace_conventions": False,
    }
    return yaml.safe_dump([profile], sort_keys=False)


def _duration(seconds: float | None) -> dict[str, int]:
    if seconds is None:
        return dict(_INFINITE)
    nanoseconds = round(seconds * 1e9)
    return {"sec": nanoseconds // 1_000_000_000, "nsec": nanoseconds % 1_000_000_000}


@dataclass(frozen=True, slots=True)
class _Message:
    channel: int
    sequence: int
    log_ns: int
    publish_ns: int
    data: bytes


class MessageWriter(Protocol):
    """Takes the messages of a run, topic by topic: a bag, or a graph that they are published on."""

    def declare(self, topic: str, kind: str, qos: Qos) -> int:
        """Return the channel of a topic."""
        ...

    def write(self, channel: int, data: bytes, publish_ns: int, log_ns: int | None = None) -> None:
        """Take a serialized message."""
        ...


class Bag:
    """Writes messages of declared topics; chunks are not compressed, since compressors change with their version."""

    def __init__(self, file: BinaryIO, distro: str, metadata: Mapping[str, str]) -> None:
        """Begin a file.

        Args:
            distro: ROS 2 distribution whose message definitions count.
            metadata: kept as the MCAP metadata record ``cellc``.
        """
        with gate(EVIDENCE):
            from mcap.writer import CompressionType, Writer
        self._writer = Writer(file, chunk_size=_CHUNK_BYTES, compression=CompressionType.NONE)
        self._writer.start(PROFILE, LIBRARY)
        self._writer.add_metadata("cellc", dict(metadata))
        self._distro = distro
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._sequences: dict[int, int] = {}
        self._pending: list[_Message] = []

    def declare(self, topic: str, kind: str, qos: Qos) -> int:
        """Return the channel of a topic, opened with a type and a profile where it is new."""
        if topic not in self._channels:
            if kind not in self._schemas:
                text = schema(kind, self._distro).encode()
                self._schemas[kind] = self._writer.register_schema(kind, "ros2msg", text)
            metadata = {"offered_qos_profiles": offered_qos_profiles(qos)}
            channel = self._writer.register_channel(topic, "cdr", self._schemas[kind], metadata)
            self._channels[topic] = channel
            self._sequences[channel] = 0
        return self._channels[topic]

    def write(self, channel: int, data: bytes, publish_ns: int, log_ns: int | None = None) -> None:
        """Add a message that was published at a time and has arrived, at the same instant where no other is given."""
        self._sequences[channel] += 1
        log_ns = publish_ns if log_ns is None else log_ns
        self._pending.append(_Message(channel, self._sequences[channel], log_ns, publish_ns, data))
        if len(self._pending) >= _KEPT:
            self._flush(len(self._pending) // 2)  # what comes next may have arrived before the other half

    def finish(self) -> None:
        """Write what is left, the summary and the footer."""
        self._flush()
        finish: Callable[[], object] = self._writer.finish
        finish()

    def _flush(self, count: int | None = None) -> None:
        self._pending.sort(key=lambda message: message.log_ns)
        for each in self._pending[:count]:
            self._writer.add_message(each.channel, each.log_ns, each.data, each.publish_ns, each.sequence)
        del self._pending[:count]
