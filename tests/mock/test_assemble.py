"""Endpoints that do not match carry nothing: the cell ends in a named outcome and says who does not hear whom."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cellc.mock import MockCell
from cellc.mock.result import RehearsalResult

Edit = Callable[[Callable[[Any], None]], MockCell]


def with_best_effort(edit: Edit, topic: str, source: str) -> RehearsalResult:
    """Let a source offer best effort and every sink of the topic request reliable."""

    def change(contract: Any) -> None:
        interface = contract["interfaces"][topic]
        for end in interface["sources"]:
            end["qos"]["reliability"] = "best_effort" if end["node"] == source else "reliable"
        for end in interface["sinks"]:
            end["qos"]["reliability"] = "reliable"

    return edit(change).run("pick_and_place")


def test_object_pose_that_does_not_reach_the_task_ends_in_stale_state(edit_contract: Edit) -> None:
    result = with_best_effort(edit_contract, "/object_pose", "perception")
    assert result.outcome == "stale_state"
    assert result.attempts[-2].fault_code == (
        "no observation of object has arrived; no pose from `perception` has reached `task`"
    )
    assert result.findings == (
        "`/object_pose` from `perception` to `task` is not connected: "
        "reliability: offered best_effort, requested reliable",
    )


def test_images_that_do_not_reach_perception_end_in_stale_state(edit_contract: Edit) -> None:
    topic = "/camera/color/image_raw"
    result = with_best_effort(edit_contract, topic, "camera")
    assert result.outcome == "stale_state"


def test_transforms_of_perception_that_do_not_reach_the_task_end_in_tf_failure(edit_contract: Edit) -> None:
    result = with_best_effort(edit_contract, "/tf", "perception")
    assert result.outcome == "tf_failure"
    assert result.attempts[-2].fault_code.startswith('"object" passed to lookupTransform')


def test_joint_states_that_reach_nobody_keep_the_cell_from_coming_up(edit_contract: Edit) -> None:
    result = with_best_effort(edit_contract, "/joint_states", "joint_states")
    assert result.outcome == "bringup_failure"
    assert "frame `arm_shoulder_link`" in result.bringup[-1].problems[0]
