"""The points of a trajectory in the order of the controller's joints: what is not named stays, at rest."""

from __future__ import annotations

import pytest

from cellc.mock.control.controllers.joint_trajectory.acceptance import in_local_order
from cellc.mock.control.messages import Trajectory, TrajectoryPoint

Numbers = tuple[float, ...]


def _point(positions: Numbers, velocities: Numbers = (), accelerations: Numbers = ()) -> TrajectoryPoint:
    return TrajectoryPoint(
        time_from_start_ns=1, positions=positions, velocities=velocities, accelerations=accelerations
    )


@pytest.mark.parametrize(
    ("names", "sent", "ordered"),
    [
        (("a", "b", "c"), _point((1.0, 2.0, 3.0)), _point((1.0, 2.0, 3.0))),
        (("c", "a", "b"), _point((3.0, 1.0, 2.0), (0.3, 0.1, 0.2)), _point((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))),
        (("c",), _point((3.0,), (0.3,), (9.0,)), _point((10.0, 20.0, 3.0), (0.0, 0.0, 0.3), (0.0, 0.0, 9.0))),
        (("c", "b"), _point((3.0, 2.0)), _point((10.0, 2.0, 3.0))),
        (("b",), _point((), (0.2,)), _point((), (0.0, 0.2, 0.0))),
        # Named twice: the last value counts, and the place that no name is for is zero.
        (("a", "a", "b"), _point((5.0, 1.0, 2.0)), _point((1.0, 2.0, 0.0))),
    ],
)
def test_points_are_in_the_order_of_the_controller(
    names: tuple[str, ...], sent: TrajectoryPoint, ordered: TrajectoryPoint
) -> None:
    trajectory = Trajectory(joint_names=names, points=(sent,), stamp_ns=0)
    assert in_local_order(trajectory, ("a", "b", "c"), (10.0, 20.0, 30.0)) == ((ordered,), "")


def test_more_names_than_joints_are_left_as_they_are() -> None:
    point = _point((1.0, 2.0))
    points, warning = in_local_order(Trajectory(joint_names=("a", "a"), points=(point,), stamp_ns=0), ("a",), (0.0,))
    assert (points, warning) == ((point,), "Invalid input size (2) for sorting")
