"""Poses as the contract holds them."""

from __future__ import annotations

from cellc.contract.base import ContractPose
from cellc.formats.numbers import settled
from cellc.transforms import Pose


def contract_pose(pose: Pose) -> ContractPose:
    """Return metres and a unit quaternion x, y, z, w without rounding noise."""
    x, y, z = (settled(value) for value in pose.position)
    qx, qy, qz, qw = (settled(value) for value in pose.quaternion)
    return ContractPose(xyz=(x, y, z), quaternion=(qx, qy, qz, qw))
