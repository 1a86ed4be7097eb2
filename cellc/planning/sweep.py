"""How far the shapes of a cell move when joints do: bounds that hold at every configuration."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from cellc.planning.limits import Array
from cellc.planning.mimic import Mimic
from cellc.planning.model import PinShape, RobotModel


def sweep_rates(model: RobotModel, joints: tuple[str, ...], shapes: Iterable[PinShape]) -> Array:
    """Bound how far any point of each shape moves by each joint, whatever the other joints do.

    The bound of several joints together is the sum of theirs, by the triangle inequality.

    Args:
        joints: the joints that move; those that mimic them move along.

    Returns:
        Metres for each rad or metre of a joint, shape (shapes, joints).
    """
    columns = {joint: column for column, joint in enumerate(joints)}
    factors = {mimic.joint: mimic for mimic in (*(Mimic(name, name, 1.0, 0.0) for name in joints), *model.mimics)}
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
    data = model.kinematics.createData()
    single = [joint for joint in range(1, model.kinematics.njoints) if model.kinematics.nvs[joint] == 1]
    vectors = {joint: np.asarray(data.joints[joint].S, dtype=np.float64).reshape(6) for joint in single}
    return {joint: (vector[:3], vector[3:]) for joint, vector in vectors.items()}


def _rates(
    model: RobotModel, shape: PinShape, subspaces: Mapping[int, tuple[Array, Array]]
) -> Iterator[tuple[int, float]]:
    """Yield each joint above a shape with the farthest that a unit of it moves a point.

    A ball holds the shape in the frame of its joint. Turned by the joint, the ball sweeps a ball round the axis, which
    is fixed in the frame above; pushed by it, a ball round the middle of its way.
    """
    shape.geometry.computeLocalAABB()
    centre = np.asarray(shape.placement.act(shape.geometry.aabb_center))
    radius, joint = float(shape.geometry.aabb_radius), int(shape.parentJoint)
    while joint != 0:
        if joint in subspaces:
            direction, axis = subspaces[joint]
            if axis.any():
                on_axis = (centre @ axis) * axis
                radius += float(np.linalg.norm(centre - on_axis))
                centre = on_axis
                yield joint, radius
            else:
                lower, upper = _range(model, joint)
                centre, radius = centre + (lower + upper) / 2.0 * direction, radius + (upper - lower) / 2.0
                yield joint, 1.0
        centre = np.asarray(model.kinematics.jointPlacements[joint].act(centre))
        joint = int(model.kinematics.parents[joint])


def _range(model: RobotModel, joint: int) -> tuple[float, float]:
    """Return the positions of a prismatic joint in metres; a follower goes where its leader's limits send it."""
    name = str(model.kinematics.names[joint])
    mimic = next((mimic for mimic in model.mimics if mimic.joint == name), Mimic(name, name, 1.0, 0.0))
    at = model.kinematics.idx_qs[model.kinematics.getJointId(mimic.leader)]
    lower, upper = model.kinematics.lowerPositionLimit[at], model.kinematics.upperPositionLimit[at]
    ends = (mimic.multiplier * float(lower) + mimic.offset, mimic.multiplier * float(upper) + mimic.offset)
    return min(ends), max(ends)
