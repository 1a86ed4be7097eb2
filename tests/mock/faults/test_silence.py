"""What stays away or comes late ends in a visible, bounded state: no caller is blocked for ever."""

from __future__ import annotations

from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from tests.mock.faults.conftest import DETECT, HOME, PICK, Rehearse, during, wait


def test_server_that_answers_no_goal_request_is_given_up_after_a_second(run: Rehearse) -> None:
    done = run(during(3, FaultKind.UNRESPONSIVE, "arm_trajectory", when="started", after_s=0.0))
    assert (done.failed.outcome, done.failed.fault_code) == ("timeout", "no answer from arm_trajectory within 1 s")
    assert done.failed.action_goal_id is not None
    assert "ACCEPTED" not in {point.step.name for point in done.failed.trace}


def test_planner_that_answers_nothing_is_given_up_after_a_second(run: Rehearse) -> None:
    failed = run(during(3, FaultKind.UNRESPONSIVE, "move_group", when="started", after_s=0.0)).failed
    assert (failed.outcome, failed.fault_code) == ("timeout", "no answer from move_group within 1 s")


def test_result_that_never_comes_is_given_up_when_the_action_times_out(run: Rehearse) -> None:
    # /move_action has a timeout of 90 s; the hold after it is bounded by 200 ms.
    done = run(during(3, FaultKind.UNRESPONSIVE, "arm_trajectory"))
    assert (done.failed.outcome, done.failed.fault_code) == ("timeout", "no result from arm_trajectory within 90 s")
    assert done.failed.cancel is not None
    assert done.failed.cancel.return_code is None
    assert (done.failed.ended_ns - done.failed.started_ns) / 1e9 < 90.5


def test_server_that_answers_again_is_asked_again(run: Rehearse) -> None:
    fault = during(2, FaultKind.UNRESPONSIVE, "arm_trajectory", when="started", after_s=0.0, lasting_s=0.5)
    assert run(fault, steps=(HOME, wait(1.0), DETECT, PICK)).result.outcome == "succeeded"


STALE: tuple[tuple[FaultKind, str, dict[str, Any], str], ...] = (
    (FaultKind.DELAY, "arm", {"delay_s": 0.3}, "joint state is"),
    (FaultKind.FREEZE, "arm", {}, "joint state is"),
    (FaultKind.MISMATCH_QOS, "/joint_states", {}, "joint state is"),
    (FaultKind.DELAY, "camera", {"delay_s": 0.3}, "newest observation of object is"),
    (FaultKind.FREEZE, "camera", {}, "newest observation of object is"),
    (FaultKind.CUT_NETWORK, "camera", {}, "newest observation of object is"),
    (FaultKind.MISMATCH_QOS, "/object_pose", {}, "newest observation of object is"),
    (FaultKind.MISMATCH_QOS, "/camera/color/image_raw", {}, "newest observation of object is"),
)


@pytest.mark.parametrize(("kind", "target", "parameters", "reason"), STALE)
def test_samples_that_are_late_or_stay_away_end_a_motion_in_stale_state(
    run: Rehearse, kind: FaultKind, target: str, parameters: dict[str, Any], reason: str
) -> None:
    done = run(during(3, kind, target, **parameters))
    assert (done.failed.step, done.failed.outcome) == ("move pick", "stale_state")
    assert done.failed.fault_code.startswith(reason)
    assert done.failed.cancel is not None
    assert done.failed.cancel.requested_ns - done.failed.started_ns < 1_000_000_000


@pytest.mark.parametrize(("kind", "target", "parameters", "reason"), STALE)
def test_stream_that_comes_back_in_time_is_borne(
    run: Rehearse, kind: FaultKind, target: str, parameters: dict[str, Any], reason: str
) -> None:
    # 20 ms of silence are less than the 100 ms of a joint state and the 200 ms of an observation, of which
    # up to 150 ms pass in the camera's and perception's pipeline.
    assert run(during(1, kind, target, when="started", after_s=0.0, lasting_s=0.02, **parameters)).result.passed


def test_endpoint_that_no_longer_matches_is_told_by_the_middleware(run: Rehearse) -> None:
    findings = run(during(3, FaultKind.MISMATCH_QOS, "/object_pose")).result.findings
    assert "`/object_pose` is no longer connected: incompatible QoS, policy reliability" in findings


def test_action_whose_endpoints_do_not_match_is_answered_by_nobody(run: Rehearse) -> None:
    fault = during(4, FaultKind.MISMATCH_QOS, "/gripper_action/gripper_cmd", when="started", after_s=0.0)
    assert run(fault).failed.fault_code == "no answer from gripper_action within 1 s"


def test_transforms_that_are_no_longer_received_end_in_tf_failure(run: Rehearse) -> None:
    failed = run(during(1, FaultKind.MISMATCH_QOS, "/tf", when="started", after_s=0.0)).failed
    assert (failed.outcome, "extrapolation into the future" in failed.fault_code) == ("tf_failure", True)
