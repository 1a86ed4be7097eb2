"""Forward and differential kinematics of a planning group, and how far its joints move the shapes of the cell."""

from __future__ import annotations

import copy
import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose
from cellc.robot.planning.model import MimicJoint, PinShape, PinTransform, RobotModel
from cellc.robot.planning.problem import Array, PlanningGroup
from cellc.robot.planning.scene import CollisionScene


@dataclass(frozen=True, slots=True)
class _DrivenJoint:
    """A joint of pinocchio that is at ``multiplier * configuration[column] + offset``.

    Attributes:
        place: first index in pinocchio's configuration, of ``width`` values.
        row: index in pinocchio's velocity.
    """

    place: int
    width: int
    row: int
    column: int
    multiplier: float
    offset: float


def _driven_joints(model: RobotModel, group: PlanningGroup) -> list[_DrivenJoint]:
    """List the joints that a group moves: its own, and those that mimic them."""
    columns = {joint: column for column, joint in enumerate(group.joints)}
    leads = [MimicJoint(joint, joint, 1.0, 0.0) for joint in group.joints if model.joint_of(joint)]
    driven: list[_DrivenJoint] = []
    for lead in (*leads, *(mimic for mimic in model.mimics if mimic.leader in columns)):
        index = model.kinematics.getJointId(lead.joint)
        place, width = int(model.kinematics.idx_qs[index]), int(model.kinematics.nqs[index])
        row = int(model.kinematics.idx_vs[index])
        driven.append(_DrivenJoint(place, width, row, columns[lead.leader], lead.multiplier, lead.offset))
    return driven


@dataclass(frozen=True, slots=True, eq=False)
class FollowedLine:
    """A straight line of the tip that was followed, in so many steps, as far as it can be.

    Attributes:
        waypoints: the start and a configuration for each step up to the first that is not reached, one in each row.
        jacobians: of the tip for all but the start.
    """

    steps: int
    waypoints: Array
    jacobians: Array


class GroupChain:
    """Maps a group's configuration to pinocchio's, and to the pose and Jacobian of the tip.

    The joints outside the group stand where the scene has them.

    Attributes:
        lines: that were followed last, by where the joints stand and where the tip goes, in every scene.
    """

    def __init__(self, group: PlanningGroup, scene: CollisionScene) -> None:
        """Bind a group to a scene; ModelError where a joint or link of the group does not exist."""
        model = scene.model
        self.turning = np.array([model.is_turning(joint) for joint in group.joints])
        self._model = model.kinematics
        self._data = model.scratch
        self._joints = group.joints
        self._base, self._tip = model.frame_of(group.base_link), model.frame_of(group.tip_link)
        driven = _driven_joints(model, group)
        plain = [joint for joint in driven if joint.width == 1]
        self._plain_from = np.array([joint.column for joint in plain], dtype=np.intp)
        self._plain_to = np.array([joint.place for joint in plain], dtype=np.intp)
        self._plain_factors = np.array([joint.multiplier for joint in plain])
        self._plain_offsets = np.array([joint.offset for joint in plain])
        # A continuous joint is cosine and sine in pinocchio.
        self._circle = [joint for joint in driven if joint.width == 2]
        self._speeds = np.zeros((self._model.nv, len(group.joints)))
        for joint in driven:
            self._speeds[joint.row, joint.column] = joint.multiplier
        self._shape_rates = sweep_rates(model, group.joints, model.geometry.geometryObjects)
        self.lines: dict[tuple[bytes, bytes, Pose], FollowedLine] = {}
        self._bind(scene)

    def _bind(self, scene: CollisionScene) -> None:
        self.scene = scene
        self._rest = scene.rest_configuration()
        pinocchio.framesForwardKinematics(self._model, self._data, self._rest)
        self.transform_base_to_world: PinTransform = self._data.oMf[self._base].copy()
        self._rates = self._shape_rates
        if scene.boxes:
            box_rates = sweep_rates(scene.model, self._joints, scene.box_shapes())
            self._rates = np.vstack((self._shape_rates, box_rates))

    @property
    def rest(self) -> Array:
        """Pinocchio's configuration with the group's own joints anywhere."""
        return self._rest

    def in_scene(self, scene: CollisionScene) -> GroupChain:
        """Return the chain of the same group in another scene of the same model."""
        chain = copy.copy(self)
        chain._bind(scene)
        return chain

    def full(self, configuration: Array) -> Array:
        """Return pinocchio's configuration of the whole cell for one of the group, or one in each row for many."""
        many = configuration.ndim > 1
        vector: Array = np.tile(self._rest, (len(configuration), 1)) if many else self._rest.copy()
        vector[..., self._plain_to] = configuration[..., self._plain_from] * self._plain_factors + self._plain_offsets
        for joint in self._circle:
            angles = (joint.multiplier * configuration[..., joint.column] + joint.offset).ravel().tolist()
            turned = np.array([(math.cos(angle), math.sin(angle)) for angle in angles])
            vector[..., joint.place : joint.place + 2] = turned.reshape(*configuration.shape[:-1], 2)
        return vector

    def sweeps_m(self, differences: Array) -> Array:
        """Bound how far any point of the cell moves while the group moves by each row of differences."""
        return np.asarray(np.max(np.abs(differences) @ self._rates.T, axis=1, initial=0.0))

    def first_collision(self, configurations: Array) -> int | None:
        """Return the first row of several configurations at which the cell is in collision; None where it never is."""
        scene = self.scene
        return next((row for row, full in enumerate(self.full(configurations)) if scene.collides(full)), None)

    def tip(self, configuration: Array) -> PinTransform:
        """Return the transform of the tip to the world."""
        pinocchio.forwardKinematics(self._model, self._data, self.full(configuration))
        return pinocchio.updateFramePlacement(self._model, self._data, self._tip).copy()

    def tip_and_jacobian(self, configuration: Array) -> tuple[PinTransform, Array]:
        """Return the transform of the tip to the world and its Jacobian, 6 rows (m, rad) in the tip's own axes."""
        # computeFrameJacobian would leave the placements of the joints as they were.
        pinocchio.computeJointJacobians(self._model, self._data, self.full(configuration))
        placement = pinocchio.updateFramePlacement(self._model, self._data, self._tip)
        whole = pinocchio.getFrameJacobian(self._model, self._data, self._tip, pinocchio.LOCAL)
        return placement.copy(), whole @ self._speeds

    def collides(self, configuration: Array) -> bool:
        """Tell whether the cell is in collision with the group at a configuration."""
        return self.scene.collides(self.full(configuration))

    def clearance_m(self, configuration: Array) -> float | None:
        """Return the least distance from what the group moves to what is around; None where nothing is checked.

        The arm's own base does not stand around: links from the base of the group on.
        """
        moved = np.asarray(self._rates.any(axis=1), dtype=np.bool_)
        links = set(self._upwards())
        around = np.array([shape.parentFrame not in links for shape in self.scene.shapes()], dtype=np.bool_)
        return self.scene.clearance_m(self.full(configuration), moved, around & ~moved)

    def _upwards(self) -> Iterator[int]:
        """Yield the frames of pinocchio from the tip up to the base of the group."""
        frame = self._tip
        while frame not in (0, self._base):
            yield frame
            frame = int(self._model.frames[frame].parentFrame)
        yield self._base

    def describe_contact(self, configuration: Array) -> str:
        """Say which names touch first in alphabetical order; for the detail of a failure."""
        pairs = self.scene.contacts(self.full(configuration))
        return " and ".join(f"`{name}`" for name in pairs[0]) + " touch" if pairs else "nothing touches"


def sweep_rates(model: RobotModel, joints: tuple[str, ...], shapes: Iterable[PinShape]) -> Array:
    """Bound how far any point of each shape moves by each joint, whatever the other joints do.

    The bound of several joints together is the sum of theirs, by the triangle inequality.

    Args:
        joints: the joints that move; those that mimic them move along.

    Returns:
        Meters for each rad or meter of a joint, shape (shapes, joints).
    """
    columns = {joint: column for column, joint in enumerate(joints)}
    factors = {mimic.joint: mimic for mimic in (*(MimicJoint(name, name, 1.0, 0.0) for name in joints), *model.mimics)}
    subspaces = _subspaces(model)
    rows = []
    for shape in shapes:
        row = np.zeros(len(joints))
        for joint, rate in _rates(model, shape, subspaces):
            mimic = factors.get(str(model.kinematics.names[joint]))
            if mimic is not None and mimic.leader in columns:
                row[columns[mimic.leader]] += abs(mimic.multiplier) * rate
        rows.append(row)
    return np.array(rows).reshape(-1, len(joints))


def _subspaces(model: RobotModel) -> Mapping[int, tuple[Array, Array]]:
    """Return the direction in which each joint of one degree of freedom moves and the axis that it turns about."""
    single = [joint for joint in range(1, model.kinematics.njoints) if model.kinematics.nvs[joint] == 1]
    vectors = {joint: np.asarray(model.scratch.joints[joint].S, dtype=np.float64).reshape(6) for joint in single}
    return {joint: (vector[:3], vector[3:]) for joint, vector in vectors.items()}


def _rates(
    model: RobotModel, shape: PinShape, subspaces: Mapping[int, tuple[Array, Array]]
) -> Iterator[tuple[int, float]]:
    """Yield each joint above a shape with the farthest that a unit of it moves a point.

    A ball holds the shape in the frame of its joint. Turned by the joint, the ball sweeps a ball round the axis, which
    is fixed in the frame above; pushed by it, a ball round the middle of its way.
    """
    shape.geometry.computeLocalAABB()
    center = np.asarray(shape.placement.act(shape.geometry.aabb_center))
    radius, joint = float(shape.geometry.aabb_radius), int(shape.parentJoint)
    while joint != 0:
        if joint in subspaces:
            direction, axis = subspaces[joint]
            if axis.any():
                on_axis = (center @ axis) * axis
                radius += float(np.linalg.norm(center - on_axis))
                center = on_axis
                yield joint, radius
            else:
                lower, upper = _range(model, joint)
                center, radius = center + (lower + upper) / 2.0 * direction, radius + (upper - lower) / 2.0
                yield joint, 1.0
        center = np.asarray(model.kinematics.jointPlacements[joint].act(center))
        joint = int(model.kinematics.parents[joint])


def _range(model: RobotModel, joint: int) -> tuple[float, float]:
    """Return the positions of a prismatic joint in meters; a follower goes where its leader's limits send it."""
    name = str(model.kinematics.names[joint])
    mimic = next((mimic for mimic in model.mimics if mimic.joint == name), MimicJoint(name, name, 1.0, 0.0))
    at = model.kinematics.idx_qs[model.kinematics.getJointId(mimic.leader)]
    lower, upper = model.kinematics.lowerPositionLimit[at], model.kinematics.upperPositionLimit[at]
    ends = (mimic.multiplier * float(lower) + mimic.offset, mimic.multiplier * float(upper) + mimic.offset)
    return min(ends), max(ends)
