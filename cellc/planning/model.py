"""The robot and its cell as pinocchio sees them: kinematics, and collision shapes read from a URDF."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio

from cellc.description.model import Description
from cellc.description.urdf_reader import read_urdf
from cellc.planning.failure import ModelError
from cellc.planning.limits import Array
from cellc.planning.mimic import Mimic, resolve_mimics
from cellc.planning.urdf_check import check_description
from cellc.transforms import Pose

# pinocchio ships no type information: its values are Any, and stay inside this package.
PinModel = Any
PinData = Any
PinGeometry = Any
PinTransform = Any
PinShape = Any


@dataclass(frozen=True, slots=True, eq=False)
class RobotModel:
    """A URDF with its mimic joints and its collision shapes; never changed once read.

    Attributes:
        joints: names of the independent joints of one degree of freedom, parents first, without mimic joints.
        links: names of the links in the order of pinocchio's frames.
        mimics: joints that follow one of ``joints``; to pinocchio they are free, and every configuration sets them.
    """

    kinematics: PinModel
    geometry: PinGeometry
    joints: tuple[str, ...]
    links: tuple[str, ...]
    mimics: tuple[Mimic, ...]

    @classmethod
    def from_urdf(
        cls, text: str, *, description: Description | None = None, package_dirs: Iterable[str] = ()
    ) -> RobotModel:
        """Read the text of an expanded URDF.

        Args:
            text: URDF; collision shapes may be primitives, or meshes under one of ``package_dirs``.
            description: what was read of ``text`` before; it is read here where absent.
            package_dirs: folders in which ``package://`` names are looked up.

        Raises:
            ModelError: the text is no robot description, with the reason that the parser would print to stderr only.
        """
        described = _described(text) if description is None else description
        check_description(described)
        mimics = resolve_mimics(described)
        try:
            model = pinocchio.buildModelFromXML(text)
            geometry = pinocchio.buildGeomFromUrdfString(
                model, text, pinocchio.GeometryType.COLLISION, None, list(package_dirs)
            )
        except (ValueError, RuntimeError) as error:
            raise ModelError(f"pinocchio refuses the robot description: {str(error).splitlines()[0]}") from None
        names = list(model.names)
        single = [names[index] for index in range(1, model.njoints) if model.nvs[index] == 1]
        following = {mimic.joint for mimic in mimics}
        joints = tuple(name for name in single if name not in following)
        links = tuple(frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY)
        return cls(model, geometry, joints, links, mimics)

    def frame_of(self, link: str) -> int:
        """Return pinocchio's index of a link's frame; raise ModelError where there is no such link."""
        if link not in self.links:
            raise ModelError(f"the robot description has no link `{link}`")
        return int(self.kinematics.getFrameId(link, pinocchio.FrameType.BODY))

    def joint_of(self, joint: str) -> int:
        """Return pinocchio's index of an independent joint; raise ModelError where there is no such joint."""
        if joint not in self.joints:
            raise ModelError(f"the robot description has no independent movable joint `{joint}`")
        return int(self.kinematics.getJointId(joint))

    def is_turning(self, joint: str) -> bool:
        """Tell whether a joint is revolute or continuous, so that a whole turn leaves the robot where it was."""
        return "JointModelR" in self.kinematics.joints[self.joint_of(joint)].shortname()

    def configuration(self, positions: Mapping[str, float]) -> Array:
        """Write joint positions as pinocchio's configuration; joints not named stand at the allowed value nearest zero.

        Args:
            positions: rad or metres by joint name; a mimic joint follows its joint and is not named.
        """
        vector: Array = np.array(pinocchio.neutral(self.kinematics), dtype=np.float64)
        for joint in positions:
            self.joint_of(joint)
        chosen = {joint: positions.get(joint, self._rest_of(joint)) for joint in self.joints}
        for joint, value in chosen.items():
            self._set_position(vector, joint, value)
        for mimic in self.mimics:
            self._set_position(vector, mimic.joint, mimic.multiplier * chosen[mimic.leader] + mimic.offset)
        return vector

    def _set_position(self, vector: Array, joint: str, value: float) -> None:
        index = self.kinematics.getJointId(joint)
        at = self.kinematics.idx_qs[index]
        if self.kinematics.nqs[index] == 2:
            vector[at], vector[at + 1] = math.cos(value), math.sin(value)
        else:
            vector[at] = value

    def link_pose(self, link: str, positions: Mapping[str, float], *, base_link: str) -> Pose:
        """Return the pose of a link in the frame of another link."""
        data = self.kinematics.createData()
        pinocchio.framesForwardKinematics(self.kinematics, data, self.configuration(positions))
        return to_pose(data.oMf[self.frame_of(base_link)].actInv(data.oMf[self.frame_of(link)]))

    def _rest_of(self, joint: str) -> float:
        index = self.joint_of(joint)
        if self.kinematics.nqs[index] == 2:
            return 0.0
        at = self.kinematics.idx_qs[index]
        lower, upper = self.kinematics.lowerPositionLimit[at], self.kinematics.upperPositionLimit[at]
        return float(min(max(0.0, lower), upper))


def _described(text: str) -> Description:
    read = read_urdf(text, "robot_description")
    if read.value is None:
        raise ModelError(f"the robot description cannot be read: {read.diagnostics[0].message}")
    return read.value


def to_pose(transform: PinTransform) -> Pose:
    """Turn pinocchio's rigid transform into a pose."""
    x, y, z, qx, qy, qz, qw = (float(value) for value in pinocchio.SE3ToXYZQUAT(transform))
    return Pose((x, y, z), (qx, qy, qz, qw))


def from_pose(pose: Pose) -> PinTransform:
    """Turn a pose into pinocchio's rigid transform."""
    return pinocchio.XYZQUATToSE3(np.array([*pose.position, *pose.quaternion]))
