#!/usr/bin/env python3
"""Takes the serialized messages of a running graph into what ``observe`` saw; most are read no further than needed."""

from __future__ import annotations

import importlib
import struct
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any
from xml.etree import ElementTree

from cellc.compiler.emit.launch.observe_checks import Cycles, Package, Reading, Seen, Stream

TRANSFORMS, DESCRIPTION = "tf2_msgs/msg/TFMessage", "std_msgs/msg/String"
DIAGNOSES, NAMES = "diagnostic_msgs/msg/DiagnosticArray", "pal_statistics_msgs/msg/StatisticsNames"
CYCLES, OF_MANAGER = "pal_statistics_msgs/msg/StatisticsValues", ": Controller Manager Activity"
# Of joint states one in so many is read whole, of the others the stamp; a prime, or publishers that alternate hide one.
EACH = 11
READ_S = 0.1  # what a device says of itself is read so often, and the last of it


def stamp_of(data: bytes) -> tuple[float, str]:
    """Return stamp, s, and frame of a serialized message that begins with a header: CDR, as DDS sends it.

    Raises:
        struct.error: the message is too short for it.
    """
    order = "<" if data[1:2] > b"\0" else ">"
    seconds, nanoseconds, length = struct.unpack_from(f"{order}iII", data, 4)
    return seconds + nanoseconds / 1e9, data[16 : 16 + max(0, length - 1)].decode("utf-8", "replace")


def loaded(kind: str) -> Any:
    """Return the class of an interface type such as ``std_msgs/msg/Bool``; None where it is not installed."""
    package, part, name = kind.split("/")
    try:
        return getattr(importlib.import_module(f"{package}.{part}"), name)
    except (ImportError, AttributeError):
        return None


def cycle_of(data: bytes, place: int) -> tuple[int, float]:
    """Return the version of the names, and the value at a place, of a serialized ``StatisticsValues``.

    Source: pal_statistics@1.4.0 pal_statistics_msgs/msg/StatisticsValues.msg

    Raises:
        struct.error: the message is too short for it.
    """
    order = "<" if data[1:2] > b"\0" else ">"
    (length,) = struct.unpack_from(f"{order}I", data, 12)
    begin = 16 + length + -length % 4
    (number,) = struct.unpack_from(f"{order}I", data, begin)
    values = begin + 4 + -begin % 8  # numbers of 8 byte are aligned from the fourth byte on
    (version,) = struct.unpack_from(f"{order}I", data, values + 8 * number)
    return version, struct.unpack_from(f"{order}{number}d", data, values)[place]


def deserialized(data: bytes, kind: Any) -> Any:
    from rclpy.serialization import deserialize_message

    return deserialize_message(data, kind)


class Listener:
    """Takes messages into what is seen."""

    def __init__(self, seen: Seen) -> None:
        self._seen = seen
        self._places: dict[tuple[str, int], int] = {}
        self._waiting: dict[str, tuple[Any, Sequence[str], bytes]] = {}
        self._read_s: dict[str, float] = {}

    def stream(self, topic: str, kind: Any, stamped: bool, data: bytes, received_s: float) -> None:
        stream = self._seen.streams.setdefault(topic, Stream())
        try:
            stream.take(received_s, stamp_of(data) if stamped else None, len(data))
        except struct.error:
            stream.frames.add(f"of a message of {len(data)} bytes")
            return
        if kind.__name__ == "JointState" and len(stream.arrivals) % EACH == 1:
            message = deserialized(data, kind)
            stream.take_joints(message.name, message.position)

    def moving(self, kind: Any, data: bytes, received_s: float) -> None:
        for each in deserialized(data, kind).transforms:
            self._seen.moving.setdefault(each.child_frame_id, set()).add(each.header.frame_id)

    def fixed(self, kind: Any, data: bytes, received_s: float) -> None:
        for each in deserialized(data, kind).transforms:
            at, turned = each.transform.translation, each.transform.rotation
            place = (at.x, at.y, at.z), (turned.x, turned.y, turned.z, turned.w)
            self._seen.fixed.setdefault(each.child_frame_id, set()).add((each.header.frame_id, *place))

    def description(self, kind: Any, data: bytes, received_s: float) -> None:
        try:
            robot = ElementTree.fromstring(deserialized(data, kind).data)
        except ElementTree.ParseError as error:
            robot = ElementTree.Element(f"no XML: {error}")
        self._seen.answers["robot_description"] = robot

    def reading(self, name: str, kind: Any, fields: Sequence[str], data: bytes, received_s: float) -> None:
        """Take what a device says of itself: at most one message in a while is read, and the last."""
        self._waiting[name] = kind, fields, data
        if received_s - self._read_s.get(name, 0.0) >= READ_S:
            self._read_s[name] = received_s
            self._read(name)

    def _read(self, name: str) -> None:
        kind, fields, data = self._waiting.pop(name)
        self._seen.readings.setdefault(name, Reading()).take(said(deserialized(data, kind), fields))

    def finish(self) -> None:
        """Read what waits."""
        for name in [*self._waiting]:
            self._read(name)

    def names(self, node: str, kind: Any, data: bytes, received_s: float) -> None:
        message, wanted = deserialized(data, kind), f"{node.rpartition('/')[2]}.total_time"
        if wanted in message.names:
            self._places[node, message.names_version] = message.names.index(wanted)

    def cycle(self, node: str, data: bytes, received_s: float) -> None:
        try:
            version, _ = cycle_of(data, 0)
            if (node, version) in self._places:
                _, time_us = cycle_of(data, self._places[node, version])
                self._seen.cycles.setdefault(node, Cycles()).times_us.append(time_us)
        except (struct.error, IndexError):
            return

    def diagnosis(self, managers: Sequence[str], kind: Any, data: bytes, received_s: float) -> None:
        """Take what controller managers say of their cycles; several of one name say so under that name."""
        for status in deserialized(data, kind).status:
            for node in managers:
                if status.name in (f"{node}{OF_MANAGER}", f"{node.rpartition('/')[2]}{OF_MANAGER}"):
                    figures = {each.key: each.value for each in status.values}
                    taken = int.from_bytes(status.level, "little"), status.message, figures
                    self._seen.cycles.setdefault(node, Cycles()).statuses.append(taken)


def said(message: Any, fields: Sequence[str]) -> Any:
    """Return the value of one field, or several joined by dots."""
    values = [getattr(message, field) for field in fields]
    return values[0] if len(values) == 1 else ".".join(map(str, values))


def subscribe(graph: Any, package: Package, seen: Seen) -> Listener:
    """Listen to every topic with a rate, to transforms, the description, cycles, and what devices say of themselves."""
    listener = Listener(seen)
    for name, interface in package.contract["interfaces"].items():
        if interface.get("rate_hz") is not None and (kind := installed(interface["type"], seen)):
            stamped = next(iter(kind.get_fields_and_field_types()), "") == "header"
            graph.listen(name, kind, partial(listener.stream, name, kind, stamped))
    if kind := loaded(TRANSFORMS):
        graph.listen("/tf", kind, partial(listener.moving, kind))
        graph.listen("/tf_static", kind, partial(listener.fixed, kind), latched=True)
    if kind := loaded(DESCRIPTION):
        graph.listen("/robot_description", kind, partial(listener.description, kind), latched=True)
    for reading in package.plan["readings"]:
        interface = package.contract["interfaces"][reading["interface"]]
        if interface["kind"] == "topic" and (kind := installed(interface["type"], seen)):
            take = partial(listener.reading, reading["interface"], kind, reading["fields"])
            graph.listen(reading["interface"], kind, take, latched=is_latched(interface))
    reporting = [node for node, states in package.plan["states"].items() if states.get("reports", False)]
    subscribe_to_cycles(graph, reporting, listener, seen)
    return listener


def subscribe_to_cycles(graph: Any, managers: Sequence[str], listener: Listener, seen: Seen) -> None:
    """Listen to what controller managers say of their cycles."""
    names, values = installed(NAMES, seen), installed(CYCLES, seen)
    for node in managers if names and values else ():
        graph.listen(f"{node}/statistics/names", names, partial(listener.names, node, names), latched=True)
        graph.listen(f"{node}/statistics/values", values, partial(listener.cycle, node))
    if managers and (kind := installed(DIAGNOSES, seen)):
        graph.listen("/diagnostics", kind, partial(listener.diagnosis, managers, kind))


def installed(kind: str, seen: Seen) -> Any:
    """Return the class of an interface type; note it where it is not installed."""
    found = loaded(kind)
    if found is None:
        seen.uninstalled.add(kind)
    return found


def is_latched(interface: Mapping[str, Any]) -> bool:
    """Return whether every publisher of a topic keeps its last message for those that come later."""
    kept = [each["qos"]["durability"] == "transient_local" for each in interface.get("sources", ())]
    return bool(kept) and all(kept)
