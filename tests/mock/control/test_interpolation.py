"""The controller's reference follows the polynomials that the points imply, computed here in another way."""

from __future__ import annotations

import random

import numpy as np
import pytest
from numpy.typing import NDArray

from cellc.mock.control import ControllerManager, TrajectoryGoal, TrajectoryPoint

from .arm_of_two import S, parameters, run, started, urdf

Array = NDArray[np.float64]


def _polynomial(duration_s: float, start: Array, end: Array) -> Array:
    """Coefficients, lowest first, from the values of the derivatives at both ends: a linear system, solved."""
    count = len(start)
    system, values = np.zeros((2 * count, 2 * count)), np.concatenate([start, end])
    for order in range(count):
        for power in range(order, 2 * count):
            factor = float(np.prod(np.arange(power - order + 1, power + 1)))
            system[order, power] = factor if power == order else 0.0
            system[count + order, power] = factor * duration_s ** (power - order)
    return np.linalg.solve(system, values)


def _points(chance: random.Random, kinds: int) -> list[tuple[float, Array]]:
    """Times and, per joint, values of position and of as many derivatives as `kinds` tells."""
    time_s, points = 0.0, []
    for index in range(5):
        time_s += chance.randint(100, 400) / 1000
        values = np.array([[chance.uniform(-0.2, 0.2) for _ in range(kinds)] for _ in range(2)])
        if index == 4:
            values[:, 1:] = 0.0
        points.append((time_s, values))
    return points


def _point(time_s: float, values: Array) -> TrajectoryPoint:
    columns = [tuple(column) for column in values.T.tolist()] + [(), ()]
    return TrajectoryPoint(columns[0], columns[1], columns[2], time_from_start_ns=round(time_s * S))


@pytest.mark.parametrize("kinds", [1, 2, 3])
@pytest.mark.parametrize("seed", range(5))
def test_reference_is_the_polynomial_through_the_points(kinds: int, seed: int) -> None:
    points = _points(random.Random(f"{kinds}/{seed}"), kinds)
    manager = started(ControllerManager(urdf(), parameters().replace("trajectory: 0.2", "trajectory: 0.0")))
    manager.record("arm", 500.0)
    sent = tuple(_point(time_s, values) for time_s, values in points)
    begin_ns = manager.now_ns + manager.period_ns
    assert manager.send_goal("arm", TrajectoryGoal(("a", "b"), sent)).accepted
    run(manager, 3 * S)
    recording = manager.recording("arm")
    before_s, before = 0.0, np.zeros((2, kinds))
    for time_s, values in points:
        since = (recording.stamps_ns - begin_ns) / S
        inside = (since >= before_s) & (since < time_s - 0.003)
        assert inside.any()
        for joint in range(2):
            polynomial = np.polynomial.Polynomial(_polynomial(time_s - before_s, before[joint], values[joint]))
            expected = polynomial(since[inside] - before_s)
            np.testing.assert_allclose(recording.desired[inside, joint], expected, atol=1e-9, rtol=0)
        before_s, before = time_s, values
