"""Fits planes and boxes to points that were touched, in meters; the same points give the same figures."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3, from_xyz_rpy

_SWEEPS = 30
_FLAT = 1e-6
"""Points whose second spread is this part of the first or less are on one line; m, where a box has no volume."""


@dataclass(frozen=True, slots=True)
class Fit:
    """A surface through points: its pose in their frame, the size of a box, and the distance of each point from it.

    Of a plane the pose is in the middle of the points, z is its normal, and x is without a part along their y; its
    size is zero.
    """

    pose: Pose
    size: Vector3
    distances_m: tuple[float, ...]


def plane_through(points: Sequence[Vector3], free: Vector3) -> Fit | None:
    """Fit a plane by least squares of the distances along its normal; z points to the side of ``free``.

    The normal is the axis along which the points spread least about their middle: the eigenvector of the least
    eigenvalue of their scatter. None where they are on one line, or ``free`` is on the plane.
    Source: K. Pearson, Philosophical Magazine 2 (1901) 559.
    """
    x, y, z = (math.fsum(point[axis] for point in points) / len(points) for axis in range(3))
    about = [(point[0] - x, point[1] - y, point[2] - z) for point in points]
    spreads = _spreads([[math.fsum(each[i] * each[j] for each in about) for j in range(3)] for i in range(3)])
    (_, normal), (second, _), (first, _) = sorted(spreads)
    side = _dot(normal, (free[0] - x, free[1] - y, free[2] - z))
    if second <= _FLAT * first or abs(side) <= _FLAT:
        return None
    toward = math.copysign(1.0, side)
    ux, uy, uz = (toward * part for part in normal)
    pose = from_xyz_rpy((x, y, z), (math.asin(max(-1.0, min(1.0, -uy))), math.atan2(ux, uz), 0.0))
    return Fit(pose, (0.0, 0.0, 0.0), tuple(abs(_dot(normal, each)) for each in about))


def box_around(points: Sequence[Vector3]) -> Fit | None:
    """Return the smallest box along the axes that holds the points; None where it has no volume."""
    low, high = ([of(point[axis] for point in points) for axis in range(3)] for of in (min, max))
    x, y, z = (top - bottom for bottom, top in zip(low, high, strict=True))
    if min(x, y, z) <= _FLAT:
        return None
    depths = (min(min(point[i] - low[i], high[i] - point[i]) for i in range(3)) for point in points)
    center = (low[0] + x / 2.0, low[1] + y / 2.0, low[2] + z / 2.0)
    return Fit(Pose(center, (0.0, 0.0, 0.0, 1.0)), (x, y, z), tuple(depths))


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return math.fsum(one * other for one, other in zip(a, b, strict=True))


def _spreads(matrix: list[list[float]]) -> list[tuple[float, list[float]]]:
    """Return the eigenvalues of a symmetric matrix of three rows with their unit vectors.

    By cyclic rotations: C. G. J. Jacobi, Journal fuer die reine und angewandte Mathematik 30 (1846) 51.
    """
    vectors = [[float(i == j) for j in range(3)] for i in range(3)]
    for p, q in ((0, 1), (0, 2), (1, 2)) * _SWEEPS:
        if matrix[p][q] == 0.0:
            continue
        ratio = (matrix[q][q] - matrix[p][p]) / (2.0 * matrix[p][q])
        tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.hypot(ratio, 1.0))
        cosine = 1.0 / math.hypot(tangent, 1.0)
        sine = tangent * cosine
        for rows in (matrix, vectors):
            for row in rows:
                row[p], row[q] = cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]
        matrix[p], matrix[q] = (
            [cosine * a - sine * b for a, b in zip(matrix[p], matrix[q], strict=True)],
            [sine * a + cosine * b for a, b in zip(matrix[p], matrix[q], strict=True)],
        )
    return [(matrix[i][i], [vectors[j][i] for j in range(3)]) for i in range(3)]
