"""One MCAP file, written as the run goes on: nothing of the host, the hour or a library's version enters it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import BinaryIO

from mcap.writer import CompressionType, Writer

from cellc.contract.contract import ContractQos
from cellc.mock.evidence.bag.definitions import schema
from cellc.mock.evidence.bag.offered_qos import offered_qos_profiles

PROFILE = "ros2"
LIBRARY = "cellc mock"
"""In place of the name and version of the MCAP library, so that another version writes the same file."""
_KEPT = 2000
"""Messages that are put in the order of their arrival before they are written."""


@dataclass(frozen=True, slots=True)
class _Message:
    channel: int
    sequence: int
    log_ns: int
    publish_ns: int
    data: bytes


class Bag:
    """Writes messages of declared topics; chunks are not compressed, since compressors change with their version."""

    def __init__(self, file: BinaryIO, distro: str, metadata: Mapping[str, str]) -> None:
        """Begin a file.

        Args:
            distro: ROS 2 distribution whose message definitions count.
            metadata: kept as the MCAP metadata record ``cellc``.
        """
        self._writer = Writer(file, compression=CompressionType.NONE)
        self._writer.start(PROFILE, LIBRARY)
        self._writer.add_metadata("cellc", dict(metadata))
        self._distro = distro
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._sequences: dict[int, int] = {}
        self._pending: list[_Message] = []

    def declare(self, topic: str, kind: str, qos: ContractQos) -> int:
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
        """Add a message that was published at a time and has arrived, at the same instant where no other is told."""
        self._sequences[channel] += 1
        log_ns = publish_ns if log_ns is None else log_ns
        self._pending.append(_Message(channel, self._sequences[channel], log_ns, publish_ns, data))
        if len(self._pending) >= _KEPT:
            self._flush()

    def finish(self) -> None:
        """Write what is left, the summary and the footer."""
        self._flush()
        finish: Callable[[], object] = self._writer.finish
        finish()

    def _flush(self) -> None:
        for each in sorted(self._pending, key=lambda message: message.log_ns):
            self._writer.add_message(each.channel, each.log_ns, each.data, each.publish_ns, each.sequence)
        self._pending.clear()
