"""Quantities and transforms as the spec writes them, in SI."""

from __future__ import annotations

from cellc.compiler.cell.site import JointFigure
from cellc.compiler.spec.quantity import Quantity, QuantityVector
from cellc.contract.transforms import Pose, Vector3, from_xyz_rpy


def si(quantity: Quantity | None) -> float | None:
    """Return a quantity in SI, None where nothing is written."""
    return None if quantity is None else quantity.si


def joint_figure(quantity: Quantity) -> JointFigure:
    """Return a position or speed of a joint, and whether the user wrote it as a length."""
    return JointFigure(quantity.si, quantity.linear)


def vector(quantity: QuantityVector | None) -> Vector3:
    """Return three SI values, zero where nothing is written."""
    if quantity is None:
        return (0.0, 0.0, 0.0)
    x, y, z = quantity.si
    return (x, y, z)


def pose(xyz: QuantityVector | None, rpy: QuantityVector | None) -> Pose:
    """Return the pose that ``xyz`` and ``rpy`` mean, identity where neither is written."""
    return from_xyz_rpy(vector(xyz), vector(rpy))
