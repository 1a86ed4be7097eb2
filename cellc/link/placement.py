"""Transforms as the spec writes them."""

from __future__ import annotations

from cellc.spec.quantity import QuantityVector
from cellc.transforms import Pose, Vector3, from_xyz_rpy


def vector(quantity: QuantityVector | None) -> Vector3:
    """Return three SI values, zero where nothing is written."""
    if quantity is None:
        return (0.0, 0.0, 0.0)
    x, y, z = quantity.si
    return (x, y, z)


def pose(xyz: QuantityVector | None, rpy: QuantityVector | None) -> Pose:
    """Return the pose that ``xyz`` and ``rpy`` mean, identity where neither is written."""
    return from_xyz_rpy(vector(xyz), vector(rpy))
