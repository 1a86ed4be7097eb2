"""Clocks that jump, and frames that two nodes publish: whoever rests on them fails closed."""

from __future__ import annotations

import pytest

from cellc.contract.faults import FaultKind
from tests.mock.faults.conftest import DETECT, HOME, PICK, Rehearse, during, wait


@pytest.mark.parametrize("jump_s", [1.0, -1.0])
@pytest.mark.parametrize("clock", ["control_pc", "camera"])
def test_clock_that_jumps_away_from_the_others_ends_in_stale_state(run: Rehearse, clock: str, jump_s: float) -> None:
    # The camera stamps on its own clock, the task reads ages on that of the host: one of the two has jumped.
    failed = run(during(3, FaultKind.JUMP_CLOCK, clock, jump_s=jump_s)).failed
    assert (failed.step, failed.outcome) == ("move pick", "stale_state")


@pytest.mark.parametrize(
    ("jump_s", "age"), [(1.0, "newest observation of object is 1."), (-1.0, "object is stamped 0.863 s in the future")]
)
def test_reason_has_the_age_beyond_the_bound_or_the_time_in_the_future(run: Rehearse, jump_s: float, age: str) -> None:
    assert age in run(during(3, FaultKind.JUMP_CLOCK, "control_pc", jump_s=jump_s)).failed.fault_code


def test_jump_within_the_bound_of_an_observation_is_borne(run: Rehearse) -> None:
    assert run(during(3, FaultKind.JUMP_CLOCK, "control_pc", jump_s=0.001)).result.outcome == "succeeded"


def test_clock_that_jumps_back_again_lets_the_cell_go_on(run: Rehearse) -> None:
    fault = during(3, FaultKind.JUMP_CLOCK, "control_pc", jump_s=1.0, when="started", lasting_s=0.5)
    assert run(fault, steps=(HOME, DETECT, wait(2.0), DETECT, PICK)).result.outcome == "succeeded"


def test_frame_with_two_authorities_is_not_looked_up(run: Rehearse) -> None:
    done = run(during(3, FaultKind.DOUBLE_FRAME, "object", when="started", after_s=0.0))
    assert done.failed.outcome == "tf_failure"
    assert done.failed.fault_code == "frame object is published by perception and second_authority"
    assert "frame `object` has two authorities: `perception` and `second_authority`" in done.result.findings


def test_second_authority_that_comes_up_in_motion_stops_the_arm(run: Rehearse) -> None:
    failed = run(during(3, FaultKind.DOUBLE_FRAME, "object")).failed
    assert (failed.step, failed.outcome) == ("move pick", "tf_failure")
    assert failed.cancel is not None


def test_link_with_two_authorities_concerns_goals_that_are_looked_up_through_it(run: Rehearse) -> None:
    # The camera hangs on the arm, the fixture does not.
    doubled = "arm_forearm_link"
    assert run(during(1, FaultKind.DOUBLE_FRAME, doubled, when="started", after_s=0.0)).failed.step == "move pick"
    assert run(during(4, FaultKind.DOUBLE_FRAME, doubled, when="started", after_s=0.0)).result.outcome == "succeeded"


@pytest.mark.parametrize("frame", ["object", "arm_forearm_link"])  # of a perception, and of the robot's description
@pytest.mark.parametrize(("lasting_s", "outcome"), [(0.5, "succeeded"), (None, "tf_failure")])
def test_frame_that_is_published_again_lets_the_cell_go_on(
    run: Rehearse, frame: str, lasting_s: float | None, outcome: str
) -> None:
    fault = during(3, FaultKind.DROP_FRAME, frame, when="started", after_s=0.0, lasting_s=lasting_s)
    assert run(fault, steps=(HOME, DETECT, wait(2.0), DETECT, PICK)).result.outcome == outcome
