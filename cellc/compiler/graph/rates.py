"""Rates and periods along the topics of a cell, each with the one that bounds it."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.graph.time_pairs import (
    Pair,
    controllers_of,
    cycles_hz,
    number_of,
    rate_path,
    topics_of,
)
from cellc.contract.vocabulary import InterfaceKind


def seen_rates(cell: Cell) -> Iterator[Pair]:
    """What a node says in a frame of a camera is at most as fast as the fastest that it hears from this camera."""
    frames = {device.name: set(device.body.frames.values()) for device in cell.devices if device.sensing.camera}
    topics, seen = [topic for topic in topics_of(cell) if topic.rate_hz], set[str]().union(*frames.values())
    heard_by: dict[str, list[Interface]] = {}
    for topic in topics:
        for node in dict.fromkeys(sink.node for sink in topic.sinks):
            heard_by.setdefault(node, []).append(topic)
    for topic in (topic for topic in topics if topic.frame in seen):
        for source in topic.sources:
            heard = [
                image
                for image in heard_by.get(source.node, ())
                if any(topic.frame in frames.get(camera.node, ()) for camera in image.sources)
            ]
            fastest = max(heard, key=_rate_hz, default=None)
            if fastest is not None:
                yield _of_topic(topic, fastest.rate_hz or 0.0, f"the rate of `{fastest.name}`", fastest)


def _of_topic(topic: Interface, bound_hz: float, because: str, source: Interface | None = None) -> Pair:
    places = () if source is None else (("what it is seen in", (*source.path, "rate")),)
    return Pair((*topic.path, "rate"), f"`rate` of `{topic.name}`", topic.rate_hz or 0.0, bound_hz, because, places)


def published_rates(cell: Cell) -> Iterator[Pair]:
    """A topic of a camera or controller is at most as fast as this publishes it."""
    sources: dict[str, list[tuple[str, float]]] = {}
    for device in cell.devices:
        streams = () if device.sensing.camera is None else device.sensing.camera.streams
        sources[device.name] = [(stream.topic, stream.rate_hz) for stream in streams]
    for manager, controller in controllers_of(cell):
        rates = [(topic.name, topic.rate_hz) for topic in controller.own_topics if topic.rate_hz is not None]
        sources[controller.label] = [*rates, ("", cycles_hz(manager, controller))]
    for topic in topics_of(cell):
        for node in (
            dict.fromkeys(source.node for source in topic.sources) if topic.rate_hz and not topic.derived else ()
        ):
            for name, rate_hz in sources.get(node, ()):
                if name in ("", topic.name):
                    yield _of_topic(topic, rate_hz, f"the rate at which `{node}` publishes it")


def map_rates(cell: Cell) -> Iterator[Pair]:
    """A map is updated at most as often as what feeds it."""
    octomap = cell.octomap
    for topic in topics_of(cell):
        if octomap is not None and topic.name == octomap.source and topic.rate_hz:
            because = f"the rate of `{topic.name}`"
            places = (("what feeds it", (*topic.path, "rate")),)
            yield Pair(
                ("motion", "octomap", "rate"), "`rate` of the map", octomap.rate_hz, topic.rate_hz, because, places
            )


def own_rates(cell: Cell) -> Iterator[Pair]:
    """A controller publishes in its cycles, and no more often."""
    for manager, controller in controllers_of(cell):
        kind = controller.declared
        for topic in controller.own_topics if kind is not None else ():
            name = topic.declared.rate
            if topic.rate_hz is not None and name in controller.written_parameters:
                because = f"the rate of `{controller.name}`"
                places = (("its cycles are here", rate_path(cell, manager, controller)),)
                path = (*controller.path, "parameters", name or "")
                subject, bound_hz = f"`{name}` of `{controller.name}`", cycles_hz(manager, controller)
                yield Pair(path, subject, topic.rate_hz, bound_hz, because, places)


def transform_rates(cell: Cell) -> Iterator[Pair]:
    """A frame comes at least as often as the poses that are said in it, and as the slowest that it may be made of."""
    types = interface_types()
    dynamic = [frame for frame in cell.frames if frame.kind is FrameKind.DYNAMIC and frame.rate_hz is not None]
    said: dict[str | None, list[Interface]] = {}
    made: dict[tuple[str | None, str], list[Interface]] = {}
    for topic in topics_of(cell) if dynamic else ():
        facts = types.get(topic.type)
        if facts is not None and facts.feeds_motion and facts.unit == "m" and topic.rate_hz:
            said.setdefault(topic.frame, []).append(topic)
            for end in topic.sources:
                made.setdefault((topic.frame, end.node), []).append(topic)
    for frame in dynamic:
        slowest = sorted(made.get((frame.parent, frame.authority), ()), key=_rate_hz)[:1]
        followed = [(topic, "it follows") for topic in slowest]
        for topic, how in (*followed, *((topic, "are in it") for topic in said.get(frame.name, ()))):
            because = f"the rate of `{topic.name}`, whose poses {how}"
            places = (("the poses are here", (*topic.path, "rate")),)
            path, subject = (*frame.path, "rate"), f"`rate` of `{frame.name}`"
            yield Pair(path, subject, frame.rate_hz or 0.0, _rate_hz(topic), because, places)


def _rate_hz(topic: Interface) -> float:
    return topic.rate_hz or 0.0


def ages_of_goals(cell: Cell) -> Iterator[Pair]:
    """A sample is not used for longer than the goal that it was used for may take."""
    actions = [action for action in cell.interfaces if action.kind is InterfaceKind.ACTION and action.timeout_s]
    for topic in topics_of(cell):
        readers = {sink.node for sink in topic.sinks}
        for action in actions if topic.max_age_s is not None else ():
            if not readers.isdisjoint(sink.node for sink in action.sinks):
                subject, because = f"`max_age` of `{topic.name}`", f"the timeout of `{action.name}`"
                places = (("the goal is bounded here", (*action.path, "timeout")),)
                path = (*topic.path, "max_age")
                yield Pair(path, subject, topic.max_age_s or 0.0, action.timeout_s or 0.0, because, places)


_EXPOSED = 32.2 / (1000.0 / 30.0)
"""Share of a period for which a camera can expose: above 32.2 ms at 30 Hz it sends every second image alone.

Source: the page of `exposure-beyond-period`.
"""


def exposures(cell: Cell) -> Iterator[Pair]:
    """A camera takes no image while it exposes the one before."""
    fastest: dict[str, Interface] = {}
    for topic in topics_of(cell):
        for end in topic.sources if topic.rate_hz else ():
            fastest[end.node] = max(fastest.get(end.node, topic), topic, key=_rate_hz)
    for device in cell.devices:
        sent, exposure_s = fastest.get(device.name), device.sensing.exposure_s
        if sent is not None and exposure_s and device.sensing.camera is not None:
            because = f"the period of `{sent.name}`, {_rate_hz(sent):g} Hz, less what lies between two exposures"
            places = (("its rate is here", (*sent.path, "rate")),)
            path, subject = (*device.path, "stamp", "exposure"), f"the exposure of `{device.name}`"
            yield Pair(path, subject, exposure_s, _EXPOSED / _rate_hz(sent), because, places)


def silences(cell: Cell) -> Iterator[Pair]:
    """A controller that gives up after a silence waits for two commands, so that one that is late stops nothing."""
    silent = {
        controller.label: controller for controller in cell.controllers if number_of(controller.parameters.get(SILENCE))
    }
    for topic in topics_of(cell) if silent else ():
        for end in topic.sinks if topic.rate_hz else ():
            if (controller := silent.get(end.node)) is not None:
                path, subject = (*controller.path, "parameters", SILENCE), f"`{SILENCE}` of `{controller.name}`"
                places = (("its rate is here", (*topic.path, "rate")),)
                silence_s = number_of(controller.parameters.get(SILENCE)) or 0.0
                bound_s, because = 2.0 / _rate_hz(topic), f"two periods of `{topic.name}`"
                yield Pair(path, subject, silence_s, bound_s, because, places)


SILENCE = "cmd_timeout"


def leases(cell: Cell) -> Iterator[Pair]:
    """A publisher that asserts itself by what it sends is there for as long as a sample takes."""
    for topic in topics_of(cell):
        for end in (*topic.sources, *topic.sinks) if topic.rate_hz else ():
            lease_s = end.qos.lease_duration_s
            if end.qos.liveliness == "manual_by_topic" and lease_s is not None:
                path, subject = (*end.path, "lease_duration"), f"`lease_duration` of `{end.node}` on `{topic.name}`"
                places = (("its rate is here", (*topic.path, "rate")),)
                yield Pair(path, subject, lease_s, 1.0 / _rate_hz(topic), "its period", places)
