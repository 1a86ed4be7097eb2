"""What motion planning needs of a cell, built once and shared by all rehearsals."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellc.contract.contract import Contract, ContractGroup, ContractJointLimits
from cellc.description.model import Description
from cellc.mock.errors import MockError
from cellc.mock.world.world import LinkTree, link_tree
from cellc.planning import (
    CollisionScene,
    JointLimits,
    LimitsError,
    ModelError,
    Planner,
    PlanningGroup,
    RobotModel,
)
from cellc.transforms import Pose, identity


@dataclass(frozen=True, slots=True, eq=False)
class GroupModel:
    """A planning group: goals are for its tip frame, which may be fixed to the link that the planner moves."""

    planner: Planner
    transform_tip_to_link: Pose


@dataclass(frozen=True, slots=True, eq=False)
class MotionModel:
    """The robot model, its groups, and the scene without objects."""

    robot: RobotModel
    groups: Mapping[str, GroupModel]
    scene: CollisionScene
    links: LinkTree


def build_motion_model(
    contract: Contract, urdf: str, description: Description, allowed_collisions: Sequence[tuple[str, str]]
) -> MotionModel:
    """Build the planners of all groups; raise MockError where the URDF and the contract do not fit together."""
    try:
        robot = RobotModel.from_urdf(urdf, description=description)
        scene = CollisionScene(robot, disabled_collisions=allowed_collisions)
    except ModelError as error:
        raise MockError(contract.files.urdf_mock, str(error)) from None
    groups = {name: _group_model(name, group, contract, robot, scene) for name, group in contract.groups.items()}
    return MotionModel(robot, groups, scene, link_tree(description))


def _group_model(
    name: str, group: ContractGroup, contract: Contract, robot: RobotModel, scene: CollisionScene
) -> GroupModel:
    missing = sorted(set(group.joints) - set(contract.joint_limits))
    if missing:
        raise MockError("contract.json", f"joint `{missing[0]}` of group `{name}` has no limits")
    try:
        tip_link, transform_tip_to_link = _link_of(group.tip_frame, contract, robot)
        planning_group = PlanningGroup(name, group.joints, group.base_link, tip_link)
        limits = _limits(group.joints, [contract.joint_limits[joint] for joint in group.joints])
        return GroupModel(Planner(robot, planning_group, limits, scene), transform_tip_to_link)
    except (ModelError, LimitsError) as error:
        raise MockError("contract.json", f"group `{name}`: {error}") from None


def _limits(joints: tuple[str, ...], limits: list[ContractJointLimits]) -> JointLimits:
    return JointLimits(
        joints=joints,
        lower=tuple(-math.inf if limit.lower is None else limit.lower for limit in limits),
        upper=tuple(math.inf if limit.upper is None else limit.upper for limit in limits),
        velocity=tuple(limit.velocity for limit in limits),
        acceleration=tuple(limit.acceleration for limit in limits),
        jerk=tuple(limit.jerk for limit in limits),
    )


def _link_of(frame: str, contract: Contract, robot: RobotModel) -> tuple[str, Pose]:
    """Return the nearest link above a frame, and the pose of the frame in it."""
    pose = identity()
    for _ in range(len(contract.frames) + 1):
        if frame in robot.links:
            return frame, pose
        entry = contract.frames.get(frame)
        if entry is None or entry.pose is None:
            break
        pose = Pose(entry.pose.xyz, entry.pose.quaternion) @ pose
        frame = entry.parent
    raise ModelError(f"frame `{frame}` is no link of the robot description and not fixed to one")
