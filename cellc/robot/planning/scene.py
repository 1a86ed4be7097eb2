"""What may touch what: the shapes of the cell, boxes that follow links, and the contacts that are allowed."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping, Sequence

import coal
import numpy as np
import numpy.typing as npt
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.contract.transforms import Pose, Vector3
from cellc.robot.planning.model import PinData, PinGeometry, PinManager, PinShape, RobotModel, from_pose
from cellc.robot.planning.problem import Array, ModelError

# Up to so many shapes comparing all bounding boxes with each other takes less time than keeping a tree of them.
_FEW_SHAPES = 64
LinkPair = tuple[str, str]


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
            other_positions: rad or meters of the joints outside the planning group, a gripper's for instance.

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
        self._data = model.scratch
        self._geometry_data = self._geometry.createData()
        self._boxes_around = broad_phase(model, self._geometry, self._geometry_data)
        self._rest = model.configuration(self.other_positions)

    def attach(self, name: str, link: str, size: Vector3, pose_in_link: Pose) -> CollisionScene:
        """Return the scene with a box fixed to a link, replacing a box of this name; meters."""
        return self._with(boxes=(*self.detach(name).boxes, Box(name, link, size, pose_in_link)))

    def detach(self, name: str) -> CollisionScene:
        """Return the scene without the box of this name; the same scene without one."""
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
        """Return the scene with joints outside the group moved, rad or meters; joints not named stay."""
        moved = copy.copy(self)  # the shapes are the same, and what is computed with them is never kept
        moved.other_positions = {**self.other_positions, **positions}
        moved._rest = self.model.configuration(moved.other_positions)
        return moved

    def rest_configuration(self) -> Array:
        """Return a copy of pinocchio's configuration with the other joints in their places."""
        rest: Array = self._rest.copy()
        return rest

    def shapes(self) -> Sequence[PinShape]:
        """Return pinocchio's shapes, boxes last."""
        geometries: Sequence[PinShape] = self._geometry.geometryObjects
        return geometries

    def box_shapes(self) -> Iterator[PinShape]:
        """Yield pinocchio's shape of each box."""
        shapes = self.shapes()
        yield from (shapes[index] for index in range(len(shapes) - len(self.boxes), len(shapes)))

    def collides(self, configuration: Array) -> bool:
        """Tell whether any checked pair touches at a configuration of pinocchio."""
        return bool(
            pinocchio.computeCollisions(self.model.kinematics, self._data, self._boxes_around, configuration, True)
        )

    def clearance_m(
        self, configuration: Array, these: npt.NDArray[np.bool_], others: npt.NDArray[np.bool_]
    ) -> float | None:
        """Return the least distance of these shapes from others at a configuration of pinocchio, in whole µm.

        Args:
            these: of each shape, boxes last, whether it is one.
            others: the same; pairs that are not checked are left out.

        Returns:
            None where no pair is left; negative where shapes are in each other.
        """
        geometry = self._geometry
        # What is computed with has no past: a search that begins where the last one ended comes out otherwise.
        geometry_data = geometry.createData()
        pinocchio.updateGeometryPlacements(self.model.kinematics, self._data, geometry, geometry_data, configuration)
        pairs = enumerate(geometry.collisionPairs)
        between = [
            index
            for index, pair in pairs
            if (these[pair.first] and others[pair.second]) or (others[pair.first] and these[pair.second])
        ]
        distances = (pinocchio.computeDistance(geometry, geometry_data, index).min_distance for index in between)
        least = min(distances, default=None)
        return None if least is None else round(float(least), 6)

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
        geometry_data = geometry.createData()
        pinocchio.computeCollisions(self.model.kinematics, self._data, geometry, geometry_data, configuration, False)
        results = zip(geometry.collisionPairs, geometry_data.collisionResults, strict=True)
        return tuple(sorted({names[pair.first] for pair, result in results if result.isCollision()}))

    def contacts(self, configuration: Array) -> tuple[LinkPair, ...]:
        """Return all pairs of names that touch at a configuration of pinocchio, sorted."""
        model = self.model.kinematics
        pinocchio.computeCollisions(model, self._data, self._geometry, self._geometry_data, configuration, False)
        pairs: set[LinkPair] = set()
        for pair, result in zip(self._geometry.collisionPairs, self._geometry_data.collisionResults, strict=True):
            if result.isCollision():
                pairs.add(ordered(self._names[pair.first], self._names[pair.second]))
        return tuple(sorted(pairs))

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


@dataclass(frozen=True, slots=True)
class Box:
    """A box that follows a link: an object in the gripper, or on a fixture.

    Attributes:
        link: the link that carries it.
        size: full edge lengths in meters.
        pose_in_link: pose of its center in the frame of the link.
    """

    name: str
    link: str
    size: Vector3
    pose_in_link: Pose


def broad_phase(model: RobotModel, geometry: PinGeometry, geometry_data: PinData) -> PinManager:
    """Return bounding boxes round all shapes: they leave only neighbors to be compared shape by shape."""
    few = len(geometry.geometryObjects) <= _FEW_SHAPES
    manager = (
        pinocchio.BroadPhaseManager_NaiveCollisionManager
        if few
        else pinocchio.BroadPhaseManager_DynamicAABBTreeCollisionManager
    )
    return manager(model.kinematics, geometry, geometry_data)


def with_boxes(model: RobotModel, boxes: Sequence[Box]) -> tuple[list[str], PinGeometry]:
    """Return a copy of the shapes with boxes added at the end, and the name of the link or box of each shape.

    Raises:
        ModelError: a box has the name of a link or of another box, or its link does not exist.
    """
    names, geometry = shape_links(model), model.geometry.copy()
    frames = model.kinematics.frames
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


def movable_pairs(geometry: PinGeometry, names: Sequence[str], disabled: Iterable[LinkPair]) -> npt.NDArray[np.bool_]:
    """Tell of each two shapes whether they are on different moving bodies and their names are no disabled pair.

    Returns:
        A symmetric array of shape (shapes, shapes).
    """
    bodies = np.array([shape.parentJoint for shape in geometry.geometryObjects], dtype=np.intp)
    checked: npt.NDArray[np.bool_] = bodies[:, np.newaxis] != bodies
    shapes: dict[str, list[int]] = {}
    for index, name in enumerate(names):
        shapes.setdefault(name, []).append(index)
    refused = [
        (here, there)
        for first, second in disabled
        for here in shapes.get(first, ())
        for there in shapes.get(second, ())
    ]
    if refused:
        rows, columns = zip(*refused, strict=True)
        checked[rows, columns] = checked[columns, rows] = False
    return checked


def shape_links(model: RobotModel) -> list[str]:
    """Name the link of each collision shape, in pinocchio's order of shapes."""
    frames = model.kinematics.frames
    return [str(frames[shape.parentFrame].name) for shape in model.geometry.geometryObjects]


def ordered(first: str, second: str) -> LinkPair:
    """Return two names as a pair, the lesser first."""
    return (first, second) if first <= second else (second, first)
