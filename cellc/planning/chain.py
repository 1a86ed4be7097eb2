"""Forward and differential kinematics of a planning group."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass

import numpy as np
import pinocchio

from cellc.planning.limits import Array, PlanningGroup
from cellc.planning.mimic import Mimic
from cellc.planning.model import PinTransform, RobotModel
from cellc.planning.scene import CollisionScene
from cellc.planning.sweep import sweep_rates


@dataclass(frozen=True, slots=True)
class _DrivenJoint:
    """A joint of pinocchio that stands at ``multiplier * configuration[column] + offset``.

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
    leads = [Mimic(joint, joint, 1.0, 0.0) for joint in group.joints if model.joint_of(joint)]
    found: list[_DrivenJoint] = []
    for lead in (*leads, *(mimic for mimic in model.mimics if mimic.leader in columns)):
        index = model.kinematics.getJointId(lead.joint)
        place, width = int(model.kinematics.idx_qs[index]), int(model.kinematics.nqs[index])
        row = int(model.kinematics.idx_vs[index])
        found.append(_DrivenJoint(place, width, row, columns[lead.leader], lead.multiplier, lead.offset))
    return found


class GroupChain:
    """Maps a group's configuration to pinocchio's, and to the pose and Jacobian of the tip.

    The joints outside the group stand where the scene has them.
    """

    def __init__(self, group: PlanningGroup, scene: CollisionScene) -> None:
        """Bind a group to a scene; ModelError where a joint or link of the group does not exist."""
        model = scene.model
        self.turning = np.array([model.is_turning(joint) for joint in group.joints])
        self._model = model.kinematics
        self._data = model.kinematics.createData()
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

    def in_scene(self, scene: CollisionScene) -> GroupChain:
        """Return the chain of the same group in another scene of the same model."""
        chain = copy.copy(self)  # what is computed in the shared data is never kept
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
        return placement, whole @ self._speeds

    def collides(self, configuration: Array) -> bool:
        """Tell whether the cell is in collision with the group at a configuration."""
        return self.scene.collides(self.full(configuration))

    def describe_contact(self, configuration: Array) -> str:
        """Say which names touch first in alphabetical order; for the detail of a failure."""
        pairs = self.scene.contacts(self.full(configuration))
        return " and ".join(f"`{name}`" for name in pairs[0]) + " touch" if pairs else "nothing touches"
