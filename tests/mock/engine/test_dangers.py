"""What the real controllers accept although nobody should send it is accepted here too, and named."""

from __future__ import annotations

import math

import pytest

from cellc.mock.control import GripperGoal, TrajectoryGoal, TrajectoryPoint
from cellc.mock.engine.control_stack import ControlStack, dangers
from tests.mock.control.bench import S, bench, point

_SOUND = TrajectoryGoal(("a", "b"), (point(0.1, 0.1), point(0.2, 0.2, at=2.0, v=(0.0, 0.0), a=(0.0, 0.0))))


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        (TrajectoryGoal(("a", "b"), (point(math.nan, 0.0),)), "NaN"),
        (TrajectoryGoal(("a", "b"), (point(math.inf, 0.0),)), "infinite"),
        (TrajectoryGoal(("a", "a"), (point(0.1, 0.2),)), "names a joint twice"),
        (
            TrajectoryGoal(("a", "b"), (TrajectoryPoint((0.1, 0.1), (), (0.0, 0.0), time_from_start_ns=S),)),
            "accelerations without velocities",
        ),
        (GripperGoal((math.nan,)), "NaN"),
    ],
)
def test_dangerous_goal_is_accepted_and_named_once(goal: TrajectoryGoal | GripperGoal, words: str) -> None:
    manager = bench()
    controller = "hand" if isinstance(goal, GripperGoal) else "arm"
    (told,) = dangers(controller, goal)
    assert told.startswith(f"dangerous: `{controller}` accepted")
    assert words in told
    assert manager.send_goal(controller, goal).accepted


def test_sound_goals_are_not_named() -> None:
    assert not list(dangers("arm", _SOUND))
    assert not list(dangers("hand", GripperGoal((0.02,))))


def test_stack_keeps_what_was_accepted_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    manager = bench()
    stack = ControlStack({"m": manager}, {}, 1.0)
    monkeypatch.setattr(stack, "server_of", lambda controller: manager)
    stack.send_goal("arm", _SOUND)
    stack.send_goal("arm", TrajectoryGoal(("a", "c"), (point(math.nan, 0.0),)))  # refused: no joint c
    assert stack.dangers == []
    for _ in range(2):
        stack.send_goal("arm", TrajectoryGoal(("a", "b"), (point(math.nan, 0.0),)))
    assert len(stack.dangers) == 1
