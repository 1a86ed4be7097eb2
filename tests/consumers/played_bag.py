"""Plays the recording of a rehearsal of the mock in real time, on the graph that its package states.

Run as a module: ``tests.consumers.played_bag PACKAGE BAG SILENT``, with a topic that is not played, or an empty text.
What the recording has comes from it: samples, transforms and diagnoses at their times, with their stamps moved to now.
Nodes, services and topics that it lacks are those of `played_graph`.
"""

from __future__ import annotations

import struct
import sys
import time
from pathlib import Path
from typing import Any

from mcap.reader import make_reader
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import deserialize_message, serialize_message

from tests.consumers.played_graph import Played, loaded

_LATCHED = ("/tf_static", "/robot_description")
_APART_S = 0.019
"""Of what is sampled faster, samples are left out: a node in Python is no faster beside other work."""
_STAMP = struct.Struct("<iI")
"""Of a header that begins a message, behind the four bytes that name its encoding."""
_LEAD_S = 0.5
"""Before the first message, so that none is late; an observer that is started then listens 3 s later at the soonest."""


class Recording(Played):
    """All nodes of the mock target, and the messages of one recording."""

    def __init__(self, folder: Path, bag: Path, silent: str) -> None:
        self.messages: list[tuple[float, str, bytes]] = []
        self.kinds: dict[str, Any] = {}
        last_s: dict[str, float] = {}
        with bag.open("rb") as file:
            for schema, channel, message in make_reader(file).iter_messages():
                self.kinds[channel.topic] = loaded(schema.name if schema is not None else "")
                if channel.topic != silent and message.log_time / 1e9 - last_s.get(channel.topic, -1.0) >= _APART_S:
                    last_s[channel.topic] = message.log_time / 1e9
                    self.messages.append((message.log_time / 1e9, channel.topic, message.data))
        self.publishers: dict[str, Any] = {}
        super().__init__(folder, "mock", "early:/task")

    def publish(self, name: str, interface: Any, kind: Any, publisher: Any) -> None:
        """Keep the publisher of a topic that is in the recording."""
        if name in self.kinds:
            self.publishers.setdefault(name, publisher)
        else:
            super().publish(name, interface, kind, publisher)

    def transforms(self) -> None:
        """Publish those of the recording, and its description."""
        node = self.nodes["/robot_state_publisher"]
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        for topic in ("/tf", *_LATCHED):
            self.publishers.setdefault(
                topic, node.create_publisher(self.kinds[topic], topic, latched if topic in _LATCHED else 100)
            )

    def play(self) -> None:
        """Play the messages at their times, after an observer has found the graph."""
        begun_s = time.time() + _LEAD_S
        for at_s, topic, data in self.messages:
            publisher = self.publishers.get(topic)
            if publisher is None or self.kinds[topic] is None:
                continue
            if topic not in _LATCHED:
                time.sleep(max(0.0, begun_s + at_s - time.time()))
            publisher.publish(self.moved(topic, data, begun_s))

    def moved(self, topic: str, data: bytes, by_s: float) -> bytes:
        """Return a message with its stamps moved from the time of the mock to that of this computer."""
        if "/tf" in topic:
            message = deserialize_message(data, self.kinds[topic])
            for each in message.transforms:
                stamp_s = each.header.stamp.sec + each.header.stamp.nanosec / 1e9 + by_s
                each.header.stamp.sec, each.header.stamp.nanosec = int(stamp_s), int(stamp_s % 1.0 * 1e9)
            return bytes(serialize_message(message))
        if not hasattr(self.kinds[topic](), "header"):
            return data
        sec, nanosec = _STAMP.unpack_from(data, 4)
        stamp_s = sec + nanosec / 1e9 + by_s
        changed = bytearray(data)
        _STAMP.pack_into(changed, 4, int(stamp_s), int(stamp_s % 1.0 * 1e9))
        return bytes(changed)


if __name__ == "__main__":
    import os
    import threading

    recording = Recording(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3])
    threading.Thread(target=recording.run, daemon=True).start()
    while not recording.publishers.keys() >= {"/tf", *_LATCHED}:
        time.sleep(0.05)
    recording.play()
    os._exit(0)
