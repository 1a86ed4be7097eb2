"""What a cell means, as foreign parsers can tell it: poses of frames, and limits of joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace

from cellc.compiler.cell.frame import Frame
from cellc.compiler.deploy.files import manager_description_file
from cellc.compiler.feasibility import part_with, parts_of
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, identity


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of a movable joint, in rad or m; None where the cell states none."""

    lower: float | None
    upper: float | None
    velocity: float | None
    effort: float | None


@dataclass(frozen=True, slots=True)
class Meant:
    """All that is asked about descriptions: `verify` keeps what the parsers answer by it.

    Args:
        frames: pose of each fixed frame and link in the root, every joint at zero: m and unit quaternions.
        joints: the movable joints of the cell, mimic joints included.
        parts: the same of files with a part of the cell, by their paths.
    """

    frames: Mapping[str, Pose]
    joints: Mapping[str, Limits]
    parts: Mapping[str, Meant] = field(default_factory=dict)


def meant_by(graph: CellGraph) -> Meant:
    """Return what a cell means."""
    cell, parts = graph.cell, dict[str, Meant]()
    for manager in cell.managers if len(parts_of(graph)) > 1 and len(cell.managers) > 1 else ():
        part = _meant(CellGraph(part_with(graph, manager.devices)))
        parts |= {manager_description_file(cell, manager, target): part for target in ("mock", "real")}
    return replace(_meant(graph), parts=parts)


def _meant(graph: CellGraph) -> Meant:
    joints = (joint for device in graph.cell.devices for joint in device.joints)
    limits = {joint.name: Limits(joint.lower, joint.upper, joint.velocity, joint.effort) for joint in joints}
    return Meant(cell_poses(graph.frames), limits)


def cell_poses(frames: FrameTree) -> dict[str, Pose]:
    """Return the pose in the root of every frame that hangs on it without a dynamic edge."""
    poses: dict[str, Pose | None] = {}
    for name in frames.names():
        unknown: list[Frame] = []
        at = frames.get(name)
        while at is not None and at.name not in poses:
            poses[at.name] = None
            unknown.append(at)
            at = frames.get(at.parent)
        pose = identity() if at is None else poses[at.name]
        for frame in reversed(unknown):
            if frame.parent:
                pose = pose @ frame.transform_to_parent if pose and frame.transform_to_parent else None
            poses[frame.name] = pose
    return {name: pose for name, pose in poses.items() if pose is not None}
