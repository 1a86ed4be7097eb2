"""Parts that grippers take, and what a simulator takes in the place of figures that nothing states."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.frame import FRICTION, FrameKind, Grasp, Solid
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.robot.description.model import Box

EDGE_M = 0.05
DENSITY_KG_M3 = 1000.0
LIGHT_KG = 0.001
"""What a body weighs that moves and of which no mass is stated: none at all is refused."""
_DIGITS = 12
_LEANS = 1e-6
_NEAR_M = 0.25
"""m: what is farther below a part does not carry it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Part:
    """What a gripper takes: a free body, named like the frame that follows it, or after the one that it lies at.

    Args:
        above_m: how high its frame is above the box of the scene that it rests on; None where none is below it.
    """

    name: str
    grasp: Grasp
    pose: Pose
    above_m: float | None = None


def parts(cell: Cell, frames: FrameTree) -> dict[str, Part]:
    """Return the parts of a cell by the frame that states each; nothing where no pose in the world is stated."""
    taken, found = {frame.name for frame in cell.frames}, dict[str, Part]()
    for frame in cell.frames:
        pose = frames.in_world(frame.name)
        if frame.grasp is not None and pose is not None:
            is_dynamic = frame.kind is FrameKind.DYNAMIC
            name = frame.name if is_dynamic else _free_name(f"{frame.name}_part", taken)
            found[frame.name] = Part(name=name, grasp=frame.grasp, pose=pose, above_m=_above_m(cell, frames, pose))
    return found


def _above_m(cell: Cell, frames: FrameTree, pose: Pose) -> float | None:
    """Return how high an upright frame is above the nearest top of an upright box below it."""
    here = [depth for solid in cell.scene if (depth := _height_m(solid, frames, pose)) is not None]
    return min(here, default=None)


def _height_m(solid: Solid, frames: FrameTree, pose: Pose) -> float | None:
    parent = frames.in_world(solid.parent)
    if parent is None or not isinstance(solid.geometry, Box):
        return None
    box = parent @ solid.transform_to_parent @ solid.center
    (x, y, z), (length, width, height) = box.inverse().apply(pose.position), solid.geometry.size
    above_m = round(z - height / 2.0, _DIGITS)
    below = abs(x) <= length / 2.0 and abs(y) <= width / 2.0 and 0.0 < above_m <= _NEAR_M
    return above_m if below and _is_upright(box) and _is_upright(pose) else None


def _is_upright(pose: Pose) -> bool:
    return pose.apply((0.0, 0.0, 1.0))[2] - pose.position[2] > 1.0 - _LEANS


def _free_name(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "_"
    taken.add(name)
    return name


def edges_m(part: Part) -> Vector3:
    """Return the edges of the box: those that are stated, else as wide as fingers meet it, down to what it rests on."""
    edge = part.grasp.width_m or EDGE_M
    height = edge if part.above_m is None else round(edge / 2.0 + part.above_m, _DIGITS)
    return part.grasp.size_m or (edge, edge, height)


def center_m(part: Part) -> float:
    """Return how high the center of the box is in its frame: below it where the part reaches down to its rest."""
    reaches_down = part.grasp.size_m is None and part.above_m is not None
    edge = part.grasp.width_m or EDGE_M
    return round((edge / 2.0 - (part.above_m or 0.0)) / 2.0, _DIGITS) if reaches_down else 0.0


def mass_kg(part: Part) -> float:
    """Return the mass that is stated, or that of as much water."""
    x, y, z = edges_m(part)
    return part.grasp.mass_kg or round(DENSITY_KG_M3 * x * y * z, _DIGITS)


def assumed(part: Part) -> Iterator[str]:
    """Yield what of a part is not stated, with what is taken in its place."""
    grasp = part.grasp
    if grasp.size_m is None and part.above_m is None:
        yield f"its size, as a cube of {grasp.width_m or EDGE_M:g} m"
    elif grasp.size_m is None:
        yield "its size, so that it rests on what is below it"
    if not grasp.mass_kg:
        yield "its mass, as of water"
    if grasp.friction is None:
        yield f"its friction, {FRICTION:g}"
