"""Links of devices, fixed frames and scene boxes as URDF elements."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.etree.ElementTree import Element

from cellc.cell.frame import SceneBox
from cellc.description.model import Box, Collision, Link, Visual
from cellc.formats.urdf.geometry import collision, inertial, numbers, visual
from cellc.formats.urdf.materials import Palette
from cellc.formats.xml_text import element
from cellc.transforms import identity

_SCENE_COLOURS = {"fixture": (0.7, 0.7, 0.7, 1.0), "obstacle": (0.8, 0.5, 0.4, 1.0)}


def frame_link(name: str) -> Element:
    """Return a link without a body: a frame alone."""
    return element("link", {"name": name})


def device_link(link: Link, palette: Palette) -> Element:
    """Return ``<link>`` with inertia and shapes."""
    body = [] if link.inertial is None else [inertial(link.inertial)]
    shapes = [*(visual(shape, palette.use(shape)) for shape in link.visuals), *map(collision, link.collisions)]
    return element("link", {"name": link.name}, [*body, *shapes])


def scene_link(box: SceneBox) -> Element:
    """Return the link of a solid thing; it has no inertia, because it does not move."""
    shape = Box(box.size)
    seen = Visual(name=None, pose=identity(), geometry=shape, material=None, rgba=None)
    solid = Collision(name=None, pose=identity(), geometry=shape)
    return element(
        "link",
        {"name": box.name},
        [visual(seen, [element("material", {"name": _material(box.kind)})]), collision(solid)],
    )


def scene_materials(boxes: Iterable[SceneBox]) -> Iterator[Element]:
    """Yield the material of each kind of box that the scene has."""
    for kind in dict.fromkeys(box.kind for box in boxes):
        colour = element("color", {"rgba": numbers(_SCENE_COLOURS[kind])})
        yield element("material", {"name": _material(kind)}, [colour])


def _material(kind: str) -> str:
    return f"scene_{kind}"
