"""The age budget: how old an observation is at the end of the chain of topics that carries it, share by share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

from cellc.cell.cell import Cell
from cellc.cell.interface import Interface, InterfaceKind


@dataclass(frozen=True, slots=True)
class AgeShare:
    """What one topic adds to the age of an observation, in s; a fresh sample is up to one period old."""

    topic: str
    period_s: float
    transport_s: float
    exposure_s: float

    @property
    def total_s(self) -> float:
        """The whole share in s."""
        return self.period_s + self.transport_s + self.exposure_s

    def __str__(self) -> str:
        return f"`{self.topic}` {self.total_s * 1e3:.4g} ms"


def age_chains(cell: Cell) -> Mapping[str, tuple[AgeShare, ...]]:
    """Return, for each topic with a rate, the shares from the sensor to it, the sensor first.

    A node passes the stamp of its input on where its output is in the input's frame, as a detector does that publishes
    poses in the frame of the camera. Of several inputs the freshest counts: whoever is too old by that one is too old
    by all. Topics that only feed each other in a circle observe nothing and stand alone.
    """
    topics = {topic.name: topic for topic in cell.interfaces if topic.kind is InterfaceKind.TOPIC and topic.rate_hz}
    shares = {name: _share(cell, topic) for name, topic in topics.items()}
    passed_on = _passed_on(cell, topics)
    observing = {name for names in passed_on.values() for name in names}
    queue = [(share.total_s, name, "") for name, share in shares.items() if name not in observing]
    heapify(queue)
    chains: dict[str, tuple[AgeShare, ...]] = {}
    while queue:
        age_s, name, before = heappop(queue)
        if name in chains:
            continue
        chains[name] = (*chains.get(before, ()), shares[name])
        for reader in passed_on[name]:
            if reader not in chains:
                heappush(queue, (age_s + shares[reader].total_s, reader, name))
    return {name: chains.get(name, (share,)) for name, share in shares.items()}


def _passed_on(cell: Cell, topics: Mapping[str, Interface]) -> Mapping[str, list[str]]:
    """Return, for each topic, the topics to which its readers pass its stamp on."""
    device_frames = {device.name: frozenset(device.frames.values()) for device in cell.devices}
    published: dict[str, list[Interface]] = {}
    for topic in topics.values():
        for source in topic.sources:
            published.setdefault(source.node, []).append(topic)
    passed_on: dict[str, list[str]] = {}
    for name, topic in topics.items():
        frames = {topic.frame}.union(*(device_frames.get(source.node, ()) for source in topic.sources))
        outputs = (output for sink in topic.sinks for output in published.get(sink.node, ()))
        readers = (output.name for output in outputs if output.frame is not None and output.frame in frames)
        passed_on[name] = [reader for reader in dict.fromkeys(readers) if reader != name]
    return passed_on


def _share(cell: Cell, topic: Interface) -> AgeShare:
    period_s = 1.0 / topic.rate_hz if topic.rate_hz else 0.0
    return AgeShare(topic.name, period_s, topic.transport_s or 0.0, _exposure_s(cell, topic))


def _exposure_s(cell: Cell, topic: Interface) -> float:
    stamps = {device.name: device.stamp for device in cell.devices}
    found = (stamps.get(source.node) for source in topic.sources)
    return max((stamp.exposure_s for stamp in found if stamp is not None and stamp.exposure_s is not None), default=0.0)
