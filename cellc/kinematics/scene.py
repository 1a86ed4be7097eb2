"""What may touch what: the cell's shapes, objects attached to links, and the contacts that are allowed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import coal
import numpy as np
import pinocchio

from cellc.kinematics.failure import ModelError
from cellc.kinematics.limits import Array
from cellc.kinematics.model import PinGeometry, RobotModel, from_pose
from cellc.transforms import Pose, Vector3

LinkPair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Box:
    """A box that follows a link: an object in the gripper, or on a fixture.

    Attributes:
        link: the link that carries it.
        size: full edge lengths in metres.
        pose_in_link: pose of its centre in the frame of the link.
    """

    name: str
    link: str
    size: Vector3
    pose_in_link: Pose


class CollisionScene:
    """Collision checks of one fixed set of shapes; every change returns another scene.

    Pairs checked: all shapes on different moving bodies, less the disabled pairs of links (as an SRDF lists them) and
    less the pairs that may touch. Shapes on the same moving body, through any number of fixed joints, never approach
    each other and are not checked.
    """

    def __init__(
        self,
        model: RobotModel,
        *,
        disabled_collisions: Iterable[LinkPair] = (),
        boxes: tuple[Box, ...] = (),
        other_positions: Mapping[str, float] | None = None,
    ) -> None:
        """Build the scene.

        Args:
            disabled_collisions: pairs of link or box names that are not checked, in either order.
            boxes: attached objects.
            other_positions: rad or metres of the joints outside the planning group, a gripper's for instance.

        Raises:
            ModelError: a name is not a link, box or joint of this scene.
        """
        self.model = model
        self.boxes = boxes
        self.disabled_collisions = tuple(sorted({_ordered(*pair) for pair in disabled_collisions}))
        self.other_positions = dict(other_positions or {})
        self._names, self._geometry = _shapes(model, boxes)
        self._check_names()
        self._add_pairs()
        self._data = model.kinematics.createData()
        self._geometry_data = self._geometry.createData()
        self._rest = model.configuration(self.other_positions)

    def attach(self, name: str, link: str, size: Vector3, pose_in_link: Pose) -> CollisionScene:
        """Return the scene with a box fixed to a link, replacing a box of this name; metres."""
        return self._with(boxes=(*self.detach(name).boxes, Box(name, link, size, pose_in_link)))

    def detach(self, name: str) -> CollisionScene:
        """Return the scene without the box of this name; the same scene where there is none."""
        if all(box.name != name for box in self.boxes):
            return self
        pairs = tuple(pair for pair in self.disabled_collisions if name not in pair)
        return self._with(boxes=tuple(box for box in self.boxes if box.name != name), disabled=pairs)

    def allow_touch(self, name: str, others: Iterable[str]) -> CollisionScene:
        """Return the scene in which a box or link may touch others: fingers while grasping, a tray while lifting."""
        return self._with(disabled=(*self.disabled_collisions, *((name, other) for other in others)))

    def forbid_touch(self, name: str, others: Iterable[str]) -> CollisionScene:
        """Return the scene in which these pairs are checked again."""
        refused = {_ordered(name, other) for other in others}
        return self._with(disabled=tuple(pair for pair in self.disabled_collisions if pair not in refused))

    def with_other_positions(self, positions: Mapping[str, float]) -> CollisionScene:
        """Return the scene with joints outside the group moved, rad or metres; joints not named stay."""
        return CollisionScene(
            self.model,
            disabled_collisions=self.disabled_collisions,
            boxes=self.boxes,
            other_positions={**self.other_positions, **positions},
        )

    def rest_configuration(self) -> Array:
        """Return a copy of pinocchio's configuration with the other joints in their places."""
        rest: Array = self._rest.copy()
        return rest

    def collides(self, configuration: Array) -> bool:
        """Tell whether any checked pair touches at a configuration of pinocchio."""
        model = self.model.kinematics
        return bool(
            pinocchio.computeCollisions(model, self._data, self._geometry, self._geometry_data, configuration, True)
        )

    def contacts(self, configuration: Array) -> tuple[LinkPair, ...]:
        """Return all pairs of names that touch at a configuration of pinocchio, sorted."""
        model = self.model.kinematics
        pinocchio.computeCollisions(model, self._data, self._geometry, self._geometry_data, configuration, False)
        found: set[LinkPair] = set()
        for pair, result in zip(self._geometry.collisionPairs, self._geometry_data.collisionResults, strict=True):
            if result.isCollision():
                found.add(_ordered(self._names[pair.first], self._names[pair.second]))
        return tuple(sorted(found))

    def checked_pairs(self) -> tuple[LinkPair, ...]:
        """Return the pairs of names that are checked, sorted."""
        pairs = self._geometry.collisionPairs
        return tuple(sorted({_ordered(self._names[pair.first], self._names[pair.second]) for pair in pairs}))

    def _with(
        self, *, boxes: tuple[Box, ...] | None = None, disabled: Iterable[LinkPair] | None = None
    ) -> CollisionScene:
        return CollisionScene(
            self.model,
            disabled_collisions=self.disabled_collisions if disabled is None else disabled,
            boxes=self.boxes if boxes is None else boxes,
            other_positions=self.other_positions,
        )

    def _check_names(self) -> None:
        known = {*self.model.links, *(box.name for box in self.boxes)}
        for pair in self.disabled_collisions:
            for name in pair:
                if name not in known:
                    raise ModelError(f"a disabled collision names `{name}`, which is neither a link nor an object")

    def _add_pairs(self) -> None:
        disabled = set(self.disabled_collisions)
        bodies = [shape.parentJoint for shape in self._geometry.geometryObjects]
        self._geometry.removeAllCollisionPairs()
        for first in range(len(bodies)):
            for second in range(first + 1, len(bodies)):
                pair = _ordered(self._names[first], self._names[second])
                if bodies[first] != bodies[second] and pair not in disabled:
                    self._geometry.addCollisionPair(pinocchio.CollisionPair(first, second))


def _shapes(model: RobotModel, boxes: tuple[Box, ...]) -> tuple[list[str], PinGeometry]:
    geometry = model.geometry.copy()
    frames = model.kinematics.frames
    names = [str(frames[shape.parentFrame].name) for shape in geometry.geometryObjects]
    for box in boxes:
        if box.name in model.links or box.name in names:
            raise ModelError(f"object `{box.name}` has the name of a link or of another object")
        frame = model.frame_of(box.link)
        placement = frames[frame].placement * from_pose(box.pose_in_link)
        shape = coal.Box(np.array(box.size))
        joint = frames[frame].parentJoint
        geometry.addGeometryObject(pinocchio.GeometryObject(box.name, joint, frame, placement, shape))
        names.append(box.name)
    return names, geometry


def _ordered(first: str, second: str) -> LinkPair:
    return (first, second) if first <= second else (second, first)
