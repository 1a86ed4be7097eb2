"""Read a robot description with pinocchio."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pinocchio

from cellc.transforms import Pose
from cellc.verify.reading import JointReading, Reading, RefusedError


def read_by_pinocchio(urdf: str, positions: Mapping[str, float]) -> Reading:
    """Return joints and link poses.

    Args:
        positions: position of each joint for the displaced poses, mimic joints included: pinocchio is told to treat
            them as free, so that zero means zero for all.

    Raises:
        RefusedError: pinocchio does not take the description; its reason goes to standard error.
    """
    try:
        model = pinocchio.buildModelFromXML(urdf)
    except (ValueError, RuntimeError) as error:
        raise RefusedError(f"pinocchio refuses it: {error}") from error
    joints = {name: _joint(model, index) for index, name in enumerate(model.names) if index}
    zero, displaced = pinocchio.neutral(model), pinocchio.neutral(model)
    for name in joints:
        _set(model, displaced, name, positions.get(name, 0.0))
    return Reading(joints, _poses(model, zero), _poses(model, displaced))


def _joint(model: Any, index: int) -> JointReading:
    position, velocity = model.joints[index].idx_q, model.joints[index].idx_v
    if model.joints[index].nq == 2:  # continuous: cosine and sine
        lower, upper = -np.inf, np.inf
    else:
        lower, upper = model.lowerPositionLimit[position], model.upperPositionLimit[position]
    limits = (lower, upper, model.velocityLimit[velocity], model.effortLimit[velocity])
    return JointReading(*(float(limit) for limit in limits))


def _set(model: Any, configuration: Any, name: str, position: float) -> None:
    joint = model.joints[model.getJointId(name)]
    values = (np.cos(position), np.sin(position)) if joint.nq == 2 else (position,)
    configuration[joint.idx_q : joint.idx_q + joint.nq] = values


def _poses(model: Any, configuration: Any) -> dict[str, Pose]:
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, configuration)
    poses = {}
    for frame, placement in zip(model.frames, data.oMf, strict=True):
        if frame.type == pinocchio.FrameType.BODY:
            x, y, z = map(float, placement.translation)
            qx, qy, qz, qw = map(float, pinocchio.Quaternion(placement.rotation).coeffs())
            poses[frame.name] = Pose((x, y, z), (qx, qy, qz, qw))
    return poses
