"""The line that tells why a rehearsal failed names its step, and the first link of the chain without fresh data."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell, load
from cellc.mock.campaign.campaign import execute, make_plan
from cellc.mock.campaign.plan import CampaignRun
from cellc.mock.faults.registry import possible_faults
from cellc.mock.result import RehearsalResult
from tests.mock.conftest import Fault, LoadWith, fault

_STEP = re.compile(r"step (\d+) `([a-z]+)(?:: ([^`]+))?`: (.+)")
_NEVER_HERE = {AttemptOutcome.SUCCEEDED, AttemptOutcome.UNCOMMANDED_MOTION}
"""Nothing of this cell moves before it is commanded."""


@pytest.fixture(scope="session")
def failures(cell: MockCell) -> tuple[RehearsalResult, ...]:
    """The ends of two runs of the campaign with each kind of fault: the first one, and that in the middle."""
    plan, _ = make_plan(cell, possible_faults(cell.contract), 0)
    runs: dict[str, list[CampaignRun]] = {}
    for run in plan.singles():
        runs.setdefault(run.entry.faults[0].kind, []).append(run)
    ends = (execute(cell, run, 0) for each in runs.values() for run in (each[0], each[len(each) // 2]))
    return tuple(end.result for end in ends if end.result.outcome is not AttemptOutcome.SUCCEEDED)


def test_every_outcome_of_a_failure_is_met(failures: tuple[RehearsalResult, ...]) -> None:
    assert {result.outcome for result in failures} == set(AttemptOutcome) - _NEVER_HERE


def test_every_failure_names_the_step_that_failed_as_the_spec_writes_it(failures: tuple[RehearsalResult, ...]) -> None:
    for result in failures:
        told = _STEP.fullmatch(result.reason)
        assert told is not None, result.reason
        attempt = result.attempts[int(told[1]) - 1]
        assert " ".join(word for word in (told[2], told[3]) if word) == attempt.step
        assert told[4] == attempt.fault_code
        assert attempt.outcome == result.outcome


def test_every_stale_state_names_the_link_that_is_starved(
    cell: MockCell, failures: tuple[RehearsalResult, ...]
) -> None:
    controllers = {name for manager in cell.contract.managers.values() for name in manager.controllers}
    links = {*cell.contract.devices, *controllers, "perception"}
    stale = [result.reason for result in failures if result.outcome is AttemptOutcome.STALE_STATE]
    assert len(stale) >= 5
    for reason in stale:
        assert links & set(re.findall(r"`(\w+)`", reason.partition("; ")[2])), reason


CASES: list[tuple[Fault, str]] = [
    (fault("freeze", "camera", 0.0), "the newest image of `camera` is 0.200 s old"),
    (
        fault("mismatch_qos", "/camera/color/image_raw", 0.0),
        "no image from `camera` has reached `perception` for",
    ),
    (
        fault("jump_clock", "camera", 0.0, jump_s=-1.0),
        "`perception` rejected 2 of 7 images, oldest 1.033 s, queue of 1",
    ),
    (fault("mismatch_qos", "/object_pose", 0.0), "no pose from `perception` has reached `task` for 0.180 s"),
    (fault("jump_clock", "control_pc", 2.9, jump_s=1.0), "the clocks of `camera` and `task` are 1.000 s apart"),
    (fault("delay", "arm", 1.0, delay_s=0.3), "`joint_states` publishes, but nothing from the last 0.1"),
    (fault("reject", "joint_states", 1.0), "`joint_states` has published none for 0.1"),
    (fault("drop_frame", "object", 0.0), "the newest transform of `object` by `perception` is 0."),
    (fault("drop_frame", "arm_forearm_link", 0.02), "the newest transform of `arm_forearm_link` by `robot_state_pu"),
]


@pytest.mark.parametrize(("entry", "link"), CASES, ids=[f"{one['kind']} {one['target']}" for one, _ in CASES])
def test_the_first_link_without_fresh_data_is_named(load_with: LoadWith, entry: Fault, link: str) -> None:
    result = load_with(entry).run("faulty")
    assert link in result.reason


def test_a_queue_that_is_always_full_is_named(edit_contract: Callable[[Callable[[Any], None]], MockCell]) -> None:
    def deepen(contract: Any) -> None:
        (sink,) = contract["interfaces"]["/camera/color/image_raw"]["sinks"]
        sink["qos"]["depth"] = 10

    result = edit_contract(deepen).run("pick_and_place")
    # Thirty images come a second, ten are taken: each waits behind nine others, 0.3 s and more.
    told = "rejected (\\d+) of \\d+ images, oldest 0\\.3\\d+ s, queue of 10 at 30 Hz"
    assert re.fullmatch(f"step 2 `detect: object`: .*; `perception` {told}", result.reason)


@pytest.mark.parametrize("stated", ["reject_goal", "stop_and_hold", "ignore_sample"])
def test_a_reaction_that_is_played_as_another_one_is_stated(
    edit_contract: Callable[[Callable[[Any], None]], MockCell], stated: str
) -> None:
    def change(contract: Any) -> None:
        contract["interfaces"]["/object_pose"]["on_stale"] = stated
        (sink,) = contract["interfaces"]["/camera/color/image_raw"]["sinks"]
        sink["qos"]["depth"] = 10

    reason = edit_contract(change).run("pick_and_place").reason
    alike = f"`on_stale: {stated}` is played as `reject_goal`, your node may react in another way"
    assert reason.endswith(alike) == (stated != "reject_goal")


def test_a_bring_up_that_fails_names_its_stage(folder: Path) -> None:
    file = folder / "config/controllers.yaml"
    file.write_text(file.read_text().replace("- arm_elbow_joint", "- arm_elbw_joint", 1))
    assert load(folder, edited=True).run("pick_and_place").reason.startswith("bring-up, claim: ")
