"""What motions are planned with: the parts of the cell whose robots can reach each other, and its planning groups."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from cellc.contract.contract import Contract, ContractGroup, ContractJointLimits
from cellc.contract.frozen import dataclass
from cellc.contract.quantities import LARGEST, SMALLEST
from cellc.contract.transforms import Pose, climb
from cellc.mock.control.parameters.file import ParameterFile, ParameterFileError
from cellc.mock.errors import MockError
from cellc.mock.nodes.parts import cut
from cellc.mock.world.world import LinkTree, link_tree
from cellc.robot.description.meshes import absent, without_shapes
from cellc.robot.description.model import Description
from cellc.robot.planning import (
    CollisionScene,
    JointLimits,
    LimitsError,
    ModelError,
    Planner,
    PlanningGroup,
    RobotModel,
    UnknownShapeError,
)


@dataclass(frozen=True, slots=True, eq=False)
class PartModel:
    """What is looked at together: the robots that can reach each other with what is in their reach, without objects."""

    robot: RobotModel
    scene: CollisionScene

    def own(self, positions: Mapping[str, float]) -> dict[str, float]:
        """Return the positions of its independent joints among those of many, by name in order."""
        return {name: positions[name] for name in sorted(positions) if name in self.robot.joints}


@dataclass(frozen=True, slots=True, eq=False)
class GroupModel:
    """A planning group: goals are for its tip frame, which may be fixed to the link that the planner moves.

    Joints that begin outside their limits by no more than ``start_outside`` are planned for from the limit, rad or m.
    """

    part: PartModel
    planner: Planner
    transform_tip_to_link: Pose
    start_outside: float


@dataclass(frozen=True, slots=True, eq=False)
class MotionModel:
    """The parts of the cell, and its groups.

    ``unseen`` are the links with a shape whose mesh is not there: nothing is planned round it.
    """

    parts: tuple[PartModel, ...]
    groups: Mapping[str, GroupModel]
    links: LinkTree
    unseen: tuple[str, ...] = ()

    def part_of(self, joint: str) -> PartModel:
        """Return the part with a joint; the first where none has it."""
        return next((part for part in self.parts if joint in part.robot.joints), self.parts[0])


def build_motion_model(
    contract: Contract,
    urdf: str,
    description: Description,
    allowed_collisions: Sequence[tuple[str, str]],
    mesh_roots: Sequence[Path] = (),
    stage: tuple[str, str] = ("", ""),
) -> MotionModel:
    """Build the planners of all groups; raise MockError where the URDF and the contract do not fit together.

    Args:
        stage: name and text of the file that move_group is given last.
    """
    limits = _capped(contract, *stage)
    missing, parts = set[str](), list[PartModel]()
    for text, part in cut(contract, urdf, description):
        try:
            robot = RobotModel.from_urdf(text, description=part, mesh_roots=mesh_roots)
        except UnknownShapeError:
            missing |= absent((mesh for link in part.links for mesh in link.collision_meshes()), mesh_roots)
            robot = _of(contract, without_shapes(text, missing), mesh_roots)
        except ModelError as error:
            raise MockError(contract.files.urdf_mock, str(error)) from None
        parts.append(_part_model(contract, robot, allowed_collisions, alone=not contract.parts))
    groups = {name: _group_model(name, group, contract, limits, parts) for name, group in contract.groups.items()}
    unseen = (
        link.name for link in description.links if any(mesh.filename in missing for mesh in link.collision_meshes())
    )
    return MotionModel(tuple(parts), groups, link_tree(description), tuple(unseen))


def _of(contract: Contract, urdf: str, mesh_roots: Sequence[Path]) -> RobotModel:
    try:
        return RobotModel.from_urdf(urdf, mesh_roots=mesh_roots)
    except ModelError as error:
        raise MockError(contract.files.urdf_mock, str(error)) from None


def _part_model(
    contract: Contract, robot: RobotModel, allowed_collisions: Sequence[tuple[str, str]], *, alone: bool
) -> PartModel:
    """Return a part with the pairs of the SRDF that it has; a pair of unknown links is a mistake where it is alone."""
    own = [pair for pair in allowed_collisions if alone or not set(pair) - set(robot.links)]
    try:
        return PartModel(robot, CollisionScene(robot, disabled_collisions=own))
    except ModelError as error:
        raise MockError(contract.files.urdf_mock, str(error)) from None


def _capped(contract: Contract, file: str, text: str) -> Mapping[str, ContractJointLimits]:
    """Return the limits that MoveIt plans with: those of the contract within those of a stage; or raise MockError."""
    try:
        given = ParameterFile(text).of_node("move_group", "")
    except ParameterFileError as error:
        raise MockError(file, error.reason) from None
    limits = dict(contract.joint_limits)
    for joint, of in ((joint, of) for joint in limits for of in ("velocity", "acceleration")):
        name = f"robot_description_planning.joint_limits.{joint}.max_{of}"
        value = given.get(name)
        if isinstance(value, float) and SMALLEST <= value <= LARGEST:
            limits[joint] = limits[joint].model_copy(update={of: min(value, getattr(limits[joint], of))})
        elif value is not None:
            raise MockError(file, f"`{name}` must be a number from {SMALLEST:g} to {LARGEST:g}, got {value!a}")
    return limits


def _group_model(
    name: str,
    group: ContractGroup,
    contract: Contract,
    known: Mapping[str, ContractJointLimits],
    parts: Sequence[PartModel],
) -> GroupModel:
    missing = sorted(set(group.joints) - set(known))
    if missing:
        raise MockError("contract.json", f"joint `{missing[0]}` of group `{name}` has no limits")
    if not group.joints:
        raise MockError("contract.json", f"group `{name}` has no joint")
    part = next((part for part in parts if group.joints[0] in part.robot.joints), parts[0])
    try:
        tip_link, transform_tip_to_link = _link_of(group.tip_frame, contract, part.robot)
        planning_group = PlanningGroup(name, group.joints, group.base_link, tip_link)
        limits = _limits(group.joints, [known[joint] for joint in group.joints])
        planner = Planner(part.robot, planning_group, limits, part.scene)
        return GroupModel(part, planner, transform_tip_to_link, group.start_outside)
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

    def edge(child: str) -> tuple[str, Pose] | None:
        entry = contract.frames.get(child)
        return None if entry is None or entry.pose is None else (entry.parent, entry.pose.pose)

    link, pose = climb(frame, edge, robot.links)
    if link in robot.links:
        return link, pose
    raise ModelError(f"frame `{link}` is neither a link of the robot description nor fixed to one")
