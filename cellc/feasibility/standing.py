"""Where a frame stands that no joint of the cell moves."""

from __future__ import annotations

from cellc.graph.frame_tree import FrameTree
from cellc.transforms import Pose, identity


def pose_in_world(frames: FrameTree, name: str) -> Pose | None:
    """Return the pose of a frame in the world; a dynamic frame stands where the mock puts what it follows.

    Returns:
        None for a frame that a joint moves, and for a dynamic frame without a simulated pose.
    """
    pose = identity()
    seen: set[str] = set()
    while (frame := frames.get(name)) is not None and name not in seen:
        seen.add(name)
        if not frame.parent:
            return pose
        if frame.simulated_pose is not None:
            pose, name = frame.simulated_pose.pose @ pose, frame.simulated_pose.parent
        elif frame.moving or frame.transform_to_parent is None:
            return None
        else:
            pose, name = frame.transform_to_parent @ pose, frame.parent
    return None
