"""Rules on the types of interfaces."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from difflib import SequenceMatcher

from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.data_flow import KnownTopics, interface_types, known_topics
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, meant, rule, write
from cellc.contract.vocabulary import InterfaceKind

_FOLDER = {InterfaceKind.TOPIC: "msg", InterfaceKind.SERVICE: "srv", InterfaceKind.ACTION: "action"}


@rule(Severity.ERROR)
def interface_kind_mismatch(graph: CellGraph) -> Findings:
    """Yield interfaces whose type is in the folder of another kind."""
    for interface in graph.cell.interfaces:
        parts = interface.type.split("/")
        expected = _FOLDER[interface.kind]
        if len(parts) == 3 and parts[1] in _FOLDER.values() and parts[1] != expected:
            message = (
                f"{interface.kind.value} `{interface.name}` must have a type of `{expected}`, got `{interface.type}`"
            )
            path = (*interface.path, interface.kind.value)
            other = next(kind.value for kind, folder in _FOLDER.items() if folder == parts[1])
            yield found(graph, path, message, f"use a type of `{expected}`, or declare the interface as `{other}`")


_TYPE = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9]*")


@rule(Severity.ERROR)
def malformed_interface_type(graph: CellGraph) -> Findings:
    """Yield types of another shape."""
    for interface in graph.cell.interfaces:
        if _TYPE.fullmatch(interface.type) is None:
            message = f"`{interface.type}` is not an interface type"
            parts = interface.type.split("/")
            nearest = (
                f"{parts[0]}/{_FOLDER[interface.kind]}/{parts[-1]}" if len(parts) == 2 else "sensor_msgs/msg/Image"
            )
            yield found(
                graph, (*interface.path, interface.kind.value), message, f"write three parts, such as `{nearest}`"
            )


@rule(Severity.ERROR)
def type_conflict(graph: CellGraph) -> Findings:
    """Yield interfaces of the spec one of whose devices or controllers has another type for the name."""
    for interface in graph.cell.interfaces:
        for node, real in _types(graph, interface):
            if real is not None and real != interface.type:
                message = f"`{interface.name}` is declared as `{interface.type}`, but `{node}` has `{real}`"
                yield found(graph, (*interface.path, interface.kind.value), message, write(real, interface.type))


def _types(graph: CellGraph, interface: Interface) -> Iterator[tuple[str, str | None]]:
    """Yield each end with the type that it is known to have for the name."""
    topics, actions = graph.once(_topics), graph.once(_actions)
    for source in interface.sources:
        known = topics.published.get(source.node, {}).get(interface.name)
        yield source.node, known or actions.get((source.node, interface.name))
    for sink in interface.sinks:
        yield sink.node, topics.subscribed.get(sink.node, {}).get(interface.name)


def _topics(graph: CellGraph) -> KnownTopics:
    return known_topics(graph.cell)


def _actions(graph: CellGraph) -> Mapping[tuple[str, str | None], str | None]:
    return {
        (controller.label, controller.action): controller.action_type for controller in reversed(graph.cell.controllers)
    }


@rule(Severity.ERROR)
def type_of_another_distribution(graph: CellGraph) -> Findings:
    """Yield known types that the distribution does not have."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        facts = known.get(interface.type)
        if facts is not None and facts.only and graph.cell.distro not in facts.only and not interface.derived:
            message = f"`{interface.type}` does not exist in {graph.cell.distro}"
            names = ", ".join(facts.only)
            yield found(
                graph, (*interface.path, interface.kind.value), message, f"it exists in {names}; use another type"
            )


_OF_DEPTH = {"16UC1": "mm", "32FC1": "m"}
"""Unit of a depth image by its encoding; source: REP 118."""
_UNITS = frozenset(
    ("m", "mm", "cm", "km", "um", "in", "rad", "deg", "rad/s", "deg/s", "m/s", "mm/s", "m/s^2", "N", "kN", "N m", "Nm")
) | {"px", "s", "ms", "us", "K", "degC", "V", "mV", "A", "mA", "%"}
"""Units that a message could have; other words are the author's own."""


@rule(Severity.ERROR)
def unit_of_another_message(graph: CellGraph) -> Findings:
    """Yield units of the spec that are not those which the type of a message, or the encoding of an image, fixes."""
    streams = {
        (device.name, stream.topic): _OF_DEPTH.get(stream.encoding or "")
        for device in graph.cell.devices
        for stream in (() if device.sensing.camera is None else device.sensing.camera.streams)
    }
    types = interface_types()
    for interface in graph.cell.interfaces:
        if interface.derived or interface.unit is None:
            continue
        ends = (streams.get((source.node, interface.name)) for source in interface.sources)
        facts = types.get(interface.type)
        fixed = next(filter(None, ends), None) or (None if facts is None else facts.unit)
        if interface.type in _JOGGED and _is_unitless(graph, interface):
            fixed = _SHARES
        stated = _units(interface.unit)
        if fixed is not None and stated and stated <= _UNITS and not stated & _units(fixed):
            message = f"`{interface.name}` carries {fixed}, by what its messages are, got `{interface.unit}`"
            advice = f"write `unit: {fixed}`, and convert in the consumer"
            yield found(graph, (*interface.path, "unit"), message, advice)


_SHARES = "shares from -1 to 1"
_JOGGED = frozenset(("geometry_msgs/msg/TwistStamped", "control_msgs/msg/JointJog"))


def _is_unitless(graph: CellGraph, interface: Interface) -> bool:
    """Whether MoveIt Servo takes the numbers of a topic for shares of its largest speeds."""
    servo = graph.cell.servo
    return (
        servo is not None and servo.commands == "unitless" and any(sink.node == servo.node for sink in interface.sinks)
    )


def _units(text: str) -> frozenset[str]:
    return frozenset(filter(None, (word.strip() for word in re.split(r",| and | or ", text))))


_ALIKE = 0.8  # ratio of difflib: one letter in a word of four, two in a word of ten


@rule(Severity.ERROR, assumes=("interface-kind-mismatch", "malformed-interface-type"))
def unknown_interface_type(graph: CellGraph) -> Findings:
    """Yield types that are not known and nearly are."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        if interface.type not in known and interface.type.count("/") == 2:
            close = [name for name in known if _alike(name, interface.type)]
            if close:
                path = (*interface.path, interface.kind.value)
                advice = meant(interface.type, close[:1])
                yield found(graph, path, f"there is no interface type `{interface.type}`", advice)


def _alike(known: str, written: str) -> bool:
    """Tell whether one word of the type differs by a typing error; `UInt32` and `Int16` are no misspellings of
    `Int32`."""
    words, others = (re.findall(r"[A-Z][a-z]*|[a-z]+|[0-9]+|[/_]", name) for name in (known, written))
    differing = [(word, other) for word, other in zip(words, others, strict=False) if word != other]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    return word.isalpha() and SequenceMatcher(None, word, other).ratio() >= _ALIKE
