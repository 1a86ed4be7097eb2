"""Materials of a device under names of their own, each defined once at the top of the robot.

urdfdom keeps one colour for a name in the whole robot: without the device's name before it, the gripper would show the
arm's "dark".
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.cell.device import Device
from cellc.description.model import Visual
from cellc.formats.urdf.geometry import numbers
from cellc.formats.xml_text import element

Colour = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Palette:
    """Name in the robot of each material and colour of one device."""

    names: Mapping[tuple[str, Colour], str]

    def definitions(self) -> Iterator[Element]:
        """Yield each material with its colour."""
        for (_, colour), name in self.names.items():
            yield element("material", {"name": name}, [element("color", {"rgba": numbers(colour)})])

    def use(self, visual: Visual) -> tuple[Element, ...]:
        """Return the reference of a shape to its material, or nothing for a shape without colour."""
        if visual.rgba is None:
            return ()
        return (element("material", {"name": self.names[_key(visual, visual.rgba)]}),)


def palette_of(device: Device) -> Palette:
    """Collect the materials of a device, in the order of first use."""
    names: dict[tuple[str, Colour], str] = {}
    for visual in (visual for link in device.description.links for visual in link.visuals):
        if visual.rgba is not None:
            names.setdefault(_key(visual, visual.rgba), "")
    prefix = device.prefix or f"{device.name}_"
    taken: dict[str, int] = {}
    for material, colour in names:
        taken[material] = taken.get(material, 0) + 1
        again = "" if taken[material] == 1 else f"_{taken[material]}"
        names[material, colour] = f"{prefix}{material}{again}"
    return Palette(names)


def _key(visual: Visual, colour: Colour) -> tuple[str, Colour]:
    return (visual.material or "colour", colour)
