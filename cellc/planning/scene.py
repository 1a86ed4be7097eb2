"""What may touch what: the cell's shapes, objects attached to links, and the contacts that are allowed."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping

import pinocchio

from cellc.planning.failure import ModelError
from cellc.planning.limits import Array
from cellc.planning.model import PinShape, RobotModel
from cellc.planning.shapes import Box, LinkPair, movable_pairs, ordered, with_boxes
from cellc.transforms import Pose, Vector3

# Up to so many shapes comparing all bounding boxes with each other takes less time than keeping a tree of them.
_FEW_SHAPES = 64


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
        self.disabled_collisions = tuple(sorted({ordered(*pair) for pair in disabled_collisions}))
        self.other_positions = dict(other_positions or {})
        self._names, self._geometry = with_boxes(model, boxes)
        self._check_names()
        self._geometry.setCollisionPairs(movable_pairs(self._geometry, self._names, self.disabled_collisions))
        self._data = model.kinematics.createData()
        self._geometry_data = self._geometry.createData()
        # Bounding boxes leave only neighbours to be compared shape by shape.
        manager = (
            pinocchio.BroadPhaseManager_NaiveCollisionManager
            if len(self._names) <= _FEW_SHAPES
            else pinocchio.BroadPhaseManager_DynamicAABBTreeCollisionManager
        )
        self._boxes_around = manager(model.kinematics, self._geometry, self._geometry_data)
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
        refused = {ordered(name, other) for other in others}
        return self._with(disabled=tuple(pair for pair in self.disabled_collisions if pair not in refused))

    def with_other_positions(self, positions: Mapping[str, float]) -> CollisionScene:
        """Return the scene with joints outside the group moved, rad or metres; joints not named stay."""
        moved = copy.copy(self)  # the shapes are the same, and what is computed with them is never kept
        moved.other_positions = {**self.other_positions, **positions}
        moved._rest = self.model.configuration(moved.other_positions)
        return moved

    def rest_configuration(self) -> Array:
        """Return a copy of pinocchio's configuration with the other joints in their places."""
        rest: Array = self._rest.copy()
        return rest

    def box_shapes(self) -> Iterator[PinShape]:
        """Yield pinocchio's shape of each box."""
        shapes = self._geometry.geometryObjects
        yield from (shapes[index] for index in range(len(shapes) - len(self.boxes), len(shapes)))

    def collides(self, configuration: Array) -> bool:
        """Tell whether any checked pair touches at a configuration of pinocchio."""
        return bool(
            pinocchio.computeCollisions(self.model.kinematics, self._data, self._boxes_around, configuration, True)
        )

    def touching(self, box: Box, configuration: Array) -> tuple[str, ...]:
        """Return the names of links and boxes that another box would touch at a configuration of pinocchio, sorted.

        Args:
            box: replaces one of its name; what moves with it is not looked at, nor what is disabled with its name.
        """
        others = tuple(each for each in self.boxes if each.name != box.name)
        names, geometry = with_boxes(self.model, (*others, box))
        pairs = movable_pairs(geometry, names, self.disabled_collisions)
        pairs[:-1, :-1] = False
        geometry.setCollisionPairs(pairs)
        data, geometry_data = self.model.kinematics.createData(), geometry.createData()
        pinocchio.computeCollisions(self.model.kinematics, data, geometry, geometry_data, configuration, False)
        found = zip(geometry.collisionPairs, geometry_data.collisionResults, strict=True)
        return tuple(sorted({names[pair.first] for pair, result in found if result.isCollision()}))

    def contacts(self, configuration: Array) -> tuple[LinkPair, ...]:
        """Return all pairs of names that touch at a configuration of pinocchio, sorted."""
        model = self.model.kinematics
        pinocchio.computeCollisions(model, self._data, self._geometry, self._geometry_data, configuration, False)
        found: set[LinkPair] = set()
        for pair, result in zip(self._geometry.collisionPairs, self._geometry_data.collisionResults, strict=True):
            if result.isCollision():
                found.add(ordered(self._names[pair.first], self._names[pair.second]))
        return tuple(sorted(found))

    def checked_pairs(self) -> tuple[LinkPair, ...]:
        """Return the pairs of names that are checked, sorted."""
        pairs = self._geometry.collisionPairs
        return tuple(sorted({ordered(self._names[pair.first], self._names[pair.second]) for pair in pairs}))

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
