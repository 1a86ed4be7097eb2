"""Forward and differential kinematics of a planning group."""

from __future__ import annotations

import math

import numpy as np
import pinocchio

from cellc.mock.planning.limits import Array, PlanningGroup
from cellc.mock.planning.model import PinTransform
from cellc.mock.planning.scene import CollisionScene


class GroupChain:
    """Maps a group's configuration to pinocchio's, and to the pose and Jacobian of the tip.

    The joints outside the group stand where the scene has them.
    """

    def __init__(self, group: PlanningGroup, scene: CollisionScene) -> None:
        """Bind a group to a scene; ModelError where a joint or link of the group does not exist."""
        model = scene.model
        self.scene = scene
        self.turning = np.array([model.is_turning(joint) for joint in group.joints])
        self._model = model.kinematics
        self._data = model.kinematics.createData()
        self._tip = model.frame_of(group.tip_link)
        joints = [model.joint_of(joint) for joint in group.joints]
        places = [(at, int(self._model.idx_qs[joint])) for at, joint in enumerate(joints)]
        widths = [int(self._model.nqs[joint]) for joint in joints]
        plain = [place for place, width in zip(places, widths, strict=True) if width == 1]
        self._plain_from = np.array([at for at, _ in plain], dtype=np.intp)
        self._plain_to = np.array([to for _, to in plain], dtype=np.intp)
        # A continuous joint is cosine and sine in pinocchio.
        self._circle = [place for place, width in zip(places, widths, strict=True) if width == 2]
        self._columns = np.array([self._model.idx_vs[joint] for joint in joints], dtype=np.intp)
        self._rest = scene.rest_configuration()
        pinocchio.framesForwardKinematics(self._model, self._data, self._rest)
        self.transform_base_to_world: PinTransform = self._data.oMf[model.frame_of(group.base_link)].copy()

    def full(self, configuration: Array) -> Array:
        """Return pinocchio's configuration of the whole cell for one of the group."""
        vector: Array = self._rest.copy()
        vector[self._plain_to] = configuration[self._plain_from]
        for at, to in self._circle:
            vector[to], vector[to + 1] = math.cos(configuration[at]), math.sin(configuration[at])
        return vector

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
        return placement, whole[:, self._columns]

    def collides(self, configuration: Array) -> bool:
        """Tell whether the cell is in collision with the group at a configuration."""
        return self.scene.collides(self.full(configuration))

    def describe_contact(self, configuration: Array) -> str:
        """Say which names touch first in alphabetical order; for the detail of a failure."""
        pairs = self.scene.contacts(self.full(configuration))
        return " and ".join(f"`{name}`" for name in pairs[0]) + " touch" if pairs else "nothing touches"
