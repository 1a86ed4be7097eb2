"""What cells of a plant have in common without saying so: domains, packages, robots, distributions, room to move."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

from cellc.compiler.feasibility.answers import MARGIN_M
from cellc.compiler.feasibility.reach import Ball, Block, resting_shapes, swept_balls
from cellc.compiler.output.findings import shared_output
from cellc.compiler.plant.crossings import check_crossings
from cellc.compiler.plant.findings import finding
from cellc.compiler.plant.link import Check, LinkedPlant, link_plant
from cellc.compiler.plant.plant import Part, Plant, PlantArea
from cellc.compiler.rules.shared_domain import Presence, presence_of
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Related
from cellc.contract.transforms import Pose, Vector3
from cellc.contract.vocabulary import UNKNOWN

_ALONE = ("localhost", "off")


def check_plant(document: SourceDocument, check: Check) -> LinkedPlant:
    """Check a plant and its cells; where one of these has errors, they are all that is found.

    What else is found in a cell is found by the check of that cell too, and its owners answer it.

    Args:
        check: reads, links and checks one cell.
    """
    linked = link_plant(document, check)
    if linked.plant is None:
        return linked
    found = dict.fromkeys((*check_crossings(linked.plant), *check_together(linked.plant)))
    return replace(linked, diagnostics=(*linked.diagnostics, *found))


def check_together(plant: Plant) -> Iterator[Diagnostic]:
    """Yield what two cells of the plant may not have in common, or must have."""
    for one, other in plant.pairs():
        yield from _names(one, other)
        yield from _robots(one, other)
        yield from _meeting(plant, one, other)
        yield from _in_reach(one, other)
        yield from _in_reach(other, one)
    yield from _graphs(plant)
    yield from _unheard(plant)


def _names(one: Part, other: Part) -> Iterator[Diagnostic]:
    """Yield a package that two cells would write, and a domain in which their names would meet."""
    related = (Related(f"cell `{one.key}`", one.span),)
    if one.cell.name == other.cell.name:
        same = shared_output(one.cell.name, other.cell.locate("cell"), one.cell.locate("cell"))
        where = "are one spec" if same is None else f"are both called `{one.cell.name}`"
        message = f"`{one.key}` and `{other.key}` {where}, and would be one package in one domain"
        yield finding("output-shared", message, other.span, other.path, "give each cell a spec of its own", related)
    elif one.domain == other.domain:
        message = f"`{one.key}` and `{other.key}` have domain {one.domain}: in it, names of one meet those of the other"
        advice = "give each cell of the plant a `network.domain_id` of its own, from 0 to 101"
        yield finding("shared-domain-id", message, other.span, other.path, advice, related)


def _robots(one: Part, other: Part) -> Iterator[Diagnostic]:
    """Yield a device that both cells claim, by model and serial number."""
    if one.cell.name == other.cell.name:
        return
    serials = {
        (device.model, device.software.versions.serial): device
        for device in one.cell.devices
        if device.software.versions.serial != UNKNOWN
    }
    for device in other.cell.devices:
        first = serials.get((device.model, device.software.versions.serial))
        if first is not None:
            message = f"`{other.key}/{device.name}` and `{one.key}/{first.name}` are one device: serial "
            message += f"number `{device.software.versions.serial}`"
            related = (Related("claimed here", first.span), Related("and here", device.span))
            yield finding("duplicate-serial", message, other.span, other.path, "read it from each device", related)


def _graphs(plant: Plant) -> Iterator[Diagnostic]:
    """Yield cells on another distribution or middleware than the first: one bridge is one process."""
    first = plant.first
    for part in plant.parts.values():
        for name, was, now in (
            ("distribution", first.cell.distro.value, part.cell.distro.value),
            ("middleware", first.cell.versions.rmw_name, part.cell.versions.rmw_name),
        ):
            if was != now and UNKNOWN not in (was, now):
                message = f"`{part.key}` has {name} `{now}`, `{first.key}` has `{was}`"
                related = (Related(f"cell `{first.key}`", first.cell.locate("versions")),)
                advice = "let all cells of the plant have one distribution and one middleware"
                yield finding("mixed-distributions", message, part.span, part.path, advice, related)


def _unheard(plant: Plant) -> Iterator[Diagnostic]:
    """Yield cells whose graph does not leave their computer, and that the other end of a bridge is not on."""
    known: set[str] = set()
    for crossings in plant.bridges().values():
        ends = (crossings[0].source, crossings[0].receiver)
        here, there = (presence_of(part.graph) for part in ends)
        for part in ends:
            discovery = part.cell.network.discovery
            if part.key in known or discovery not in _ALONE or (discovery != "off" and _on_one_computer(here, there)):
                continue
            known.add(part.key)
            message = f"`{part.key}` has discovery `{discovery}`: no bridge on another computer hears it"
            related = (Related("crosses here", crossings[0].span),)
            advice = "let it use `unicast`, with the computer of the bridge among its `peers`"
            path = ("network", "discovery")
            yield finding("localhost-with-several-hosts", message, part.cell.locate(*path), part.path, advice, related)


def _on_one_computer(here: Presence, there: Presence) -> bool:
    addresses = [{card.partition("/")[0] for card in each.cards} for each in (here, there)]
    return bool(addresses[0] & addresses[1])


def _meeting(plant: Plant, one: Part, other: Part) -> Iterator[Diagnostic]:
    """Yield that moving devices of two cells may meet where no area of the plant says who is let in."""
    open_pairs = [
        (first, second, box)
        for first, ball in _balls(one)
        for second, far in _balls(other)
        if (box := _common(ball, far)) is not None and not any(_holds(area, box) for area in plant.areas)
    ]
    if not open_pairs:
        return
    first, second, box = open_pairs[0]
    more = f", and {len(open_pairs) - 1} more pairs" if len(open_pairs) > 1 else ""
    message = f"`{one.key}/{first}` and `{other.key}/{second}` may meet{more}: {_shown(box)}"
    related = (Related(f"cell `{one.key}`", one.span),)
    advice = "mount the cells farther apart, or write an area under `areas:` that holds this, with who lets one in"
    yield finding("parts-may-meet", message, other.span, other.path, advice, related)


_Box = tuple[Vector3, Vector3]


def _balls(part: Part) -> tuple[tuple[str, Ball], ...]:
    """Return the balls that the moving devices of a cell never leave, in the world of the plant."""
    return tuple((name, Ball(part.pose.apply(ball.center), ball.radius)) for name, ball in part.graph.once(swept_balls))


def _in_reach(one: Part, other: Part) -> Iterator[Diagnostic]:
    """Yield what is at rest in a cell, in reach of devices of another one whose own spec does not have it."""
    there = one.pose.inverse() @ other.pose
    own = one.graph.once(resting_shapes)
    back = there.inverse()
    balls = [(name, Ball(back.apply(ball.center), ball.radius)) for name, ball in one.graph.once(swept_balls)]
    met = [
        (name, shape)
        for shape in other.graph.once(resting_shapes)
        for name in [next((name for name, ball in balls if shape.is_near(ball, MARGIN_M)), None)]
        if name is not None and not any(_covers(mine, shape, there) for mine in own)
    ]
    if met:
        name, shape = met[0]
        more = f", and {len(met) - 1} more" if len(met) > 1 else ""
        message = f"`{one.key}/{name}` may reach `{other.key}/{shape.link}`{more}, which `{one.key}` does not know"
        frame = other.graph.frames.get(shape.link)
        related = () if frame is None else (Related(f"in `{other.key}`", frame.span),)
        advice = f"write it under `scene:` of `{one.file}` too, or mount the cells farther apart"
        yield finding("shape-of-another-part", message, one.span, one.path, advice, related)


def _covers(mine: Block, shape: Block, there: Pose) -> bool:
    """Tell whether a shape of a cell holds one of another cell, to a millimeter."""
    corners = product(*((-half, half) for half in shape.half))
    return all(mine.is_near(Ball((there @ shape.pose).apply((x, y, z)), 0.0), 1e-3) for x, y, z in corners)


def _common(one: Ball, other: Ball) -> _Box | None:
    """Return the lower and upper corner of a box round what two balls have in common; None where that is nothing."""
    distance = math.dist(one.center, other.center)
    if distance > one.radius + other.radius:
        return None
    balls = [one, other]
    if math.isfinite(one.radius + other.radius) and distance > 0.0:
        along = (distance**2 + one.radius**2 - other.radius**2) / (2.0 * distance)
        if 0.0 <= along <= distance:  # between the centers lies the circle in which both surfaces meet
            share = along / distance
            center = tuple(a + share * (b - a) for a, b in zip(one.center, other.center, strict=True))
            balls.append(Ball((center[0], center[1], center[2]), math.sqrt(max(0.0, one.radius**2 - along**2))))
    lower = tuple(max(ball.center[axis] - ball.radius for ball in balls) for axis in range(3))
    upper = tuple(min(ball.center[axis] + ball.radius for ball in balls) for axis in range(3))
    return (lower[0], lower[1], lower[2]), (upper[0], upper[1], upper[2])


def _holds(area: PlantArea, box: _Box) -> bool:
    if not all(math.isfinite(end) for corner in box for end in corner):
        return False
    corners = ((x, y, z) for x, y, z in product(*zip(*box, strict=True)))
    places = (area.pose.inverse().apply(corner) for corner in corners)
    return all(abs(way) <= edge / 2.0 + 1e-9 for place in places for way, edge in zip(place, area.size, strict=True))


def _shown(box: _Box) -> str:
    lower, upper = box
    if not all(math.isfinite(end) for corner in box for end in corner):
        return "the reach of one of them has no bound"
    # Outward to whole centimeters, so that an area with these figures holds it.
    low, high = ([way(end * 100.0) for end in corner] for way, corner in ((math.floor, lower), (math.ceil, upper)))
    center = " ".join(f"{(a + b) / 200.0:g}" for a, b in zip(low, high, strict=True))
    edges = " ".join(f"{(b - a) / 100.0:g}" for a, b in zip(low, high, strict=True))
    return f"in `{{parent: world, xyz: {center} m, box: {edges} m}}`"
