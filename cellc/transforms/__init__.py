"""Rigid transforms in plain Python: poses, rotations and their interpolation."""

from cellc.transforms.pose import Pose, Quaternion, Vector3, from_xyz_rpy, identity, interpolate

__all__ = ["Pose", "Quaternion", "Vector3", "from_xyz_rpy", "identity", "interpolate"]
