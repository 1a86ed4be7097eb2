"""Keyframes: where the cell begins, and each named pose; joints that a pose does not name are where the cell begins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.formats.mjcf.elements import numbers
from cellc.compiler.formats.mjcf.loops import Actuator
from cellc.compiler.formats.mjcf.tree import Body
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.urdf.robot import first_keyframe, start_positions
from cellc.compiler.formats.xml_text import element


def keys(cell: Cell, world: Body, actuators: Sequence[Actuator]) -> Iterator[Element]:
    """Yield a keyframe for each posture, the first where the cell begins."""
    start = start_positions(cell)
    named = {pose.name: dict[str, float]() for pose in cell.poses}
    for pose in cell.poses:
        named[pose.name] |= dict(zip(pose.joints, pose.positions, strict=False))
    first = first_keyframe(cell)
    for name in dict.fromkeys((first, *named)):
        positions = start | ({} if name == first else named[name])
        yield element(
            "key",
            {
                "name": name,
                "qpos": numbers(_configuration(world, positions)),
                "ctrl": numbers(positions.get(actuator.joint.name, 0.0) for actuator in actuators),
            },
        )


def _configuration(world: Body, positions: Mapping[str, float]) -> Iterator[float]:
    """Yield the positions of all joints in the order of the file; of a free body its pose in the world, w first."""
    for body in world.all():
        if body.part is not None:
            x, y, z, w = body.part.pose.quaternion
            yield from map(rounded, (*body.part.pose.position, w, x, y, z))
        elif body.joint is not None:
            mimic = body.joint.mimic
            if mimic is None:
                yield positions.get(body.joint.name, 0.0)
            else:
                yield rounded(mimic.multiplier * positions.get(mimic.joint, 0.0) + mimic.offset)
