"""The collision shapes of a scene: those of the cell, and boxes that follow links."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import coal
import numpy as np
import numpy.typing as npt
import pinocchio

from cellc.planning.failure import ModelError
from cellc.planning.model import PinGeometry, RobotModel, from_pose
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


def ordered(first: str, second: str) -> LinkPair:
    """Return two names as a pair, the lesser first."""
    return (first, second) if first <= second else (second, first)


def shape_links(model: RobotModel) -> list[str]:
    """Name the link of each collision shape, in pinocchio's order of shapes."""
    frames = model.kinematics.frames
    return [str(frames[shape.parentFrame].name) for shape in model.geometry.geometryObjects]


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
