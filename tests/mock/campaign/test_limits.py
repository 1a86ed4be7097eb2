"""Limits are judged by samples whose derivatives are known by hand."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from cellc.contract.contract import Contract
from cellc.mock import MockCell
from cellc.mock.campaign.limits import LimitsReport, check_limits
from cellc.mock.control.journal import Cause, CommandSamples, Interruption

PERIOD_NS = 2_000_000
ARM, ELBOW = "arm_trajectory", "arm_elbow_joint"
GRIPPER, KNUCKLE = "gripper_action", "gripper_robotiq_85_left_knuckle_joint"
# Limits of the elbow in cells/ur5e_pick: half of pi rad/s, 2.5 rad/s2 and 50 rad/s3 within +-pi.
VELOCITY, ACCELERATION, JERK = np.pi / 2, 2.5, 50.0


@pytest.fixture
def contract(cells: dict[str, MockCell]) -> Contract:
    return cells["ur5e_pick"].contract


def seconds(count: int) -> NDArray[np.float64]:
    return np.arange(count) * PERIOD_NS / 1e9


def judged(
    contract: Contract,
    positions: NDArray[np.float64],
    *interruptions: Interruption,
    controller: str = ARM,
    joint: str = ELBOW,
    stamps_ns: NDArray[np.int64] | None = None,
) -> LimitsReport:
    stamps = np.arange(len(positions), dtype=np.int64) * PERIOD_NS if stamps_ns is None else stamps_ns
    samples = CommandSamples(controller, (f"{joint}/position",), stamps, positions[:, None])
    return check_limits(contract, (samples,), interruptions)


def exceeded(report: LimitsReport) -> list[tuple[str, str]]:
    return [(excess.joint, excess.quantity) for excess in report.excesses]


# x = J t^3 / 6 has the jerk J everywhere; x = A t^2 / 2 the acceleration A; x = V t the velocity V. Factors below and
# above 1 stand a thousandth from the limit: rounding alone is allowed for.
@pytest.mark.parametrize(
    ("quantity", "limit", "order", "count"),
    [("velocity", VELOCITY, 1, 500), ("acceleration", ACCELERATION, 2, 250), ("jerk", JERK, 3, 20)],
)
def test_motion_just_inside_a_limit_is_held_and_just_outside_is_not(
    contract: Contract, quantity: str, limit: float, order: int, count: int
) -> None:
    factorial = (1, 1, 2, 6)[order]
    shape = limit * seconds(count) ** order / factorial
    inside = judged(contract, 0.999 * shape)
    assert inside.held
    assert {peak.quantity: peak.share for peak in inside.peaks}[quantity] == pytest.approx(0.999, abs=1e-4)
    outside = judged(contract, 1.001 * shape)
    assert exceeded(outside) == [(ELBOW, quantity)]
    excess = outside.excesses[0]
    assert excess.value == pytest.approx(1.001 * limit, rel=1e-4)
    assert excess.limit == pytest.approx(limit)


def test_excess_is_told_with_its_joint_time_value_and_limit(contract: Contract) -> None:
    positions = np.zeros(100)
    positions[60:] = 3.2  # beyond pi, from 0.120 s on
    report = judged(contract, positions, Interruption(60 * PERIOD_NS, 60 * PERIOD_NS, ARM, Cause.REPLACED))
    assert [str(excess) for excess in report.excesses] == [
        f"`{ARM}` commanded joint `{ELBOW}` to position 3.2 at 0.120 s; its limit is 3.14159"
    ]


def test_hold_of_a_position_measured_outside_is_told_and_moves_nothing(contract: Contract) -> None:
    positions = np.zeros(100)
    positions[40:70] = 3.2
    hold = Interruption(40 * PERIOD_NS, 40 * PERIOD_NS, ARM, Cause.HOLD)
    report = judged(contract, positions, hold, Interruption(70 * PERIOD_NS, 70 * PERIOD_NS, ARM, Cause.HOLD))
    assert report.held
    assert [(held.quantity, held.value, held.stamp_ns) for held in report.held_outside] == [
        ("position", 3.2, 40 * PERIOD_NS)
    ]
    positions[69] = 3.3  # the command moves on outside
    assert exceeded(judged(contract, positions, hold))[0] == (ELBOW, "position")


@pytest.mark.parametrize("row", [1, 50, 98])
def test_step_is_an_excess_where_nothing_interrupted_and_is_told_where_a_hold_did(contract: Contract, row: int) -> None:
    positions = np.zeros(100)
    positions[row:] = -0.003  # 1.5 rad/s for one cycle, 750 rad/s2
    assert exceeded(judged(contract, positions)) == [(ELBOW, "acceleration"), (ELBOW, "jerk")]
    held = judged(contract, positions, Interruption(row * PERIOD_NS, row * PERIOD_NS, ARM, Cause.HOLD))
    assert held.held
    assert [(step.cause, step.joint, step.step) for step in held.steps] == [("hold", ELBOW, -0.003)]


def test_interruption_of_one_instant_excuses_nothing_before_or_after_it(contract: Contract) -> None:
    for row in (47, 53):
        positions = np.zeros(100)
        positions[row:] = 0.003
        report = judged(contract, positions, Interruption(50 * PERIOD_NS, 50 * PERIOD_NS, ARM, Cause.HOLD))
        assert not report.held


def test_interruption_of_another_controller_excuses_nothing(contract: Contract) -> None:
    positions = np.zeros(100)
    positions[50:] = 0.003
    assert not judged(contract, positions, Interruption(50 * PERIOD_NS, 50 * PERIOD_NS, GRIPPER, Cause.HOLD)).held


def test_missed_cycles_do_not_make_a_smooth_motion_exceed_its_limits(contract: Contract) -> None:
    kept = np.array([row for row in range(200) if row not in range(80, 91)])
    positions = 0.999 * ACCELERATION * seconds(200) ** 2 / 2
    assert judged(contract, positions[kept], stamps_ns=kept * PERIOD_NS).held


def test_set_points_of_a_gripper_are_held_to_their_position_alone(contract: Contract) -> None:
    stroke = np.zeros(100)
    stroke[50:] = 0.79
    report = judged(contract, stroke, controller=GRIPPER, joint=KNUCKLE)
    assert report.held
    assert report.unchecked == tuple(f"{KNUCKLE}/{quantity}" for quantity in ("acceleration", "jerk", "velocity"))
    stroke[50:] = 0.81  # closed is 0.8
    assert exceeded(judged(contract, stroke, controller=GRIPPER, joint=KNUCKLE)) == [(KNUCKLE, "position")]


def test_command_that_was_never_given_exceeds_nothing(contract: Contract) -> None:
    positions = np.zeros(50)
    positions[:10] = np.nan
    assert judged(contract, positions).held


def test_effort_commands_are_told_as_unchecked(contract: Contract) -> None:
    stamps = np.arange(5, dtype=np.int64) * PERIOD_NS
    samples = CommandSamples(ARM, (f"{ELBOW}/effort",), stamps, np.full((5, 1), 1e6))
    report = check_limits(contract, (samples,), ())
    assert report.held
    assert report.unchecked == (f"{ELBOW}/effort",)


def test_start_beside_the_command_may_be_outside_and_rough_up_to_the_first_point_of_the_plan(
    contract: Contract,
) -> None:
    first = 20 * PERIOD_NS
    positions = np.full(100, np.pi + 1e-4)
    positions[:20] = np.pi - 1e-3  # the joint sank over its limit from where it is commanded
    positions[30:] = np.pi - 2e-3
    rough = judged(contract, positions, Interruption(first, 30 * PERIOD_NS, ARM, Cause.OFF_COMMAND))
    assert rough.held
    assert [held.quantity for held in rough.held_outside] == ["position"]
    # A plan that goes on outside, or is rough after its first point, is in excess.
    positions[30:] = np.pi + 1e-4
    assert exceeded(judged(contract, positions, Interruption(first, 25 * PERIOD_NS, ARM, Cause.OFF_COMMAND)))
    positions[20:], positions[40:] = np.pi - 1e-3, np.pi - 0.1
    late = judged(contract, positions, Interruption(first, 30 * PERIOD_NS, ARM, Cause.OFF_COMMAND))
    assert {quantity for _, quantity in exceeded(late)} == {"velocity", "acceleration", "jerk"}
