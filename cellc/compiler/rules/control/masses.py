"""Bounds of masses: what arms carry, and tensors against the mass and the size of what has them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.bounds import Bound, Figure, outside
from cellc.compiler.rules.carried import farthest_link
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, rule

_PART_M = 0.5
"""How far from the tool frame what a tool holds reaches, where nothing tells more."""
_LEAST_M = 2e-3
"""No body that is weighed is smaller about an axis."""


def _payloads(graph: CellGraph) -> Iterator[tuple[Device, YamlPath, float, tuple[float, ...] | None]]:
    """Yield each payload and load: its device, its place, its mass in kg and its tensor."""
    for device in graph.cell.devices:
        payload = device.robot.payload
        if payload is not None:
            yield device, (*device.path, "payload"), payload.mass_kg, payload.inertia
            if payload.load is not None:
                yield device, (*device.path, "payload", "load"), payload.load.mass_kg, payload.load.inertia


def _gyrations(graph: CellGraph) -> Iterator[Figure]:
    """Yield the least and the largest radius of gyration of each tensor."""
    for device, path, mass_kg, tensor in _payloads(graph):
        if tensor is not None and mass_kg > 0.0 and min(tensor[:3]) >= 0.0:
            related = (Related("with this mass", graph.cell.locate(*path, "mass")),)
            most = _PART_M + _reach(graph, device)
            for moment in (min(tensor[:3]), max(tensor[:3])):
                yield Figure((*path, "inertia"), math.sqrt(moment / mass_kg), _LEAST_M, most, related=related)


def _reach(graph: CellGraph, arm: Device) -> float:
    """Return how far the farthest link of what an arm carries is from its tool frame, m; 0 where it is not known."""
    place = farthest_link(graph, arm)
    return 0.0 if place is None else math.hypot(*place)


def _weights(graph: CellGraph) -> Iterator[Figure]:
    for _, path, mass_kg, _ in _payloads(graph):
        yield Figure((*path, "mass"), mass_kg, 1e-3)


def _parts(graph: CellGraph) -> Iterator[Figure]:
    """Yield what tools hold, which the payloads and the arms of the cell bound."""
    strongest = max((device.limits.payload_limit_kg or 0.0 for device in graph.cell.devices), default=0.0)
    for device in graph.cell.devices:
        payload = device.robot.payload
        if payload is not None and payload.part_kg is not None:
            path = (*device.path, "payload")
            related = (Related("the payload with it", graph.cell.locate(*path, "mass")),)
            yield Figure((*path, "part"), payload.part_kg, 1e-4, payload.mass_kg, related=related)
    for frame in graph.cell.frames:
        if frame.grasp is not None and frame.grasp.mass_kg is not None:
            yield Figure((*frame.path, "grasp", "mass"), frame.grasp.mass_kg, 1e-4, strongest or math.inf)


def _deviations(graph: CellGraph) -> Iterator[Figure]:
    """Yield how much the masses of parts vary, which their payload bounds."""
    uncertainty = graph.cell.uncertainty
    if uncertainty is None:
        return
    for name, deviation_kg in uncertainty.parts_kg.items():
        payload = graph.cell.device(name).robot.payload
        most = math.inf if payload is None else payload.mass_kg
        yield Figure(("uncertainty", "loads", name, "part"), deviation_kg, 1e-5, most)
    for name, deviation_kg in uncertainty.payloads_kg.items():
        payload = graph.cell.device(name).robot.payload
        most = math.inf if payload is None else payload.mass_kg
        yield Figure(("uncertainty", "loads", name, "payload"), deviation_kg, 1e-5, most)
    parts = {frame.name: frame.grasp.mass_kg for frame in graph.cell.frames if frame.grasp is not None}
    for name, deviation_kg in uncertainty.masses_kg.items():
        yield Figure(("uncertainty", "parts", name, "mass"), deviation_kg, 1e-5, parts.get(name) or math.inf)


def _centers(graph: CellGraph) -> Iterator[Figure]:
    for device in graph.cell.devices:
        payload = device.robot.payload
        if payload is None:
            continue
        most = _PART_M + _reach(graph, device)
        path = (*device.path, "payload")
        yield Figure((*path, "center_of_mass"), math.hypot(*payload.center_of_mass), most=most)
        if payload.load is not None:
            center = math.hypot(*payload.load.center_of_mass)
            yield Figure((*path, "load", "center_of_mass"), center, 1e-3, most)


BOUNDS = (
    Bound(
        ("devices.*.payload.inertia", "devices.*.payload.load.inertia"),
        "the radius of gyration",
        "mm",
        "which is within the body",
        _gyrations,
    ),
    Bound(("devices.*.payload.mass", "devices.*.payload.load.mass"), "`mass`", "g", "of what is weighed", _weights),
    Bound(
        ("devices.*.payload.part", "frames.*.grasp.mass"), "the mass of the part", "kg", "what the arm carries", _parts
    ),
    Bound(
        ("uncertainty.loads.*.part", "uncertainty.loads.*.payload", "uncertainty.parts.*.mass"),
        "the deviation of the mass",
        "kg",
        "below the mass itself",
        _deviations,
    ),
    Bound(
        ("devices.*.payload.center_of_mass", "devices.*.payload.load.center_of_mass"),
        "the distance of the center from the tool frame",
        "mm",
        "where a tool holds it",
        _centers,
    ),
)


@rule(Severity.WARNING, assumes=("impossible-inertia", "frame-cycle"), gives_way=True)
def implausible_mass(graph: CellGraph) -> Findings:
    """Yield masses and tensors that what is carried cannot have."""
    yield from outside(graph, BOUNDS)
