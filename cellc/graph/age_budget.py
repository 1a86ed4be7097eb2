"""The age budget: how old an observation is at the end of the chain of topics that carries it, share by share."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

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


def age_shares(cell: Cell, topic: Interface) -> tuple[AgeShare, ...]:
    """Return the shares from the sensor to a topic, the sensor first; empty for a topic without a rate.

    A node passes the stamp of its input on where its output is in the input's frame, as a detector does that publishes
    poses in the frame of the camera. Of several inputs the freshest counts:
    whoever is too old by that one is too old by all.
    """
    return _shares(cell, topic, frozenset())


def _shares(cell: Cell, topic: Interface, seen: frozenset[str]) -> tuple[AgeShare, ...]:
    if not topic.rate_hz:
        return ()
    share = AgeShare(topic.name, 1.0 / topic.rate_hz, topic.transport_s or 0.0, _exposure_s(cell, topic))
    seen = seen | {topic.name}
    chains = [_shares(cell, source, seen) for source in _observed(cell, topic) if source.name not in seen]
    return (*min(chains, key=lambda chain: sum(part.total_s for part in chain), default=()), share)


def _observed(cell: Cell, topic: Interface) -> Iterator[Interface]:
    """Yield the topics whose stamps the publisher of a topic passes on."""
    nodes = {source.node for source in topic.sources}
    frames = {device.name: frozenset(device.frames.values()) for device in cell.devices}
    for candidate in cell.interfaces:
        if candidate.kind is not InterfaceKind.TOPIC or nodes.isdisjoint(sink.node for sink in candidate.sinks):
            continue
        known = {candidate.frame}.union(*(frames.get(source.node, frozenset()) for source in candidate.sources))
        if topic.frame is not None and topic.frame in known:
            yield candidate


def _exposure_s(cell: Cell, topic: Interface) -> float:
    stamps = {device.name: device.spec.stamp for device in cell.devices}
    found = (stamps.get(source.node) for source in topic.sources)
    return max((stamp.exposure.si for stamp in found if stamp is not None and stamp.exposure is not None), default=0.0)
