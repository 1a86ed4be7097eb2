"""Rules on topics: who sends them, who reads them, and what they say."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import inf

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint
from cellc.compiler.graph.data_flow import interface_types, is_state_on_change, known_topics
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, did_you_mean, found, rule
from cellc.contract.vocabulary import InterfaceKind

DRIFT = 0.01
"""A hundred times what a quartz clock drifts."""

Bounded = tuple[YamlPath, float | None, float, float]
"""A figure at its place, with the least and the greatest value that it may have."""


@rule(Severity.ERROR)
def impossible_simulation(graph: CellGraph) -> Findings:
    """Yield simulated figures outside their range."""
    cell = graph.cell
    for path, value, least, greatest in (*_clocks(cell), *_networks(cell), *_adapters(cell), *_joints(cell)):
        if value is not None and not least <= value <= greatest:
            message = f"`{path[-1]}` must be {_range(least, greatest)}, got `{cell.text(*path)}`"
            yield found(graph, path, message)
    yield from _other_units(graph)


def _range(least: float, greatest: float) -> str:
    if greatest == inf:
        return "above 0" if least > 0.0 else "at least 0"
    return "between 0 % and 100 %" if least == 0.0 else "between -10000 ppm and 10000 ppm"


def _clocks(cell: Cell) -> Iterator[Bounded]:
    for host in cell.hosts.values():
        yield (*host.path, "clock", "simulated_drift"), host.clock.simulated_drift, -DRIFT, DRIFT
    for device in cell.devices:
        if device.sensing.stamp is not None:
            yield (*device.path, "stamp", "simulated_drift"), device.sensing.stamp.clock.simulated_drift, -DRIFT, DRIFT


def _networks(cell: Cell) -> Iterator[Bounded]:
    for interface in cell.interfaces:
        if interface.simulated is not None:
            figures, at = interface.simulated, (*interface.path, "simulated")
            yield (*at, "latency"), figures.latency_s, 0.0, inf
            yield (*at, "jitter"), figures.jitter_s, 0.0, inf
            yield (*at, "loss"), figures.loss, 0.0, 1.0
            yield (*at, "reordering"), figures.reordering, 0.0, 1.0


def _adapters(cell: Cell) -> Iterator[Bounded]:
    shortest_s = 1e-6  # a microsecond: shorter than any command period, and not zero
    for device in cell.devices:
        if device.control.adapter is not None:
            at = (*device.path, "adapter")
            yield (*at, "command_timeout"), device.control.adapter.command_timeout_s, shortest_s, inf
            yield (*at, "stop_time"), device.control.adapter.stop_time_s, shortest_s, inf
            yield (*at, "goal_time"), device.control.adapter.goal_time_s, shortest_s, inf
            allowed = device.control.adapter.path_tolerance
            yield (*at, "path_tolerance"), None if allowed is None else allowed.value, 1e-9, inf


def _joints(cell: Cell) -> Iterator[Bounded]:
    for device in cell.devices:
        for figures in device.mock.simulated_joints:
            noise, velocity = figures.noise, figures.velocity
            yield (*figures.path, "lag"), figures.lag_s, 0.0, inf
            yield (*figures.path, "noise"), None if noise is None else noise.value, 0.0, inf
            # One that never moves is the fault `stick`.
            yield (*figures.path, "velocity"), None if velocity is None else velocity.value, 1e-9, inf


def _other_units(graph: CellGraph) -> Findings:
    """Yield lengths of joints that turn, and angles of joints that slide, once where they are said of all joints."""
    for device in graph.cell.devices:
        for figures in device.mock.simulated_joints:
            joints = [device.joint(name) for name in figures.joints]
            for field, figure in (("noise", figures.noise), ("velocity", figures.velocity)):
                linear = figure is not None and figure.linear
                other = next((joint for joint in joints if (joint.type == "prismatic") != linear), None)
                if figure is not None and other is not None:
                    path = (*figures.path, field)
                    message = f"`{field}` is `{graph.cell.text(*path)}`, but `{other.name}` is {other.type}"
                    yield found(graph, path, message, "write a length where a joint slides, else an angle")


@rule(Severity.ERROR)
def topic_without_rate(graph: CellGraph) -> Findings:
    """Yield topics of the spec without a rate from which a way leads to a controller."""
    without = [
        interface
        for interface in graph.cell.interfaces
        if interface.kind is InterfaceKind.TOPIC and not interface.derived and interface.rate_hz is None
    ]
    feeding = graph.data.feeding_motion() if without else frozenset()
    for interface in without:
        if interface.name in feeding and not is_state_on_change(interface):
            way = graph.data.way_to_motion(interface)
            yield found(graph, interface.path, f"`{interface.name}` feeds motion ({way}) and has no `rate`")


_NUMBER = re.compile(r"std_msgs/msg/(Float|Int|UInt)(8|16|32|64)(MultiArray)?")


@rule(Severity.ERROR)
def unitless_number(graph: CellGraph) -> Findings:
    """Yield topics of plain numbers without a unit."""
    for interface in graph.cell.interfaces:
        if not interface.derived and interface.unit is None and _NUMBER.fullmatch(interface.type):
            message = f"`{interface.name}` carries bare numbers without a unit"
            yield found(graph, interface.path, message)


@rule(Severity.ERROR)
def unoffered_topic(graph: CellGraph) -> Findings:
    """Yield topics of the spec at a device or controller that has their type, but not their name."""
    known = known_topics(graph.cell)
    for interface in graph.cell.interfaces:
        if interface.kind is not InterfaceKind.TOPIC or interface.derived:
            continue
        sides = (
            (interface.sources, known.published, "publish"),
            (interface.sinks, known.subscribed, "subscribe to"),
        )
        for end, topics, does in (
            (end, by_node.get(end.node, {}), does) for ends, by_node, does in sides for end in ends
        ):
            alike = [name for name, type_ in topics.items() if type_ == interface.type]
            if alike and interface.name not in topics:
                message = f"`{end.node}` does not {does} `{interface.name}`"
                advice = did_you_mean(interface.name, alike, f"topics of `{end.node}` with `{interface.type}`")
                yield found(graph, interface.path, message, advice, _by_parameters(graph, end))


def _by_parameters(graph: CellGraph, end: Endpoint) -> tuple[Related, ...]:
    """Return where parameters of a controller are stated on which its topics depend."""
    controller = next((other for other in graph.cell.controllers if other.label == end.node), None)
    kind = None if controller is None else controller.declared
    if controller is None or kind is None:
        return ()
    decides = {name for topic in kind.topics for name in topic.given} & set(controller.written_parameters)
    paths = ((*controller.path, "parameters", name) for name in sorted(decides))
    return tuple(Related("this decides which topics it has", graph.cell.locate(*path)) for path in paths)


@rule(Severity.ERROR)
def unpublished_topic(graph: CellGraph) -> Findings:
    """Yield topics without a publisher."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.TOPIC and not interface.sources:
            yield found(graph, (*interface.path, "from"), f"`{interface.name}` has no publisher")


@rule(Severity.WARNING)
def unread_topic(graph: CellGraph) -> Findings:
    """Yield topics of the spec without a subscriber that are not recorded either."""
    for interface in graph.cell.interfaces:
        if interface.derived or interface.kind is not InterfaceKind.TOPIC or interface.sinks:
            continue
        if interface.name not in graph.cell.recording.topics:
            yield found(graph, interface.path, f"`{interface.name}` has no subscriber")


@rule(Severity.ERROR)
def unstamped_age_limit(graph: CellGraph) -> Findings:
    """Yield topics that feed motion with an age limit and a type without header."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        facts = known.get(interface.type)
        if interface.derived or interface.max_age_s is None or facts is None:
            continue
        if facts.feeds_motion and not facts.stamped:
            stamped = f"{interface.type}Stamped"
            advice = f"use `{stamped}`" if stamped in known else "use a type that begins with a header"
            message = f"`{interface.name}` limits the age of `{interface.type}`, which has no stamp"
            yield found(graph, (*interface.path, "topic"), message, advice)


@rule(Severity.WARNING)
def unstated_need(graph: CellGraph) -> Findings:
    """Yield topics of the spec with a reader and without a stated need."""
    for interface in graph.cell.interfaces:
        if (
            interface.kind is InterfaceKind.TOPIC
            and not interface.derived
            and interface.sinks
            and interface.wants is None
        ):
            message = f"`{interface.name}` does not say whether every sample counts or only the newest"
            yield found(graph, interface.path, message)
