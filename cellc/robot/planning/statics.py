"""What holds a robot still: the torques and forces of its joints against gravity, with what it carries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio

from cellc.contract.transforms import Vector3
from cellc.robot.planning.model import RobotModel


@dataclass(frozen=True, slots=True)
class CarriedMass:
    """A mass in kg whose center lies at a place of a link, m; the description of the robot does not have it."""

    link: str
    mass_kg: float
    center: Vector3


def holding_efforts(
    robot: RobotModel, positions: Mapping[str, float], carried: Sequence[CarriedMass] = ()
) -> dict[str, float]:
    """Return what each joint must give for the robot to stand still, in Nm, or N where it slides.

    Args:
        positions: rad or m by joint name; joints that are not named stand as `RobotModel.configuration` says.
        carried: what links carry besides their own mass.
    """
    model, data = robot.kinematics, robot.kinematics.createData()
    configuration = robot.configuration(positions)
    gravity = -float(model.gravity.linear[2])  # m/s², down along z of the root link
    efforts = np.array(pinocchio.computeGeneralizedGravity(model, data, configuration))
    pinocchio.framesForwardKinematics(model, data, configuration)
    for mass in carried:
        frame = robot.frame_of(mass.link)
        moves = pinocchio.computeFrameJacobian(
            model, data, configuration, frame, pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        lever = data.oMf[frame].rotation @ np.array(mass.center)
        # The velocity of the center is v + w × lever; gravity asks for its upward part alone.
        upward = moves[2] + moves[3] * lever[1] - moves[4] * lever[0]
        efforts = efforts + upward * mass.mass_kg * gravity
    return {joint: float(efforts[model.idx_vs[robot.joint_of(joint)]]) for joint in robot.joints}
