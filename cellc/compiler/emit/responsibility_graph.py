"""``graph/responsibility.mmd``: who tells what to whom, and its owner, on one page.

Mermaid flowchart, for code hosts and editors that draw it. Every arrow carries type, frame, unit, rate, time source,
owner and failure behavior; an interface with several ends carries them once, in a box between its ends, whose arrows
tell the QoS. Vendor control and physical safety are boundaries of their own, drawn bold. Left out: what every ROS node
has anyway, such as parameter services and ``/rosout``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.labels import (
    claim_facts,
    driver_facts,
    interface_facts,
    stop_facts,
    unused,
    unused_facts,
    unused_title,
)
from cellc.compiler.formats.escape import mermaid
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import InterfaceKind

_BOLD = "stroke-width:5px,stroke:#000,fill:none"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the diagram."""
    lines = ["flowchart LR", *(f"  {line}" for line in _diagram(graph.cell))]
    yield Artifact("graph/responsibility.mmd", plan.header.commented("%%") + "\n".join(lines) + "\n")


def _diagram(cell: Cell) -> Iterator[str]:
    yield from _ros_graph(cell)
    yield from _vendor_control(cell)
    yield from _physical_safety(cell)
    groups = unused(cell)
    alone = {interface.name for group in groups for interface in group}
    for interface in cell.interfaces:
        if interface.name not in alone:
            yield from _arrows(cell, interface)
    for group in groups:
        yield from _unused(cell, group)
    yield from _claims(cell)
    yield from _drivers(cell)
    yield f"style vendor {_BOLD}"
    yield f"style safety {_BOLD}"


def _ros_graph(cell: Cell) -> Iterator[str]:
    yield 'subgraph ros["ROS 2 graph"]'
    for node in cell.nodes:
        yield f"  {_box('node', node.full_name[1:], f'{node.package}/{node.executable}', f'owner {node.owner}')}"
    for controller in cell.controllers:
        client = f"commanded by {controller.client}" if controller.client else "no client"
        yield f"  {_box('node', controller.full_name[1:], controller.plugin, client)}"
    yield "end"


def _vendor_control(cell: Cell) -> Iterator[str]:
    owner = cell.owners.responsibilities.vendor_safety
    yield f'subgraph vendor["{_text(f"Vendor control: servo, limits, safety state; owner {owner}")}"]'
    for device in cell.devices:
        yield f"  {_box('device', device.name, device.model, device.architecture)}"
    yield "end"


def _physical_safety(cell: Cell) -> Iterator[str]:
    stop = cell.safety.stop
    owner = cell.owners.responsibilities.physical_stop
    yield 'subgraph safety["Physical safety: outside of all software"]'
    yield f"  {_box('stop', stop.authority, f'path {stop.path}', f'owner {owner}')}"
    yield "end"
    for device in cell.devices:
        if device.is_driven:
            label = _text("stops, independent of software", *stop_facts(cell))
            yield f'{_id("stop", stop.authority)} == "{label}" ==> {_id("device", device.name)}'


def _arrows(cell: Cell, interface: Interface) -> Iterator[str]:
    # A sample travels from the publisher to the subscriber, a goal or a request from the client to the server.
    topic = interface.kind is InterfaceKind.TOPIC
    starts, ends = (interface.sources, interface.sinks) if topic else (interface.sinks, interface.sources)
    if len(starts) == len(ends) == 1:
        label = _text(interface.name, *interface_facts(interface))
        yield f'{_end(cell, starts[0])} -- "{label}" --> {_end(cell, ends[0])}'
        return
    yield _box("interface", interface.name, *interface_facts(interface))
    hub = _id("interface", interface.name)
    yield from (f'{_end(cell, start)} -- "{_qos(start)}" --> {hub}' for start in starts)
    yield from (f'{hub} -- "{_qos(end)}" --> {_end(cell, end)}' for end in ends)


def _unused(cell: Cell, group: tuple[Interface, ...]) -> Iterator[str]:
    yield _box("interface", group[0].name, unused_title(group), *unused_facts(group))
    hub, topic = _id("interface", group[0].name), group[0].kind is InterfaceKind.TOPIC
    for source in group[0].sources:
        start, end = (_end(cell, source), hub) if topic else (hub, _end(cell, source))
        yield f"{start} --> {end}"


def _qos(end: Endpoint) -> str:
    history = f"last {end.qos.depth}" if end.qos.history == "keep_last" else "all"
    return f"{end.qos.reliability}, {end.qos.durability}, {history}"


def _claims(cell: Cell) -> Iterator[str]:
    for manager in cell.managers:
        for controller in manager.controllers:
            if controller.device is not None and controller.command_interfaces:
                label = _text("claims", *claim_facts(cell, manager, controller))
                arrow = "-->" if controller.active else "-.->"
                start = _id("node", controller.full_name[1:])
                yield f'{start} {arrow} |"{label}"| {_id("device", controller.device)}'


def _drivers(cell: Cell) -> Iterator[str]:
    for device in cell.devices:
        if device.driver is not None:
            label = _text("moves", *driver_facts(cell, device, device.driver))
            yield f'{_id("node", device.driver.node[1:])} --> |"{label}"| {_id("device", device.name)}'


def _end(cell: Cell, end: Endpoint) -> str:
    # Full names, because managers may have controllers of one name; an adapter's device has no node in the graph.
    known = {node.full_name for node in cell.nodes} | {controller.full_name for controller in cell.controllers}
    return _id("node", end.full_name[1:]) if end.full_name in known else _id("device", end.node)


def _box(kind: str, name: str, *lines: str) -> str:
    return f'{_id(kind, name)}["{_text(name, *lines)}"]'


def _id(kind: str, name: str) -> str:
    return f"{kind}_" + re.sub(r"\W", "_", name)


def _text(*lines: str) -> str:
    return "<br/>".join(map(mermaid, lines))
