"""Bounds of rates: of topics, frames, maps and cards, and of queues."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.rules.bounds import Bound, Figure, outside, stated
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule
from cellc.contract.vocabulary import TRAJECTORIES

_Owners = Iterator[tuple[YamlPath, object]]
_IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/PointCloud2", "sensor_msgs/msg/CompressedImage")


def _topics(graph: CellGraph) -> Iterator[Figure]:
    for interface in graph.cell.interfaces:
        if interface.rate_hz is not None and not interface.derived:
            most = 500.0 if interface.type in _IMAGES else 4000.0
            yield Figure((*interface.path, "rate"), interface.rate_hz, 0.01, most)


def _frames(graph: CellGraph) -> _Owners:
    return ((frame.path, frame) for frame in graph.cell.frames if frame.rate_hz is not None)


def _maps(graph: CellGraph) -> Iterator[Figure]:
    """Yield the rate of the map, which its source bounds."""
    octomap = graph.cell.octomap
    if octomap is None:
        return
    source = next((interface for interface in graph.cell.interfaces if interface.name == octomap.source), None)
    most = 30.0 if source is None or source.rate_hz is None else source.rate_hz
    related = () if source is None else (Related("its source", graph.cell.locate(*source.path, "rate")),)
    yield Figure(("motion", "octomap", "rate"), octomap.rate_hz, 0.05, most, related=related)


def _cards(graph: CellGraph) -> _Owners:
    for host in graph.cell.hosts.values():
        yield from (((*host.path, "nics", name), card) for name, card in host.nics.items())


_SMOOTH_HZ = 25.0
"""Below it, each set point of an arm is a step of its own."""


def _controllers(graph: CellGraph) -> Iterator[Figure]:
    for controller in graph.cell.controllers:
        if controller.update_rate_hz is not None:
            least = _SMOOTH_HZ if controller.behavior in TRAJECTORIES else 1.0
            yield Figure((*controller.path, "update_rate"), controller.update_rate_hz, least, 10_000.0)


def _profiles(graph: CellGraph) -> _Owners:
    for interface in graph.cell.interfaces:
        for end in () if interface.derived else (*interface.sources, *interface.sinks):
            yield end.path, end.qos


BOUNDS = (
    Bound(("interfaces.*.rate",), "`rate`", "Hz", "at which nodes publish", _topics),
    stated("frames.*.rate", _frames, "rate_hz", 0.01, 2000.0, "Hz", "at which nodes publish transforms"),
    Bound(("motion.octomap.rate",), "`rate`", "Hz", "what its source brings", _maps),
    stated("hosts.*.nics.*.speed", _cards, "speed_bps", 1e6, 4e11, "bit/s", "what cards have"),
    Bound(
        ("control.controllers.*.update_rate", "managers.*.controllers.*.update_rate"),
        "`update_rate`",
        "Hz",
        "at which controllers run",
        _controllers,
    ),
    stated(
        tuple(f"interfaces.*.{end}.*.depth" for end in ("from", "to", "client")),
        *(_profiles, "depth", 1, 10_000, "", "what a node can still read"),
    ),
)


@rule(Severity.WARNING, gives_way=True)
def implausible_rate(graph: CellGraph) -> Findings:
    """Yield rates at which nothing of a cell runs, and queues longer than what is ever read."""
    yield from outside(graph, BOUNDS)
