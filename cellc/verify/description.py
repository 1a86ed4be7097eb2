"""Hold a generated robot description against the cell: two parsers, and the cell's own frames and joints."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from cellc.artifact import Artifact
from cellc.cell.device import DeviceJoint
from cellc.cell.frame import Frame
from cellc.graph.frame_tree import FrameTree
from cellc.transforms import Pose, identity
from cellc.verify.codes import Disagreement
from cellc.verify.parsers import JointReading, Reading, RefusedError, read_by_pinocchio, read_by_yourdfpy

_LIMITS = ("lower", "upper", "velocity", "effort")

# Files write 12 significant digits; ten joints down a 10 m cell that is well below a nanometer and a nanoradian.
_TOLERANCE = 1e-8


def check_description(
    artifact: Artifact, frames: Mapping[str, Pose], joints: Sequence[DeviceJoint]
) -> Iterator[Disagreement]:
    """Yield what does not fit.

    Args:
        artifact: a URDF.
        frames: pose of each fixed frame and link in the root, every joint at zero: m and unit quaternions.
        joints: the movable joints of the cell, mimic joints included.
    """
    try:
        yourdfpy, positions = read_by_yourdfpy(artifact.text)
        pinocchio = read_by_pinocchio(artifact.text, positions)
    except RefusedError as error:
        yield Disagreement("verify-urdf", artifact.path, str(error))
        return
    for reason in _joint_reasons(pinocchio, yourdfpy, joints):
        yield Disagreement("verify-joints", artifact.path, reason)
    for reason in _frame_reasons(pinocchio, yourdfpy, frames):
        yield Disagreement("verify-frames", artifact.path, reason)


def _joint_reasons(pinocchio: Reading, yourdfpy: Reading, joints: Sequence[DeviceJoint]) -> Iterator[str]:
    stated = {joint.name: joint for joint in joints}
    for reader, reading in (("pinocchio", pinocchio), ("yourdfpy", yourdfpy)):
        for name in sorted(set(stated) - set(reading.joints)):
            yield f"{reader} finds no joint `{name}`"
        for name in sorted(set(reading.joints) - set(stated)):
            yield f"{reader} finds a joint `{name}` that the cell does not have"
        for name in sorted(set(reading.joints) & set(stated)):
            yield from _limit_reasons(reader, reading.joints[name], stated[name])


def _limit_reasons(reader: str, read: JointReading, stated: DeviceJoint) -> Iterator[str]:
    for limit in _LIMITS:
        ours, theirs = getattr(stated, limit), getattr(read, limit)
        if ours is not None and not math.isclose(ours, theirs, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE):
            yield f"the {limit} limit of joint `{stated.name}` is {ours} in the cell and {theirs} for {reader}"


def _frame_reasons(pinocchio: Reading, yourdfpy: Reading, frames: Mapping[str, Pose]) -> Iterator[str]:
    yield from _pose_reasons("the cell", frames, "pinocchio", pinocchio.at_zero)
    yield from _pose_reasons("pinocchio", pinocchio.displaced, "yourdfpy", yourdfpy.displaced)


def _pose_reasons(
    first: str, first_poses: Mapping[str, Pose], second: str, second_poses: Mapping[str, Pose]
) -> Iterator[str]:
    for name in sorted(set(first_poses) ^ set(second_poses)):
        has, lacks = (first, second) if name in first_poses else (second, first)
        yield f"frame `{name}` of {has} does not exist for {lacks}"
    for name in sorted(set(first_poses) & set(second_poses)):
        meters, radians = distance(first_poses[name], second_poses[name])
        if max(meters, radians) > _TOLERANCE:
            yield f"frame `{name}` lies {meters:.6g} m and {radians:.6g} rad apart for {first} and {second}"


def distance(first: Pose, second: Pose) -> tuple[float, float]:
    """Return how far two poses of one frame are apart, in m and rad."""
    meters = math.dist(first.position, second.position)
    cosine = abs(sum(a * b for a, b in zip(first.quaternion, second.quaternion, strict=True)))
    # Near zero the arc cosine loses half of the digits: take the chord, on the side of the sphere that is nearer.
    sign = math.copysign(1.0, sum(a * b for a, b in zip(first.quaternion, second.quaternion, strict=True)))
    chord = math.dist(first.quaternion, tuple(sign * part for part in second.quaternion))
    return meters, 2.0 * math.acos(min(1.0, cosine)) if chord > 0.1 else 2.0 * chord


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
