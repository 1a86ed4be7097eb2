"""The whole ``<mujoco>``: the world with its bodies, what moves them, what is measured, and postures.

One tree of the same frames as the description: a site for each, with its name.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.formats.mjcf.bodies import Given, fingers, inside, welds
from cellc.compiler.formats.mjcf.elements import Meshes, numbers
from cellc.compiler.formats.mjcf.keyframes import keys
from cellc.compiler.formats.mjcf.loops import LOOP_RAD_S, Actuator, Loops, driven_joints, unknown_laws
from cellc.compiler.formats.mjcf.parts import defaults_of
from cellc.compiler.formats.mjcf.tree import Body, body_tree, sensed_link
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.xml_text import comment, element
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import force_sensors
from cellc.robot.description.model import Mesh

_RULES = {
    "angle": "radian",
    "autolimits": "true",
    "inertiafromgeom": "false",
    "balanceinertia": "true",  # a tensor that breaks the triangle inequality is refused otherwise
}
_STEP = {"timestep": "0.001", "integrator": "implicitfast", "cone": "elliptic", "impratio": "10"}
_READ = (".stl", ".obj")
"""Meshes that MuJoCo reads."""
_EQUAL = {"solref": "0.004 1", "solimp": "0.9999 0.9999 0.001"}
"""Fingers that follow another do so within two milliseconds."""
_USUAL_BUFFER = (640, 480)
_TOO_DEEP = "left out: bodies carry each other deeper than parsers of XML read"


def scene(graph: CellGraph, pairs: Sequence[tuple[str, str]], unusable: Mapping[str, str]) -> Element:
    """Return the scene of a cell; nothing is in it where bodies carry each other deeper than parsers read.

    Args:
        pairs: links whose contact is not looked for.
        unusable: meshes that cannot be used by their names, each with the reason.
    """
    world = body_tree(graph.cell, graph.frames)
    if world is None:
        return element("mujoco", {"model": graph.cell.name}, [comment(_TOO_DEEP)])
    soft = frozenset(link for device in graph.cell.devices for link in fingers(device))
    given = Given(Loops(graph.cell, world), _meshes(world, unusable), soft)
    return element("mujoco", {"model": graph.cell.name}, _sections(graph.cell, world, given, pairs))


def _sections(cell: Cell, world: Body, given: Given, pairs: Sequence[tuple[str, str]]) -> Iterator[Element]:
    actuators = [actuator for device in cell.devices for actuator in given.loops.actuators(device)]
    yield from map(comment, _defaults(cell.devices, world, given, actuators))
    yield element("compiler", _RULES)
    yield element("option", _STEP)
    yield from _filled("visual", _buffer(cell.devices))
    yield from _filled("asset", _assets(given.meshes))
    yield element("worldbody", children=inside(given, world))
    yield from _filled("contact", _without_contact(pairs, welds(world)))
    yield from _filled("equality", _followers(world))
    yield from _filled("actuator", (element("position", actuator.attributes()) for actuator in actuators))
    yield from _filled("sensor", _sensors(cell))
    yield element("keyframe", children=keys(cell, world, actuators))


def _without_contact(pairs: Iterable[tuple[str, str]], welds: Mapping[str, str]) -> Iterator[Element]:
    """Yield pairs of bodies of the file between which a joint moves, and which may touch all the same."""
    for one, two in pairs:
        if one in welds and two in welds and welds[one] != welds[two]:
            yield element("exclude", {"body1": one, "body2": two})


def _filled(tag: str, children: Iterable[Element]) -> Iterator[Element]:
    section = element(tag, children=children)
    if len(section):
        yield section


def _defaults(devices: Sequence[Device], world: Body, given: Given, actuators: Sequence[Actuator]) -> Iterator[str]:
    """Yield a line for each kind of figure that is not stated."""
    yield "not stated: friction of contacts, so that of MuJoCo, 1"
    bare = dict.fromkeys(device.name for device in devices if device.control.drives is None and driven_joints(device))
    if bare:
        yield f"not stated: armature and friction of drives, so 0: {', '.join(bare)}"
    loops = [actuator.joint.name for actuator in actuators if actuator.assumed and not actuator.grips]
    if loops:
        yield f"not stated: stiffness of position loops, so {shortest(LOOP_RAD_S)} rad/s: {', '.join(loops)}"
    grips = [actuator.joint.name for actuator in actuators if actuator.grips]
    if grips:
        pressed = "so that they press with the force of the gripper and are as fast as other loops"
        yield f"not stated: stiffness and armature of fingers, {pressed}: {', '.join(grips)}"
    for name, because in unknown_laws(given.loops.laws):
        yield f"devices.{name}: held as by a position loop, because its law is not known: {because}"
    yield from (defaults_of(body.part) for body in world.all() if body.part is not None)


def _meshes(world: Body, unusable: Mapping[str, str]) -> Meshes:
    placed = [placed for body in world.all() for placed in body.placed]
    used = [mesh for each in placed if each.link is not None for mesh in each.link.collision_meshes()]
    used += [each.solid.shape for each in placed if each.solid is not None and isinstance(each.solid.shape, Mesh)]
    unread = {mesh.filename: "MuJoCo does not read" for mesh in used if not _is_read(mesh)}
    missing = {**unread, **unusable}
    at_hand = dict.fromkeys(mesh for mesh in used if mesh.filename not in missing)
    return Meshes({mesh: f"mesh_{number}" for number, mesh in enumerate(at_hand, 1)}, missing)


def _is_read(mesh: Mesh) -> bool:
    return PurePosixPath(mesh.filename).suffix.lower() in _READ


def _assets(meshes: Meshes) -> Iterator[Element]:
    for mesh, name in meshes.names.items():
        scale = {} if mesh.scale == (1.0, 1.0, 1.0) else {"scale": numbers(mesh.scale)}
        yield element("mesh", {"name": name, "file": mesh.filename, "inertia": "convex", **scale})


def _buffer(devices: Iterable[Device]) -> Iterator[Element]:
    """Yield the size of the picture that cameras are drawn in, where one is larger than usual."""
    cameras = [device.sensing.camera for device in devices if device.sensing.camera is not None]
    sizes = [stream.pixels for camera in cameras for stream in camera.streams if stream.pixels is not None]
    width, height = (max((usual, *(size[at] for size in sizes))) for at, usual in enumerate(_USUAL_BUFFER))
    if (width, height) != _USUAL_BUFFER:
        yield element("global", {"offwidth": str(width), "offheight": str(height)})


def _followers(world: Body) -> Iterator[Element]:
    for body in world.all():
        mimic = None if body.joint is None else body.joint.mimic
        if body.joint is not None and mimic is not None:
            ends = {"joint1": body.joint.name, "joint2": mimic.joint}
            yield element("joint", ends | {"polycoef": f"{numbers((mimic.offset, mimic.multiplier))} 0 0 0"} | _EQUAL)


def _sensors(cell: Cell) -> Iterator[Element]:
    """Yield force and torque of each sensor that measures both, at the frame where the tools of its device hang."""
    for device in cell.devices:
        for group in force_sensors(device):
            site = {"site": sensed_link(cell, device)}
            yield from (element(kind, {"name": f"{group.name}_{kind}", **site}) for kind in ("force", "torque"))
