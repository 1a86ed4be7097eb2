"""Where descriptions have the joints that a finding speaks of: the second place to look at."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Related


def is_own(graph: CellGraph, device: Device) -> bool:
    """Tell whether the user brings the description: a folder beside the spec, or the file that is checked alone."""
    model = graph.cell.text(*device.path, "model")
    return not model or "/" in model


def in_its_file(device: Device, *path: str | int) -> tuple[Related, ...]:
    """Return the place of a fact in the `device.yaml` that the user brings; none of one of the catalog."""
    places = device.body.places
    return () if places is None or not places.has(path) else (Related("its `device.yaml` has it", places.locate(path)),)


def described(graph: CellGraph, joints: Iterable[str]) -> tuple[Related, ...]:
    """Return the places of joints in the folders of the cell; a catalog entry is not changed for one cell."""
    places = graph.once(_places)
    return tuple(places[name] for name in joints if name in places)


def _places(graph: CellGraph) -> Mapping[str, Related]:
    return {
        part.joint.name: Related(f"joint `{part.joint.name}` is described here", part.joint.span)
        for part in graph.model.joints()
        if part.joint.span is not None and "/" in graph.cell.text(*part.path)
    }
