"""Rules on a cell that asks for the target ``sim``: what its simulator cannot run, and what it has to assume."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.graph.part_figures import LIGHT_KG, assumed, parts
from cellc.compiler.graph.simulated import is_asked, obstacles
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.robot.description.model import Link


@rule(Severity.ERROR)
def not_simulated(graph: CellGraph) -> Findings:
    """Yield what keeps the simulator from running the cell as it is."""
    if is_asked(graph.cell):
        yield from (found(graph, path, message) for path, message in obstacles(graph.cell))


@rule(Severity.AUDIT, assumes=("joint-of-unknown-link", "link-with-two-parents", "not-simulated"))
def assumed_in_simulation(graph: CellGraph) -> Findings:
    """Yield masses, shapes and frictions that nothing states, with what is in their place.

    A link with neither mass nor shape nor looks is a frame.
    """
    if not is_asked(graph.cell):
        return
    stated = parts(graph.cell, graph.frames)
    for frame in graph.cell.frames:
        if frame.name in stated and (missing := tuple(assumed(stated[frame.name]))):
            message = f"the simulator assumes of the part at `{frame.name}`: {'; '.join(missing)}"
            yield found(graph, (*frame.path, "grasp"), message)
    for device in graph.cell.devices:
        bodies = tuple(_moving_bodies(device))
        for who, assumption in (
            ([body for body in bodies if _is_seen(body) and not _weighs(body)], f"a mass of {LIGHT_KG:g} kg"),
            ([body for body in bodies if _weighs(body) and not _collides(body)], "no shape, so that nothing stops it,"),
        ):
            if who:
                names = ", ".join(f"`{body[0].name}`" for body in who)
                message = f"the simulator assumes {assumption} of what moves in `{device.name}`: {names}"
                yield found(graph, (*device.path, "model"), message)


def _weighs(body: tuple[Link, ...]) -> bool:
    return any(link.inertial is not None for link in body)


def _collides(body: tuple[Link, ...]) -> bool:
    return any(link.collisions for link in body)


def _is_seen(body: tuple[Link, ...]) -> bool:
    return any(link.visuals or link.collisions for link in body)


def _moving_bodies(device: Device) -> Iterator[tuple[Link, ...]]:
    """Yield what each joint moves as one: its link, and all that is fixed to it."""
    description = device.body.description
    links = {link.name: link for link in description.links}
    fixed: dict[str, list[str]] = {}
    for joint in description.joints:
        if not joint.movable:
            fixed.setdefault(joint.parent, []).append(joint.child)
    for joint in description.joints:
        names = [joint.child] if joint.movable else []
        for name in names:
            names += fixed.get(name, ())
        if body := tuple(links[name] for name in names if name in links):
            yield body
