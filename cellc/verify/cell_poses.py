"""Where the cell itself puts its frames, every joint at zero."""

from __future__ import annotations

from cellc.graph.frame_tree import FrameTree
from cellc.transforms import Pose, identity


def cell_poses(frames: FrameTree) -> dict[str, Pose]:
    """Return the pose in the root of every frame that hangs on it without a dynamic edge."""
    poses: dict[str, Pose] = {}
    for name in frames.names():
        pose: Pose | None = identity()
        for frame in frames.chain(name):
            if not frame.parent:
                break
            pose = frame.transform_to_parent @ pose if pose and frame.transform_to_parent else None
        if pose is not None:
            poses[name] = pose
    return poses
