"""Bodies within each other: masses, joints, shapes and frames of links, solid things, cameras and parts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.compiler.cell.device import CameraStream, Device
from cellc.compiler.formats.mjcf.elements import (
    Meshes,
    geom,
    geoms,
    inertial,
    is_possible,
    joint,
    light,
    placement,
    site,
)
from cellc.compiler.formats.mjcf.loops import Loops
from cellc.compiler.formats.mjcf.parts import part_elements
from cellc.compiler.formats.mjcf.tree import Body, Placed, weight_kg
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.xml_text import comment, element
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity

_FINGER = {"condim": "4"}
"""Fingers and parts resist a turn about the normal of their contact, too."""
_SCENE_COLORS = {"fixture": "0.7 0.7 0.7 1", "obstacle": "0.8 0.5 0.4 1"}
_HALF_TURN = Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
"""About x: MuJoCo's camera looks along -z with y up, an optical frame of REP 103 along z with y down."""


@dataclass(frozen=True, slots=True)
class Given:
    """What bodies are written with: who holds them, meshes by their names in the file, and the links of fingers."""

    loops: Loops
    meshes: Meshes
    fingers: frozenset[str]


def inside(given: Given, body: Body) -> Iterator[Element]:
    """Yield what a body carries: bodies and frames that are fixed in it, and then those that move or are mounted."""
    for placed in _others(body):
        if has_body(placed):
            attributes = {"name": placed.name, **placement(placed.pose), **_held(given, placed)}
            yield element("body", attributes, _content(given, placed, identity()))
        else:
            yield from _frame(placed, placed.pose)
    for other in body.bodies:
        if other.device is not None and other.name == other.device.body.root_link:
            yield comment(f"devices.{other.device.name}: {other.device.model}")
        attributes = {"name": other.name, **placement(other.pose), **_held(given, other.placed[0])}
        yield element("body", attributes, _moved(given, other))


def _others(body: Body) -> Iterator[Placed]:
    yield from (placed for placed in body.placed if placed.name != body.name)


def has_body(placed: Placed) -> bool:
    """Tell whether something that is fixed in a body has a mass or a shape, so that it is a body of its own."""
    link = placed.link
    return placed.solid is not None or (link is not None and (link.inertial is not None or bool(link.collisions)))


def welds(world: Body) -> dict[str, str]:
    """Map every body of the file to the one that a joint moves and that carries it, or to the world.

    MuJoCo looks for no contact between two that are carried by the same one, as no joint moves between them.
    https://mujoco.readthedocs.io/en/3.3.7/computation/index.html#selection
    """
    found: dict[str, str] = {}
    for body in world.all():
        weld = found.setdefault(body.name, body.name)
        found |= {placed.name: weld for placed in _others(body) if has_body(placed)}
        found |= {other.name: weld for other in body.bodies if other.joint is None and other.part is None}
    return found


def fingers(device: Device) -> Iterator[str]:
    """Yield the links that move with the joint of a gripper."""
    if device.gripper is None:
        return
    joints = device.body.description.with_direct_mimics().joints
    leader, moving = device.gripper.joint, set[str]()
    for each in joints:
        if each.name == leader or (each.mimic is not None and each.mimic.joint == leader):
            moving.add(each.child)
    while more := {each.child for each in joints if each.parent in moving} - moving:
        moving |= more
    yield from moving


def _held(given: Given, placed: Placed) -> dict[str, str]:
    share = given.loops.compensated(placed.device)
    weighs = placed.link is not None and placed.link.inertial is not None
    return {"gravcomp": shortest(share)} if share and weighs else {}


def _moved(given: Given, body: Body) -> Iterator[Element]:
    """Yield what is in a body that is mounted, moved by a joint, or free."""
    if body.part is not None:
        yield from part_elements(body.part)
    if body.joint is not None:
        yield joint(body.joint, body.limits, _of_joint(given, body))
        if weight_kg(body) <= 0.0:
            yield comment("no mass is stated, and what moves has one")
            yield light()
    yield from _content(given, body.placed[0], identity())
    yield from inside(given, body)


def _of_joint(given: Given, body: Body) -> dict[str, str]:
    assert body.joint is not None
    found: dict[str, str] = {}
    if body.device is not None:
        damping = given.loops.finger_damping(body.device, body.joint.name)
        armature = given.loops.finger_armature(body.device, body.joint.name)
        found |= {} if damping is None else {"damping": shortest(damping)}
        found |= {} if armature is None else {"armature": shortest(armature)}
        found |= given.loops.driven(body.device, body.joint.name)
        if given.loops.compensated(body.device) and body.limits is not None and body.limits.effort:
            found["actuatorgravcomp"] = "true"
    return found


def _content(given: Given, placed: Placed, pose: Pose) -> Iterator[Element]:
    """Yield masses and shapes of a link or a thing, and its frame."""
    link, solid = placed.link, placed.solid
    if link is not None and link.inertial is not None:
        if not is_possible(link.inertial):
            yield comment("no body has this mass and tensor: a small ball in its place")
        yield inertial(link.inertial)
    if link is not None:
        yield from geoms(link, given.meshes, _FINGER if link.name in given.fingers else {})
    if solid is not None:
        yield geom(solid.geometry, solid.center, given.meshes, {"rgba": _SCENE_COLORS[solid.kind]})
    yield from _frame(placed, pose)


def _frame(placed: Placed, pose: Pose) -> Iterator[Element]:
    yield site(placed.name, pose)
    stream = None if placed.device is None else _stream(placed.device, placed.name)
    if stream is not None and stream.view is not None:
        attributes = {"name": placed.name, "fovy": shortest(round(math.degrees(stream.view.vertical), 9))}
        size = {} if stream.pixels is None else {"resolution": f"{stream.pixels[0]} {stream.pixels[1]}"}
        yield element("camera", attributes | size | placement(pose @ _HALF_TURN))


def _stream(device: Device, frame: str) -> CameraStream | None:
    """Return the first stream of a camera with a view in a frame."""
    streams = () if device.sensing.camera is None else device.sensing.camera.streams
    return next((stream for stream in streams if stream.frame == frame and stream.view is not None), None)
