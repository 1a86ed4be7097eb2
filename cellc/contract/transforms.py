"""A rigid transform, right-handed, meters and unit quaternions (REP-103)."""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Sequence

from cellc.contract.frozen import dataclass

Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]  # x, y, z, w as in geometry_msgs/msg/Quaternion

_NEAR_POLE = 1e-3
"""Of the half angle between the pitch and a quarter turn: below it, roll and yaw begin to lose digits."""


@dataclass(frozen=True, slots=True)
class Pose:
    """The pose of a child frame in its parent frame; as a map it takes child coordinates to parent coordinates."""

    position: Vector3
    quaternion: Quaternion

    def __matmul__(self, other: Pose) -> Pose:
        """Compose: ``parent_to_a @ a_to_b`` is the pose of b in parent."""
        return Pose(self.apply(other.position), _normalized(_product(self.quaternion, other.quaternion)))

    def apply(self, point: Vector3) -> Vector3:
        """Express a point of the child frame in the parent frame, in meters."""
        rotated = _rotate(self.quaternion, point)
        x, y, z = self.position
        return (x + rotated[0], y + rotated[1], z + rotated[2])

    def inverse(self) -> Pose:
        """Return the pose of the parent frame in the child frame."""
        x, y, z, w = self.quaternion
        conjugate = (-x, -y, -z, w)
        px, py, pz = _rotate(conjugate, self.position)
        return Pose((-px, -py, -pz), conjugate)

    def rotation_vector(self) -> Vector3:
        """Return the axis of the turn times its angle, at most pi, in radians."""
        x, y, z, w = self.quaternion
        length = math.sqrt(x * x + y * y + z * z)
        if length < 1e-15:
            return (0.0, 0.0, 0.0)
        angle = 2.0 * math.atan2(length, abs(w))
        scale = math.copysign(angle / length, w)
        return (scale * x, scale * y, scale * z)

    def rpy(self) -> Vector3:
        """Return fixed-axis roll, pitch, yaw in radians (URDF).

        The pitch lies within a quarter turn, or within 0.2 deg beyond it where roll and yaw are smaller so: vendors
        write a quarter turn as 1.5708.
        """
        x, y, z, w = self.quaternion
        up, down = math.hypot(w + y, x - z), math.hypot(w - y, x + z)
        half_sum, half_difference = math.atan2(x + z, w - y), math.atan2(x - z, w + y)
        roll, yaw = _wrapped(half_sum + half_difference), _wrapped(half_sum - half_difference)
        pitch = math.pi / 2.0 - 2.0 * math.atan2(down, up)
        if (weaker := min(up, down)) >= _NEAR_POLE:
            return (roll, pitch, yaw)
        if abs(roll) + abs(yaw) > math.pi:
            yaw, pitch = _wrapped(yaw + math.pi), math.copysign(math.pi, pitch) - pitch
        # Here only the sum or the difference of roll and yaw is exact. Yaw keeps the digits that turn the frame by
        # 1e-13 rad or more, so that rounding noise never shows.
        yaw = _wrapped(round(yaw, 13 + math.floor(math.log10(max(weaker, 1e-300)))))
        return (_wrapped(yaw + 2.0 * half_difference if down < up else 2.0 * half_sum - yaw), pitch, yaw)


def apart(first: Pose, second: Pose) -> tuple[float, float]:
    """Return how far two poses of one frame are apart, in m and rad."""
    between = (first.inverse() @ second).rotation_vector()
    return math.dist(first.position, second.position), math.hypot(*between)


def identity() -> Pose:
    """Return the pose of a frame in itself."""
    return Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def climb(frame: str, edge: Callable[[str], tuple[str, Pose] | None], tops: Container[str] = ()) -> tuple[str, Pose]:
    """Return the frame at which the way up from a frame ends, and the pose of the frame in it.

    It ends at one of ``tops``, and where there is no edge up or one would lead round again.

    Args:
        edge: the parent of a frame, and the pose of the frame in it; None where the way ends.
    """
    pose, seen = identity(), set[str]()
    while frame not in tops and frame not in seen and (above := edge(frame)) is not None:
        seen.add(frame)
        frame, pose = above[0], above[1] @ pose
    return frame, pose


def from_xyz_rpy(xyz: Vector3, rpy: Vector3) -> Pose:
    """Build a pose from meters and fixed-axis roll, pitch, yaw in radians, as URDF ``<origin>`` means them."""
    roll, pitch, yaw = (angle / 2.0 for angle in rpy)
    cr, sr = math.cos(roll), math.sin(roll)
    cp, sp = math.cos(pitch), math.sin(pitch)
    cy, sy = math.cos(yaw), math.sin(yaw)
    quaternion = (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
    return Pose(xyz, quaternion)


def interpolate(start: Pose, end: Pose, fraction: float) -> Pose:
    """Interpolate as tf2 does: position linearly, rotation along the shorter great arc."""
    keep = 1.0 - fraction
    x, y, z = (keep * a + fraction * b for a, b in zip(start.position, end.position, strict=True))
    return Pose((x, y, z), _slerp(start.quaternion, end.quaternion, fraction))


def quaternion_of(m: Sequence[Sequence[float]]) -> Quaternion:
    """Return the unit quaternion of a rotation matrix, row by row; of a 4x4 matrix the upper left part is read.

    Its largest component is computed first, and is positive, so that nothing cancels (S. W. Shepperd,
    Quaternion from Rotation Matrix, Journal of Guidance and Control 1(3), 1978).
    """
    squares = (
        1.0 + m[0][0] - m[1][1] - m[2][2],
        1.0 - m[0][0] + m[1][1] - m[2][2],
        1.0 - m[0][0] - m[1][1] + m[2][2],
        1.0 + m[0][0] + m[1][1] + m[2][2],
    )
    yz, zx, xy = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    sums = (m[1][0] + m[0][1], m[2][0] + m[0][2], m[2][1] + m[1][2])
    rows: tuple[Quaternion, ...] = (
        (squares[0], sums[0], sums[1], yz),
        (sums[0], squares[1], sums[2], zx),
        (sums[1], sums[2], squares[2], xy),
        (yz, zx, xy, squares[3]),
    )
    largest = max(range(4), key=lambda index: squares[index])
    scale = 0.5 / math.sqrt(squares[largest])
    x, y, z, w = (scale * value for value in rows[largest])
    return (x, y, z, w)


def _wrapped(angle: float) -> float:
    """Return an angle between minus and plus half a turn, which itself is positive however it was rounded."""
    within = math.remainder(angle, math.tau)
    return within if within > 1e-12 - math.pi else within + math.tau


def _slerp(start: Quaternion, end: Quaternion, fraction: float) -> Quaternion:
    cosine = sum(a * b for a, b in zip(start, end, strict=True))
    sign = -1.0 if cosine < 0.0 else 1.0
    cosine = min(1.0, abs(cosine))
    angle = math.acos(cosine)
    if angle < 1e-9:  # the arc is shorter than rounding: linear weights are exact enough and defined
        weights = (1.0 - fraction, fraction * sign)
    else:
        sine = math.sin(angle)
        weights = (math.sin((1.0 - fraction) * angle) / sine, sign * math.sin(fraction * angle) / sine)
    x, y, z, w = (weights[0] * a + weights[1] * b for a, b in zip(start, end, strict=True))
    return _normalized((x, y, z, w))


def _product(a: Quaternion, b: Quaternion) -> Quaternion:
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def _rotate(quaternion: Quaternion, point: Vector3) -> Vector3:
    x, y, z, w = quaternion
    px, py, pz = point
    tx, ty, tz = 2.0 * (y * pz - z * py), 2.0 * (z * px - x * pz), 2.0 * (x * py - y * px)
    return (
        px + w * tx + (y * tz - z * ty),
        py + w * ty + (z * tx - x * tz),
        pz + w * tz + (x * ty - y * tx),
    )


def _normalized(quaternion: Quaternion) -> Quaternion:
    x, y, z, w = quaternion
    length = math.sqrt(x * x + y * y + z * z + w * w)
    return (x / length, y / length, z / length, w / length)
