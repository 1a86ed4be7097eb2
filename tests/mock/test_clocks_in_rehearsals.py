"""Clocks that are off, that jump, and that follow a recording, in rehearsals of the real cell.

One host runs all nodes, and the camera stamps on a clock of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import pytest

from cellc.contract.contract import ContractClock
from cellc.mock import MockCell, RehearsalResult
from cellc.mock.clocks import clock_from
from cellc.mock.plant import Plant
from cellc.mock.tf.buffer import Transform
from cellc.mock.tf.messages import TfFailure

SECOND = 1_000_000_000
WATCHED_S = 0.52
"""End of the bring-up, when the buffers hold half a second."""

Action = Callable[[Plant], None]


def rehearse(cell: MockCell, actions: Mapping[float, Action]) -> tuple[RehearsalResult, Plant]:
    """Run pick_and_place; each action happens at its time in seconds, 0 is before anything runs."""
    plants: list[Plant] = []

    def watch(plant: Plant) -> None:
        plants.append(plant)
        for at_s, action in actions.items():
            if at_s == 0.0:
                action(plant)
            else:
                plant.simulation.at(round(at_s * 1e9), partial(action, plant))

    return cell.rehearse(cell.entry("pick_and_place"), watch=watch), plants[0]


def set_clock(name: str, **figures: Any) -> Action:
    """Return an action that lets a clock be off from the beginning."""

    def apply(plant: Plant) -> None:
        clock = clock_from(name, ContractClock(domain=name, **figures))
        plant.clocks.select(name)[0].restart(clock.read(0), 1.0 + figures.get("drift", 0.0), 0)

    return apply


def jump(name: str, seconds: float) -> Action:
    """Return an action that sets a clock."""
    return lambda plant: plant.clocks.jump(name, round(seconds * 1e9))


def test_images_and_transforms_carry_the_time_of_the_camera(cell: MockCell) -> None:
    _, exact = rehearse(cell, {})
    _, off = rehearse(cell, {0.0: set_clock("camera", offset_s=0.002)})
    ours, theirs = (plant.cameras["camera"].last for plant in (off, exact))
    assert ours is not None
    assert theirs is not None
    assert (ours.stamp_ns - ours.taken_ns, theirs.stamp_ns - theirs.taken_ns) == (2_000_000, 0)


def test_small_offset_of_the_camera_is_borne(cell: MockCell) -> None:
    result, _ = rehearse(cell, {0.0: set_clock("camera", offset_s=0.002)})
    assert result.outcome == "succeeded"


@pytest.mark.parametrize("offset_s", [-0.15, 0.15])
def test_camera_that_is_off_by_more_than_an_image_may_be_old_is_never_used(cell: MockCell, offset_s: float) -> None:
    # Images may be 0.1 s old; behind, they look older than they are, and ahead they come from the future.
    result, plant = rehearse(cell, {0.0: set_clock("camera", offset_s=offset_s)})
    assert result.outcome == "stale_state"
    assert plant.perceptions["object"].rejected > 0


def test_ages_grow_by_what_the_camera_is_behind(cell: MockCell) -> None:
    def ages(actions: Mapping[float, Action]) -> list[float]:
        attempts = rehearse(cell, actions)[0].attempts
        return [each.tf_lookup_age for each in attempts if each.step == "move pick" and each.tf_lookup_age is not None]

    (exact,) = ages({})
    (behind,) = ages({0.0: set_clock("camera", offset_s=-0.03)})
    assert behind == pytest.approx(exact + 0.03, abs=1e-6)


def test_jump_of_the_host_while_a_goal_rests_on_an_observation_stops_it(cell: MockCell) -> None:
    # The arm approaches the part from about 1 s on; 5 s ahead the newest observation is 5 s old, 0.2 s are allowed.
    result, _ = rehearse(cell, {1.5: jump("control_pc", 5.0)})
    assert result.outcome == "stale_state"
    assert result.attempts[-2].cancel is not None
    assert result.attempts[-2].cancel.held_ns is not None


def test_jump_back_leaves_stamps_in_the_future_which_are_not_acted_on(cell: MockCell) -> None:
    result, _ = rehearse(cell, {1.5: jump("control_pc", -5.0)})
    assert result.outcome == "stale_state"


def look_up(plant: Plant) -> Transform | TfFailure:
    """Look the tool up at the latest time."""
    plant.robot_state_publisher.catch_up(plant.now_ns)
    return plant.task.buffer.lookup("world", "arm_tool0", 0)


def test_step_back_of_the_system_clock_is_not_noticed_by_tf2(cell: MockCell) -> None:
    # rcl calls back for time from /clock alone: the old transforms stay, two seconds in the future.
    found: list[Transform | TfFailure] = []
    _, plant = rehearse(
        cell,
        {
            WATCHED_S + 0.001: jump("control_pc", -0.4),
            WATCHED_S + 0.2: lambda plant: found.append(look_up(plant)),
        },
    )
    (latest,) = found
    assert isinstance(latest, Transform)
    assert latest.stamp_ns > plant.clocks.of("task").read(round((WATCHED_S + 0.2) * 1e9))
    assert not any("Clearing" in line for line in plant.task.buffer.warnings.lines())


def test_transforms_after_a_long_step_back_are_refused_as_old_data(cell: MockCell) -> None:
    result, _ = rehearse(cell, {WATCHED_S + 0.001: jump("control_pc", -60.0)})
    assert result.outcome != "succeeded"
    assert any(finding.startswith("TF_OLD_DATA ignoring data from the past") for finding in result.findings)


def test_recording_clears_the_buffer_and_lets_everybody_live_in_its_time(cell: MockCell) -> None:
    start_ns = 1_000_000 * SECOND
    result, plant = rehearse(cell, {0.6: lambda plant: plant.clocks.replay(start_ns)})
    assert "Detected time source change. Clearing TF buffer." in result.findings
    assert plant.clocks.now_ns("task") - start_ns == plant.now_ns - round(0.6 * 1e9)


def test_recording_that_begins_anew_clears_the_buffer_again(cell: MockCell) -> None:
    def play(plant: Plant) -> None:
        plant.clocks.replay(1000 * SECOND)

    result, _ = rehearse(cell, {0.05: play, 0.6: play})
    assert any(finding.startswith("Detected jump back in time. Clearing TF buffer.") for finding in result.findings)


def test_recorded_camera_without_the_clock_of_the_recording_is_stale_for_ever(cell: MockCell) -> None:
    # The bag of yesterday is played, and the nodes live today.
    result, _ = rehearse(cell, {0.0: set_clock("camera", offset_s=-86_400.0)})
    assert result.outcome == "stale_state"
    assert result.attempts[-2].step == "detect object"


def test_clocks_that_are_off_give_the_same_run_twice(cell: MockCell) -> None:
    actions = {0.0: set_clock("camera", offset_s=0.001, drift=50e-6), 2.0: jump("ros", 0.05)}
    assert rehearse(cell, actions)[0] == rehearse(cell, actions)[0]
