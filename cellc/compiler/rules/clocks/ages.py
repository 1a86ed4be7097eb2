"""Rules on how old a sample may be, and on what happens when it is older."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.data_flow import age_chains, age_share, is_state_on_change
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import InterfaceKind


@rule(Severity.ERROR, assumes=("max-age-too-short",))
def age_budget_exceeded(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below the sum of the shares of their chain."""
    chains = age_chains(graph.cell)
    for interface in graph.cell.interfaces:
        shares = chains.get(interface.name, ())
        needed = sum(share.total_s for share in shares)
        if interface.max_age_s is None or len(shares) < 2 or interface.max_age_s >= needed:
            continue
        way = " + ".join(str(share) for share in shares)
        age = interface.max_age_s * 1e3
        message = f"`max_age` of `{interface.name}` must be at least {needed * 1e3:.4g} ms ({way}), got {age:g} ms"
        related = tuple(
            Related("part of the chain", graph.cell.locate("interfaces", share.topic)) for share in shares[:-1]
        )
        advice = f"allow at least {math.ceil(needed * 1e3)} ms, or raise a rate of the chain"
        yield found(graph, (*interface.path, "max_age"), message, advice, related)


@rule(Severity.ERROR)
def continues_on_stale(graph: CellGraph) -> Findings:
    """Yield topics on which a stale sample changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_stale == "continue":
            message = f"`{interface.name}` is used even when it is stale"
            path = (*interface.path, "on_stale")
            yield found(graph, path, message)


@rule(Severity.ERROR)
def continues_on_timeout(graph: CellGraph) -> Findings:
    """Yield services and actions whose timeout changes nothing."""
    for interface in graph.cell.interfaces:
        if interface.on_timeout == "continue":
            message = f"the client of `{interface.name}` continues when no answer comes"
            yield found(graph, (*interface.path, "on_timeout"), message)


_ROUNDING = 1.001


@rule(Severity.WARNING)
def faster_than_its_source(graph: CellGraph) -> Findings:
    """Yield topics of a node in a frame of a camera that are faster than all that it hears from this camera."""
    frames = {
        device.name: set(device.body.frames.values())
        for device in graph.cell.devices
        if device.sensing.camera is not None
    }
    topics = [
        interface for interface in graph.cell.interfaces if interface.kind is InterfaceKind.TOPIC and interface.rate_hz
    ]
    heard_by: dict[str, list[Interface]] = {}
    for topic in topics:
        for node in dict.fromkeys(sink.node for sink in topic.sinks):
            heard_by.setdefault(node, []).append(topic)
    for topic in topics:
        for source in topic.sources:
            heard = [interface for interface in heard_by.get(source.node, ()) if _seen_by(interface, topic, frames)]
            fastest = max(heard, key=lambda one: one.rate_hz or 0.0, default=None)
            if fastest is not None and (topic.rate_hz or 0.0) > (fastest.rate_hz or 0.0) * _ROUNDING:
                message = f"`{topic.name}` must be at most as fast as `{fastest.name}`, {fastest.rate_hz:g} Hz,"
                related = (Related("what it is seen in", graph.cell.locate(*fastest.path, "rate")),)
                yield found(graph, (*topic.path, "rate"), f"{message} got {topic.rate_hz:g} Hz", related=related)


def _seen_by(image: Interface, topic: Interface, frames: dict[str, set[str]]) -> bool:
    return any(topic.frame in frames.get(source.node, ()) for source in image.sources)


@rule(Severity.WARNING)
def faster_than_the_device(graph: CellGraph) -> Findings:
    """Yield topics of cameras and broadcasters with a rate above that of their source."""
    sources = _sources(graph)
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived or not interface.rate_hz:
            continue
        for source, rate_hz in _rates(sources, interface):
            if interface.rate_hz > rate_hz * _ROUNDING:
                message = f"`{interface.name}` must be at most as fast as `{source}` publishes it, {rate_hz:g} Hz,"
                yield found(graph, (*interface.path, "rate"), f"{message} got {interface.rate_hz:g} Hz")
                break


def _sources(graph: CellGraph) -> dict[str, list[tuple[str, float]]]:
    """Return the topics, and the rate in Hz, of each device and controller; none is faster than its cycles."""
    found: dict[str, list[tuple[str, float]]] = {}
    for device in graph.cell.devices:
        streams = () if device.sensing.camera is None else device.sensing.camera.streams
        found.setdefault(device.name, []).extend((stream.topic, stream.rate_hz) for stream in streams)
    for manager in graph.cell.managers:
        for controller in manager.controllers:
            cycles = controller.update_rate_hz or manager.update_rate_hz
            rates = [(topic.name, topic.rate_hz) for topic in controller.own_topics if topic.rate_hz is not None]
            found.setdefault(controller.label, []).extend([*rates, ("", cycles)])
    return found


def _rates(sources: Mapping[str, list[tuple[str, float]]], interface: Interface) -> Iterator[tuple[str, float]]:
    """Yield the sources of a topic whose rate is known, Hz."""
    for name in dict.fromkeys(source.node for source in interface.sources):
        yield from ((name, rate_hz) for topic, rate_hz in sources.get(name, ()) if topic in ("", interface.name))


@rule(Severity.ERROR)
def max_age_beyond_timeout(graph: CellGraph) -> Findings:
    """Yield topics that may be older than the timeout of an action that their subscriber calls."""
    actions = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.ACTION and interface.timeout_s
    ]
    for topic in graph.cell.interfaces:
        if topic.max_age_s is None:
            continue
        readers = {sink.node for sink in topic.sinks}
        for action in actions:
            if readers.isdisjoint(sink.node for sink in action.sinks) or topic.max_age_s <= (action.timeout_s or 0.0):
                continue
            message = (
                f"`max_age` of `{topic.name}` must be at most {action.timeout_s:g} s, the timeout of `{action.name}`, "
                f"got {topic.max_age_s:g} s"
            )
            related = (Related("the goal is bounded here", graph.cell.locate(*action.path, "timeout")),)
            yield found(graph, (*topic.path, "max_age"), message, related=related)
            break


@rule(Severity.ERROR)
def max_age_too_short(graph: CellGraph) -> Findings:
    """Yield topics whose age limit is below their budget."""
    for interface in graph.cell.interfaces:
        if interface.max_age_s is None or not interface.rate_hz:
            continue
        share = age_share(graph.cell, interface)
        if interface.max_age_s < share.total_s:
            parts = (
                f"period {share.period_s * 1e3:.4g}, transport {share.transport_s * 1e3:g}, "
                f"exposure {share.exposure_s * 1e3:g} ms"
            )
            bound, age = share.total_s * 1e3, interface.max_age_s * 1e3
            message = f"`max_age` of `{interface.name}` must be at least {bound:.4g} ms ({parts}), got {age:g} ms"
            path = (*interface.path, "max_age")
            yield found(graph, path, message, f"allow at least {math.ceil(bound)} ms, or raise the rate")


@rule(Severity.ERROR)
def missing_max_age(graph: CellGraph) -> Findings:
    """Yield topics without an age limit from which a way leads to a controller."""
    unlimited = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.max_age_s is None
    ]
    feeding = graph.data.feeding_motion() if unlimited else frozenset()
    for interface in unlimited:
        if interface.name in feeding and not is_state_on_change(interface):
            way = graph.data.way_to_motion(interface)
            message = f"`{interface.name}` feeds motion ({way}) and has no `max_age`"
            yield found(graph, interface.path, message)


@rule(Severity.ERROR)
def unstated_stale_behavior(graph: CellGraph) -> Findings:
    """Yield topics with an age limit and nothing that follows from it."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.max_age_s is not None and interface.on_stale is None:
            message = f"`{interface.name}` has a `max_age` of {interface.max_age_s:g} s but no `on_stale`"
            yield found(graph, interface.path, message)
