"""Joints that do not do what they are told, and a robot that scales its speed."""

from __future__ import annotations

from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from cellc.mock import MockCell
from cellc.mock.faults.registry import possible_faults
from tests.mock.faults.conftest import Rehearse, during

PAN = "arm_shoulder_pan_joint"
FINGER = "gripper_robotiq_85_left_knuckle_joint"


@pytest.mark.parametrize(
    ("kind", "parameters"),
    [("stick", {}), ("slow", {"velocity": 0.01}), ("displace", {"displacement": 0.25})],
)
def test_joint_off_its_track_violates_the_path_tolerance(
    run: Rehearse, kind: FaultKind, parameters: dict[str, Any]
) -> None:
    failed = run(during(3, kind, PAN, **parameters)).failed
    assert failed.outcome == "tolerance_violation"
    assert failed.result is not None
    # The table of facts, row "path tolerance exceeded".
    assert (failed.result.error_code, failed.result.error_string) == (-4, "Aborted due to path tolerance violation")


def test_joint_that_lags_less_than_the_tolerance_is_borne(run: Rehearse, cell: MockCell) -> None:
    fault = during(3, FaultKind.SLOW, PAN, velocity=0.95 * cell.contract.joint_limits[PAN].velocity)
    assert run(fault).result.outcome == "succeeded"


def test_displacement_below_the_tolerances_is_borne(run: Rehearse) -> None:
    # path_tolerance 0.2 rad, goal_tolerance 0.01 rad
    assert run(during(3, FaultKind.DISPLACE, PAN, displacement=0.009)).result.outcome == "succeeded"


def test_displacement_beyond_the_goal_tolerance_alone_is_seen_at_the_goal(run: Rehearse) -> None:
    failed = run(during(3, FaultKind.DISPLACE, PAN, displacement=0.1)).failed
    assert failed.result is not None
    assert failed.result.error_code == -5


def test_displaced_joint_stands_beside_its_command(run: Rehearse) -> None:
    done = run(during(7, FaultKind.DISPLACE, PAN, displacement=0.009, when="started"))
    manager = done.plant.control.managers["control"]
    assert manager.state(f"{PAN}/position") - manager.command(f"{PAN}/position") == pytest.approx(0.009, abs=1e-12)


def test_finger_that_is_slow_is_given_up_at_the_bound_of_the_grip(run: Rehearse) -> None:
    done = run(during(4, FaultKind.SLOW, FINGER, velocity=0.005, when="started", after_s=0.0))
    assert done.failed.outcome == "timeout"
    assert done.result.response_s is not None
    assert done.result.response_s == pytest.approx(10.0, abs=0.3)


def test_speed_scaled_to_zero_neither_progresses_nor_aborts_and_the_client_bounds_it(run: Rehearse) -> None:
    done = run(during(3, FaultKind.SCALE_SPEED, "arm", factor=0.0))
    assert (done.failed.outcome, done.failed.fault_code) == ("timeout", "no result from arm_trajectory within 90 s")
    paused_ns = done.failed.started_ns + 2_000_000_000
    assert done.travel(paused_ns, done.failed.ended_ns) < 1e-9
    assert done.failed.result is not None
    assert done.failed.result.status == "canceled"


def test_goal_goes_on_where_it_paused_when_the_speed_comes_back(run: Rehearse) -> None:
    plain = run().attempt(3)
    done = run(during(3, FaultKind.SCALE_SPEED, "arm", factor=0.0, lasting_s=2.0))
    paused = done.attempt(3)
    assert done.result.outcome == "succeeded"
    longer_s = (paused.ended_ns - paused.started_ns - plain.ended_ns + plain.started_ns) / 1e9
    assert longer_s == pytest.approx(2.0, abs=0.051)  # a result comes with a tick of the monitor, each 50 ms


def test_half_the_speed_takes_twice_as_long_from_there(run: Rehearse) -> None:
    plain = run().attempt(3)
    half = run(during(3, FaultKind.SCALE_SPEED, "arm", factor=0.5, after_s=0.0)).attempt(3)
    motion_s = (plain.ended_ns - plain.started_ns) / 1e9 - 0.05  # planning
    longer_s = (half.ended_ns - half.started_ns - plain.ended_ns + plain.started_ns) / 1e9
    assert longer_s == pytest.approx(motion_s, abs=0.2)


def test_record_says_what_the_speed_was_scaled_to(run: Rehearse) -> None:
    done = run(during(2, FaultKind.SCALE_SPEED, "arm", factor=0.25, when="started", after_s=0.0))
    assert [done.attempt(number).speed_scaling for number in (1, 3)] == [1.0, 0.25]


@pytest.mark.parametrize(
    ("kind", "changed", "expected"),
    [
        # A tenth of the range, and at most 0.5 rad; so much also where no range is known.
        (FaultKind.DISPLACE, {"lower": 0.0, "upper": 1.0}, 0.1),
        (FaultKind.DISPLACE, {"lower": -2.0, "upper": 1.0}, 0.3),
        (FaultKind.DISPLACE, {"lower": -3.0, "upper": 3.0}, 0.5),
        (FaultKind.DISPLACE, {"lower": None, "upper": 1.0}, 0.5),
        (FaultKind.DISPLACE, {"lower": 0.0, "upper": None}, 0.5),
        (FaultKind.DISPLACE, None, 0.5),
        # A hundredth of the limit, and 0.01 rad/s where there is none.
        (FaultKind.SLOW, {"velocity": 2.5}, 0.025),
        (FaultKind.SLOW, None, 0.01),
    ],
)
def test_cases_disturb_a_joint_by_a_share_of_its_limits(
    cell: MockCell, kind: FaultKind, changed: dict[str, float | None] | None, expected: float
) -> None:
    contract = cell.contract
    limits = {
        joint: limit.model_copy(update=changed or {})
        for joint, limit in contract.joint_limits.items()
        if changed is not None
    }
    cases = possible_faults(contract.model_copy(update={"joint_limits": limits}))
    entries = [case.entry for case in cases if case.entry.kind == kind]
    found = [entry.displacement if kind is FaultKind.DISPLACE else entry.velocity for entry in entries]
    assert found
    assert found == pytest.approx([expected] * len(found))
