"""``launch/*.launch.xml``: starts the cell on the mock, or on real hardware up to where a human takes over.

Launch XML for ``ros2 launch``, Humble to Lyrical: only actions and substitutions that all of them know.
``cell.launch.xml`` discovers, configures, observes and claims; it enables no drive and starts nothing that asks for
motion, on any target. With several hosts it includes the file of the one that it is told; ``move.launch.xml`` starts
what sends goals. The real target passes a gate in each: a file whose argument has no default and one choice. Left out:
enabling, which is a step of the vendor's procedure.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.deploy.processes import launch_hosts, movers, started_by_a_person
from cellc.emit.launch.arguments import (
    CONFIRM_MOTION,
    CONFIRM_REAL,
    address_arguments,
    addresses,
    gate_argument,
    host_argument,
    release_argument,
    stated_host_argument,
    target_argument,
)
from cellc.emit.launch.bring_up import bring_up
from cellc.emit.launch.nodes import moving_node
from cellc.emit.launch.stages import stages
from cellc.emit.launch.substitutions import HOST, ON_REAL, TARGET, on_host, share
from cellc.formats.header import Header
from cellc.formats.parameter_file import spec_path
from cellc.formats.xml_text import comment, element, render
from cellc.graph.cell_graph import CellGraph

_VERSION = {"version": "0.1.1"}
_CELL = "launch/cell.launch.xml"
_REAL_GATE = "launch/real_gate.launch.xml"
_MOVE = "launch/move.launch.xml"
_MOVE_GATE = "launch/move_gate.launch.xml"


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the launch files, the gates before their real targets, and what their steps wait for."""
    cell = graph.cell
    hosts = launch_hosts(cell)
    yield _file(header, _CELL, _by_host(cell, hosts) if hosts else _whole(cell))
    for host in hosts:
        yield _file(header, _host_file(host), [*_arguments(cell), *_gate(cell, {"host": host}), *stages(cell, host)])
    demanded = [stated_host_argument(hosts)] if hosts else []
    yield _file(header, _REAL_GATE, [gate_argument(CONFIRM_REAL), *demanded])
    yield bring_up(cell, header)
    if movers(cell):
        yield _file(header, _MOVE, _moving(cell))
        yield _file(header, _MOVE_GATE, [gate_argument(CONFIRM_MOTION)])


def _file(header: Header, path: str, actions: Iterator[Element] | list[Element]) -> Artifact:
    return Artifact(path, render(element("launch", _VERSION, actions), header.text))


def _host_file(host: str) -> str:
    return f"launch/{host}.launch.xml"


def _arguments(cell: Cell) -> Iterator[Element]:
    yield target_argument()
    yield release_argument(CONFIRM_REAL)
    yield from address_arguments(cell)


def _gate(cell: Cell, more: dict[str, str]) -> Iterator[Element]:
    yield comment("the gate before real hardware: unless a person opens it nothing below is started")
    yield _include(cell, _REAL_GATE, {CONFIRM_REAL: f"$(var {CONFIRM_REAL})"} | more, {"if": ON_REAL})


def _whole(cell: Cell) -> Iterator[Element]:
    yield from _arguments(cell)
    yield from _gate(cell, {})
    yield from stages(cell, None)


def _by_host(cell: Cell, hosts: tuple[str, ...]) -> Iterator[Element]:
    yield from _arguments(cell)
    yield host_argument(hosts)
    yield from _gate(cell, {"host": HOST})
    yield comment("what each computer starts; the steps of one wait for what shows from the others")
    passed = {name: f"$(var {name})" for name in ("target", CONFIRM_REAL, *addresses(cell))}
    for host in hosts:
        yield _include(cell, _host_file(host), passed, {"if": on_host(host)})


def _include(cell: Cell, path: str, arguments: dict[str, str], condition: dict[str, str]) -> Element:
    # An include is refused for an argument without a default that it is not given itself, whatever its parent has.
    given = [element("arg", {"name": name, "value": value}) for name, value in arguments.items()]
    return element("include", {"file": share(cell, path), **condition}, given)


def _moving(cell: Cell) -> Iterator[Element]:
    hosts = launch_hosts(cell)
    yield target_argument()
    yield release_argument(CONFIRM_MOTION)
    if hosts:
        yield host_argument(hosts)
    yield comment("the gate before motion on real hardware: unless a person opens it nothing below is started")
    yield _include(cell, _MOVE_GATE, {CONFIRM_MOTION: f"$(var {CONFIRM_MOTION})"}, {"if": ON_REAL})
    yield comment("what asks for motion; each waits for claims, actions and states, on the mock for the mock itself")
    for node in movers(cell):
        if started_by_a_person(cell, node):
            yield comment(spec_path(node.path))
            yield moving_node(cell, node, f"bash {share(cell, 'launch/bring_up.bash')} move_{TARGET}")
