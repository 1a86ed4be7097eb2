"""Lines of the gates about motion: the first one of a joint, what is released, who could move it, and cancels."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.site import FirstMotion
from cellc.compiler.deploy.bringup import bring_up, phases, releases
from cellc.compiler.deploy.first_goal import first_goal
from cellc.compiler.deploy.processes import past_controllers
from cellc.compiler.deploy.releases import GOAL, Release, release_once
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.vocabulary import BringUpPhase, Feature, InterfaceKind, features

Values = tuple[str, ...]


def first_motion(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motion as the spec has it."""
    if graph.cell.bringup.first_motion is not None:
        yield _first_motion(graph, graph.cell.bringup.first_motion)


def jogged(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motion of a robot whose driver reads on while a person moves it."""
    first = graph.cell.bringup.first_motion
    if first is not None and _moved(graph, first).jog is None:
        yield _first_motion(graph, first)


def guided(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motion of a robot whose driver cannot run meanwhile, with how its vendor has people move it."""
    first = graph.cell.bringup.first_motion
    jog = None if first is None else _moved(graph, first).jog
    if first is not None and jog is not None:
        yield *_first_motion(graph, first), jog


def _first_motion(graph: CellGraph, first: FirstMotion) -> Values:
    texts = (graph.cell.text("bringup", "first_motion", part) for part in ("max_delta", "velocity", "timeout"))
    figure = f"{shortest(round(first.max_delta.value, 4))} {'m' if first.max_delta.linear else 'rad'}"
    local = first.joint.partition("/")[2]
    name = next((joint.name for joint in _moved(graph, first).joints if joint.local_name == local), local)
    return first.joint, first.direction, *texts, name, figure


def _moved(graph: CellGraph, first: FirstMotion) -> Device:
    return graph.cell.device(first.joint.partition("/")[0])


def small_goal(graph: CellGraph) -> Iterator[Values]:
    """Yield the first motion with the commands that send it as a goal, and as one that is canceled half way."""
    first = graph.cell.bringup.first_motion
    if first is not None:
        command = release_once(graph.cell, GOAL) if first_goal(graph.cell) is not None else ""
        yield *_first_motion(graph, first), command, command and f"{command} then:=cancel"


def missing_first_motion(graph: CellGraph) -> Iterator[Values]:
    """Yield one empty row where no first motion is stated."""
    return iter(((),) if graph.cell.bringup.first_motion is None else ())


def stop_reasons(graph: CellGraph) -> Iterator[Values]:
    """Yield what ends the first motion."""
    first = graph.cell.bringup.first_motion
    return ((reason,) for reason in (() if first is None else first.stop_if))


def released(graph: CellGraph, release: Release, phase: BringUpPhase) -> Iterator[Values]:
    """Yield the command of a release, where the real target has a step in its phase: one for each of its devices."""
    plan = bring_up(graph.cell)
    if phase in phases(plan, "real"):
        for device in releases(plan, phase) or ("",):
            yield f"{device}: " if device else "", release_once(graph.cell, release, device)


def cancels(graph: CellGraph) -> Iterator[Values]:
    """Yield the actions that promise how soon a cancel holds."""
    for interface in graph.cell.interfaces:
        if "real" in interface.targets and interface.cancel_within_s is not None:
            yield interface.name, shortest(interface.cancel_within_s), f"{interface.name}/_action/cancel_goal"


def real_actions(graph: CellGraph) -> Iterator[Values]:
    """Yield the actions that somebody serves on the real target."""
    for interface in graph.cell.interfaces:
        if interface.kind is InterfaceKind.ACTION and "real" in interface.targets:
            yield (interface.name,)


def unguarded(graph: CellGraph) -> Iterator[Values]:
    """Yield driver interfaces outside the cell that move a device past every controller, and what a call does."""
    for device, offer, does in past_controllers(graph.cell):
        yield device.name, offer.name, offer.type, does, endpoint_command(graph.cell, offer.kind, offer.name)


def endpoint_command(cell: Cell, kind: InterfaceKind, name: str) -> str:
    """Return what shows who is at an interface; Humble tells no more of a service than its type."""
    if kind is InterfaceKind.TOPIC:
        return f"timeout 30 ros2 topic info -v {shell_word(name)}"
    if kind is InterfaceKind.ACTION:
        return f"timeout 30 ros2 action info {shell_word(name)}"
    verb = "info" if Feature.SERVICE_INFO in features(cell.distro) else "type"
    return f"timeout 30 ros2 service {verb} {shell_word(name)}"
