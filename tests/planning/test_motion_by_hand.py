"""Durations, curves and bounds of motion, worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cellc.contract.transforms import Pose
from cellc.robot.planning.cartesian import _extrapolated, _step_count
from cellc.robot.planning.motion_law import fastest_bounds, jerk_changes, rest_to_rest, rest_to_rest_durations
from cellc.robot.planning.problem import JointLimits
from cellc.robot.planning.splines import SectionCurve


@pytest.mark.parametrize(
    ("bounds", "duration_s"),
    [
        # Full speed after a/j + v/a = 0.25 + 0.5 s. Each ramp covers 0.75/2, and 0.25 is left at 1/s.
        ((1.0, 2.0, 8.0), 1.75),
        # After 1/6 + 1/3 s; each ramp covers 0.25, half is left. Then after 0.25 + 0.5 s, and 0.625 is left at 0.5/s.
        ((1.0, 3.0, 18.0), 1.5),
        ((0.5, 1.0, 4.0), 2.75),
        # The acceleration reaches sqrt(v j) = 4 of 10. Each ramp takes 2 sqrt(v/j) = 0.5 s and covers 0.25.
        ((1.0, 10.0, 16.0), 1.5),
        # Never at full speed: half the time h has (h - a/j) h a = 1, and (1.5 - 0.5) * 1.5 * 2/3 = 1.
        ((10.0, 2.0 / 3.0, 4.0 / 3.0), 3.0),
        ((10.0, 1.0, 12.0 / 7.0), 8.0 / 3.0),  # (4/3 - 7/12) * 4/3 = 1
        ((1.5, 2.0, 2.0 / (0.95 - 1.0 / 1.9)), 1.9),  # (0.95 - a/j) * 0.95 * 2 = 1; full speed would take 1.76 of 1
        # Neither speed nor acceleration is full: four phases of t with 2 j t^3 = 1, and j t is less than a.
        ((10.0, 10.0, 4.0), 2.0),
        ((10.0, 1.0, 32.0 / 27.0), 3.0),
        ((10.0, 2.0, 0.5 / 0.52**3), 2.08),
    ],
)
def test_motion_from_rest_to_rest_takes(bounds: tuple[float, float, float], duration_s: float) -> None:
    assert rest_to_rest_durations(np.array([bounds])) == pytest.approx([duration_s])
    assert rest_to_rest(bounds).duration == pytest.approx(duration_s)


def test_jerk_changes_at_the_ends_of_the_phases() -> None:
    # Ramp of 0.25 s, 0.25 s of full acceleration, ramp of 0.25 s, 0.25 s of full speed, and the same back.
    assert jerk_changes(rest_to_rest((1.0, 2.0, 8.0))) == pytest.approx(
        [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75], abs=1e-9
    )


@pytest.mark.parametrize(
    ("samples", "at", "expected"),
    [
        ([0.0, 2.0], 0.25, (0.5, 2.0, 0.0, 0.0)),  # 2u
        ([u * u for u in (0.0, 0.5, 1.0)], 0.25, (0.0625, 0.5, 2.0, 0.0)),  # u^2: value, 2u, 2, 0
        ([u**3 - u for u in (0.0, 0.25, 0.5, 0.75, 1.0)], 0.6, (-0.384, 0.08, 3.6, 6.0)),  # u^3 - u: 3u^2 - 1, 6u, 6
        ([u**3 for u in (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)], 0.5, (0.125, 0.75, 3.0, 6.0)),
    ],
)
def test_curve_of_a_cubic_is_that_cubic(samples: list[float], at: float, expected: tuple[float, ...]) -> None:
    found = SectionCurve([(value,) for value in samples]).derivatives(np.array([at]))
    assert [float(one[0, 0]) for one in found] == pytest.approx(expected, abs=1e-9)


def test_straight_line_is_as_fast_as_its_slowest_joint() -> None:
    limits = JointLimits(("a", "b"), (-9.0, -9.0), (9.0, 9.0), (1.0, 0.1), (2.0, 1.6), (4.0, 2.4))
    # Ways of 2 and 0.5: speed min(1/2, 0.1/0.5), acceleration min(2/2, 1.6/0.5), jerk min(4/2, 2.4/0.5).
    assert fastest_bounds(SectionCurve([(0.0, 0.0), (2.0, -0.5)]), limits) == pytest.approx((0.2, 1.0, 2.0))


def test_bounds_on_a_curve_leave_room_for_what_its_bends_cost() -> None:
    limits = JointLimits(("a",), (-9.0,), (9.0,), (1.0,), (1.0,), (8.0,))
    speed, acceleration, jerk = fastest_bounds(SectionCurve([(0.0,), (0.25,), (1.0,)]), limits)  # u^2: slope 2, bend 2
    # q's'' + q''s'^2 <= 1 and q's''' + 3q''s's'' <= 8, with the acceleration or a share of it.
    room = (1.0 - 2.0 * speed**2) / 2.0
    assert any(acceleration == pytest.approx(share * room) for share in (1.0, 0.5, 0.25))
    assert jerk == pytest.approx((8.0 - 3.0 * 2.0 * speed * acceleration) / 2.0)


@pytest.mark.parametrize(
    ("joints", "followed", "guess"),
    [
        (6, [5.0], 5.0),
        (6, [1.0, 3.0], 5.0),  # the straight line
        (6, [0.0, 1.0, 4.0], 9.0),  # squares
        (6, [0.0, 1.0, 8.0, 27.0], 64.0),  # cubes
        (6, [9.0, 0.0, 1.0, 8.0, 27.0], 64.0),  # the last four alone
        (7, [0.0, 1.0, 8.0, 27.0], 46.0),  # a redundant arm: straight on from 8 over 27
    ],
)
def test_next_waypoint_of_a_line_is_looked_for_on_the_curve_of_those_before(
    joints: int, followed: list[float], guess: float
) -> None:
    assert _extrapolated([np.full(joints, value) for value in followed]) == pytest.approx([guess] * joints)


@pytest.mark.parametrize(
    ("way_m", "turn_rad", "steps"),
    [
        (0.0, 0.0, 2),
        (0.004, 0.0, 2),
        (0.1, 0.0, 20),
        (0.1001, 0.0, 21),
        (0.0, 1.0, 20),
        (0.0, 1.001, 21),
        (0.1, 1.2, 24),
    ],
)
def test_steps_of_a_line_are_5_mm_or_50_mrad(way_m: float, turn_rad: float, steps: int) -> None:
    start = Pose((0.3, 0.1, 0.2), (0.0, 0.0, 0.0, 1.0))
    goal = Pose((0.3, 0.1, 0.2 - way_m), (math.sin(turn_rad / 2), 0.0, 0.0, math.cos(turn_rad / 2)))
    assert _step_count(start, goal) == steps
