"""Many poses in one array: each operation on all of them, in the order of those of `Pose`, with the same bits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from cellc.contract.transforms import Pose
from cellc.mock.world.world import LinkJoint

Values: TypeAlias = NDArray[np.float64]
"""One number for each pose; rank 0 where it is the same in all of them."""
Poses: TypeAlias = tuple[Values, ...]
"""Position, m, and quaternion x, y, z, w of each pose."""


def alike(pose: Pose) -> Poses:
    """Return poses that are all the same one."""
    return tuple(np.asarray(value) for value in (*pose.position, *pose.quaternion))


def composed(first: Poses, second: Poses) -> Poses:
    """Compose each pose with one, as `Pose.__matmul__` does."""
    px, py, pz, x, y, z, w = first
    qx, qy, qz, bx, by, bz, bw = second
    tx, ty, tz = 2.0 * (y * qz - z * qy), 2.0 * (z * qx - x * qz), 2.0 * (x * qy - y * qx)
    cx = w * bx + x * bw + y * bz - z * by
    cy = w * by - x * bz + y * bw + z * bx
    cz = w * bz + x * by - y * bx + z * bw
    cw = w * bw - x * bx - y * by - z * bz
    length = np.sqrt(cx * cx + cy * cy + cz * cz + cw * cw)
    return (
        px + (qx + w * tx + (y * tz - z * ty)),
        py + (qy + w * ty + (z * tx - x * tz)),
        pz + (qz + w * tz + (x * ty - y * tx)),
        *(part / length for part in (cx, cy, cz, cw)),
    )


def displaced(joint: LinkJoint, positions: Mapping[str, Values]) -> Poses:
    """Return how far a moving joint has moved its child, as `LinkJoint.displacement` does; sines are those of libm."""
    zero = np.zeros(())
    at = joint.multiplier * positions.get(joint.follows or joint.name, zero) + joint.offset
    x, y, z = joint.axis
    if joint.slides:
        return (x * at, y * at, z * at, zero, zero, zero, np.ones(()))
    half = at / 2.0
    sine, cosine = (
        np.array([of(value) for value in half.ravel().tolist()]).reshape(half.shape) for of in (math.sin, math.cos)
    )
    return (zero, zero, zero, x * sine, y * sine, z * sine, cosine)
