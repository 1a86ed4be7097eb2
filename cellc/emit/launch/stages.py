"""The stages of bring-up as actions of a launch file: discover, configure, observe, claim.

The processes of the first stage are started at once and prove nothing by that. Every step after it waits for what it
needs (see ``bring_up.py``); the last one claims, and none enables a drive or asks for motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.cell.cell import Cell
from cellc.cell.interface import Node, NodeSource
from cellc.deploy.bringup import Step, steps
from cellc.deploy.processes import host_of, host_of_manager, started_by_a_person
from cellc.emit.launch.bring_up import FILE
from cellc.emit.launch.control import control, spawners
from cellc.emit.launch.nodes import cell_node, driver_node, robot_state_publisher
from cellc.emit.launch.substitutions import only_on, share
from cellc.formats.parameter_file import spec_path
from cellc.formats.xml_text import comment, element
from cellc.link.frames import ROBOT_STATE_PUBLISHER

_ABOUT = {
    "configure": "every controller is loaded and configured, none is active; managed nodes likewise",
    "observe": "states are published and looked at; nothing is claimed",
    "claim": "command interfaces get their owners, after states, transforms and lifecycle states have shown",
}


def stages(cell: Cell, host: str | None) -> Iterator[Element]:
    """Yield the actions of one host, or of all of them."""
    yield comment("discover: processes come up in any order; what follows waits for proof, not for them")
    yield from _discover(cell, host)
    for stage, about in _ABOUT.items():
        actions = [*(_spawners(cell, host) if stage == "configure" else ()), *_steps(cell, host, stage)]
        if actions:
            yield comment(f"{stage}: {about}")
            yield from actions
    yield comment("enable and move are steps of people: gates/promotion.md, G5 to G7")


def _discover(cell: Cell, host: str | None) -> Iterator[Element]:
    for node in cell.nodes:
        if (
            node.source is NodeSource.STANDARD
            and node.name == ROBOT_STATE_PUBLISHER
            and _here(host, host_of(cell, node))
        ):
            yield robot_state_publisher(cell, node)
    for manager in cell.managers:
        if _here(host, host_of_manager(cell, manager)):
            yield comment(spec_path(manager.path))
            yield from control(cell, manager)
    for node in cell.nodes:
        if _here(host, host_of(cell, node)):
            yield from _node(cell, node)


def _node(cell: Cell, node: Node) -> Iterator[Element]:
    if node.source is NodeSource.SPEC and not started_by_a_person(cell, node):
        yield comment(spec_path(node.path))
        yield cell_node(cell, node)
    elif node.source is NodeSource.DEVICE:
        yield comment(f"driver of {spec_path(node.path)}")
        yield driver_node(cell, node)


def _spawners(cell: Cell, host: str | None) -> Iterator[Element]:
    for manager in cell.managers:
        if _here(host, host_of_manager(cell, manager)):
            yield from spawners(cell, manager)


def _steps(cell: Cell, host: str | None, stage: str) -> Iterator[Element]:
    return (_step(cell, one) for one in steps(cell) if one.stage == stage and _here(host, one.host))


def _step(cell: Cell, step: Step) -> Element:
    command = f"bash {share(cell, FILE)} {step.name}"
    return element("executable", {"name": step.name, "cmd": command, "output": "both", **only_on(step.only)})


def _here(host: str | None, of: str) -> bool:
    return host is None or host == of
