"""Hold a generated robot description against the cell: two parsers, and the cell's own frames and joints."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields

from cellc.compiler.artifact import Artifact
from cellc.compiler.verify.disagreement import Disagreement
from cellc.compiler.verify.meant import Limits, Meant
from cellc.compiler.verify.parsers import JointReading, Reading, RefusedError, read_by_pinocchio, read_by_yourdfpy
from cellc.contract.transforms import Pose, apart

_LIMITS = tuple(limit.name for limit in fields(Limits))

# Files write 12 significant digits; ten joints down a 10 m cell that is well below a nanometer and a nanoradian.
_TOLERANCE = 1e-8


def check_description(artifact: Artifact, meant: Meant) -> Iterator[Disagreement]:
    """Yield what in a URDF does not fit."""
    try:
        yourdfpy, positions = read_by_yourdfpy(artifact.text)
        pinocchio = read_by_pinocchio(artifact.text, positions)
    except RefusedError as error:
        yield Disagreement("verify-urdf", artifact.path, str(error))
        return
    for reason in _joint_reasons(pinocchio, yourdfpy, meant.joints):
        yield Disagreement("verify-joints", artifact.path, reason)
    for reason in _frame_reasons(pinocchio, yourdfpy, meant.frames):
        yield Disagreement("verify-frames", artifact.path, reason)


def _joint_reasons(pinocchio: Reading, yourdfpy: Reading, stated: Mapping[str, Limits]) -> Iterator[str]:
    for reader, reading in (("pinocchio", pinocchio), ("yourdfpy", yourdfpy)):
        for name in sorted(set(stated) - set(reading.joints)):
            yield f"{reader} finds no joint `{name}`"
        for name in sorted(set(reading.joints) - set(stated)):
            yield f"{reader} finds a joint `{name}` that the cell does not have"
        for name in sorted(set(reading.joints) & set(stated)):
            yield from _limit_reasons(reader, name, reading.joints[name], stated[name])


def _limit_reasons(reader: str, joint: str, read: JointReading, stated: Limits) -> Iterator[str]:
    for limit in _LIMITS:
        ours, theirs = getattr(stated, limit), getattr(read, limit)
        if ours is not None and not math.isclose(ours, theirs, rel_tol=_TOLERANCE, abs_tol=_TOLERANCE):
            yield f"the {limit} limit of joint `{joint}` is {ours} in the cell and {theirs} for {reader}"


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
        meters, radians = apart(first_poses[name], second_poses[name])
        if max(meters, radians) > _TOLERANCE:
            yield f"frame `{name}` lies {meters:.6g} m and {radians:.6g} rad apart for {first} and {second}"
