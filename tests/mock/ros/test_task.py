"""Rehearsals around a task node that is not played: a right one passes them all, a wrong one is named."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell
from cellc.mock.campaign.campaign import execute
from cellc.mock.campaign.plan import CampaignRun
from cellc.mock.campaign.summary import failure_lines
from cellc.mock.cell import Watch, cell_of
from cellc.mock.errors import MockError
from cellc.mock.result import RehearsalResult
from cellc.mock.ros.bridge import GraphEnd, Received
from cellc.mock.ros.incoming import MalformedMessageError
from cellc.mock.ros.requests import FOLLOW_JOINT_TRAJECTORY, GRIPPER_COMMAND, asked_of
from cellc.mock.ros.session import concerns
from tests.mock.ros.task_stand_in import MOVES, TaskGraph, run


def _step(kind: str, target: str, **more: object) -> StepEntry:
    return StepEntry.model_validate({"kind": kind, "target": target, **more})


@pytest.fixture(scope="module")
def wider(cell: MockCell) -> MockCell:
    """The cell with two more rehearsals: joint states that come late, and a camera that moves before it looks."""
    known = cell.entry("pick_and_place")
    onward = (_step("detect", "object"), _step("move", "pick"))
    late = FaultEntry(
        kind=FaultKind.DELAY, target="arm", delay_s=0.3, event=FaultEvent.model_validate({"step": 2, "when": "started"})
    )
    changes: Mapping[str, dict[str, object]] = {
        "late_states": {
            "steps": (_step("move", "home"), _step("wait", "", duration_s=1.0), *onward),
            "faults": (late,),
            "expect": AttemptOutcome.STALE_STATE,
        },
        "moved": {"steps": (_step("move", "place"), _step("move", "home"), *onward)},
    }
    more = tuple(known.model_copy(update={"name": name, **change}) for name, change in changes.items())
    return cell_of(replace(cell.folder, rehearsals=(*cell.entries, *more)))


_REHEARSALS = (
    "pick_and_place",
    "stale_camera",
    "program_stopped",
    "jogged_and_restarted",
    "stopped_and_resumed",
    "gripper_activated",
    "canceled",
    "no_part",
    "wrong_part",
    "lost_part",
    "slipped",
    "late_states",
    "moved",
)


@pytest.mark.parametrize("name", _REHEARSALS)
def test_a_right_node_ends_every_rehearsal_as_the_played_one(
    wider: MockCell, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    result, played = run(wider, monkeypatch, name).result, wider.run(name)
    assert result.violations == ()
    assert result.passed, result
    assert result.outcome == played.outcome


def test_two_runs_have_the_same_records(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    assert run(cell, monkeypatch).result == run(cell, monkeypatch).result


_WRONG = {
    "degrees": (
        "pick_and_place",
        "goal_outside_limits: `/task` wants joint `arm_shoulder_lift_joint` at -90, outside -6.283 to 6.283; taken as "
        "degrees it would be inside",
    ),
    "frame": ("pick_and_place", "goal_elsewhere: `/task` sent a goal to `/move_action` with `tcp` 871.2 mm and"),
    "latest": ("moved", "goal_elsewhere: `/task` sends no more goals, `tcp` 36.2 mm and 7.3 deg from `pick`"),
    "stale": ("stale_camera", "not_stopped: `/task` let its goal of `/move_action` execute for 0.3 s more: newest"),
    "arrival": (
        "late_states",
        "commanded_on_stale_state: `/task` sent a goal to `/move_action`: joint state is 0.301 s",
    ),
    "retries": (
        "stopped_and_resumed",
        "commanded_while_stopped: `/task` sent a goal to `/move_action` while hardware component arm_hardware reports "
        "protective_stop, and no person had acknowledged",
    ),
    "deaf": ("canceled", "cancel_ignored: `/task` let its goal of `/move_action` execute for 0.3 s more: the move was"),
    "no_look": ("lost_part", "not_stopped: `/task` let its goal of `/move_action` execute for 0.3 s more: lost: joint"),
    "dies": ("gripper_activated", "node_ended: `/task` ended on a pose on `/object_pose` whose position is no number"),
    "blocks": ("pick_and_place", "blocked: `/task` has handled no message for"),
}


@pytest.mark.parametrize("wrong", _WRONG)
def test_a_wrong_node_is_named(wider: MockCell, monkeypatch: pytest.MonkeyPatch, wrong: str) -> None:
    name, text = _WRONG[wrong]
    result = run(wider, monkeypatch, name, wrong).result
    assert not result.passed
    assert any(line.startswith(text) for line in result.violations), result.violations


class _Poked(TaskGraph):
    """Sends a goal of its own beside the node's program, at the first chance."""

    def __init__(self, goal: Mapping[str, Any]) -> None:
        super().__init__()
        self.program_began = False
        self._goal = goal

    def settle(self, node: str, within_s: float) -> str:
        if self.actions and not self.program_began:
            self.program_began = True
            self._send(MOVES, self._goal)
            return ""
        return super().settle(node, within_s)


@pytest.mark.parametrize(
    ("goal", "text"),
    [
        (
            {"request": {"group_name": 3}},
            "malformed_message: `task` sent a goal of `moveit_msgs/action/MoveGroup` whose",
        ),
        (
            {
                "request": {
                    "group_name": "manipulator",
                    "goal_constraints": [
                        {"joint_constraints": [{"joint_name": "arm_elbow_joint", "position": float("nan")}]}
                    ],
                }
            },
            "invalid_goal: `/task` wants joint `arm_elbow_joint` at nan",
        ),
    ],
)
def test_a_goal_that_is_none_is_named(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, goal: Mapping[str, Any], text: str
) -> None:
    result = run(cell, monkeypatch, graph=_Poked(goal)).result
    assert any(line.startswith(text) for line in result.violations), result.violations


class _Late(TaskGraph):
    """Has found the actions when it is looked for the third time, and is never waited for while its clock stands."""

    looked = 0

    def subscriptions(self, topic: str) -> Sequence[GraphEnd]:
        if not topic.endswith("/_action/status"):
            return super().subscriptions(topic)
        self.looked += 1
        return [GraphEnd("/task", "action_msgs/msg/GoalStatusArray", "reliable", "volatile")] * (self.looked > 2)

    def take(self, within_s: float = 0.0) -> Received | None:
        assert within_s == 0.0
        return super().take()


def test_a_node_that_acts_on_its_clock_is_awaited_until_it_has_found_the_actions_alone(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph = _Late()
    assert run(cell, monkeypatch, "gripper_activated", graph=graph, patience_s=60.0).result.passed
    assert graph.looked == 4


def test_the_node_hears_that_it_is_planned_and_monitored(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = TaskGraph()
    run(cell, monkeypatch, "gripper_activated", graph=graph)
    assert graph.feedback == [{"state": "PLANNING"}, {"state": "MONITOR"}] * 2


def test_goals_of_controllers_are_read_as_they_are_sent() -> None:
    point = {"positions": [0.5], "velocities": [0.0], "time_from_start": {"sec": 2, "nanosec": 5}}
    goal = {
        "trajectory": {"joint_names": ["a"], "points": [point]},
        "goal_tolerance": [{"name": "a", "position": 0.01}],
        "goal_time_tolerance": {"sec": 1},
    }
    asked: Any = asked_of(FOLLOW_JOINT_TRAJECTORY, json.loads(json.dumps(goal)))
    assert asked.joint_names == ("a",)
    assert (asked.points[0].positions, asked.points[0].time_from_start_ns) == ((0.5,), 2_000_000_005)
    assert (asked.goal_tolerance[0].position, asked.goal_time_tolerance_ns) == (0.01, 1_000_000_000)
    gripper: Any = asked_of(GRIPPER_COMMAND, {"command": {"position": 0.04, "max_effort": 20.0}})
    assert (gripper.position, gripper.effort) == ((0.04,), (20.0,))
    with pytest.raises(MalformedMessageError, match=r"whose `trajectory.points.0.positions.0` cannot be read"):
        asked_of(FOLLOW_JOINT_TRAJECTORY, {"trajectory": {"points": [{"positions": ["x"]}]}})


@pytest.mark.parametrize(
    ("kind", "target", "expected"),
    [
        ("protective_stop", "arm", True),
        ("freeze", "camera", True),
        ("drop_frame", "arm_shoulder_link", True),
        ("mismatch_qos", "/joint_states", False),
        ("unreachable", "pick", False),
    ],
)
def test_a_campaign_has_the_faults_that_are_on_the_graph(
    cell: MockCell, kind: str, target: str, expected: bool
) -> None:
    fault = FaultEntry.model_validate({"kind": kind, "target": target, "at_s": 0.0})
    assert concerns(cell.contract, ("task",), fault) is expected


@pytest.mark.parametrize(("wrong", "passes"), [("", True), ("deaf", False)])
def test_a_run_of_a_campaign_is_judged(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch, wrong: str, passes: bool
) -> None:
    baseline = CampaignRun.undisturbed(cell.entry("canceled"))

    def rehearse(_: MockCell, entry: RehearsalEntry, seed: int, watch: Watch) -> RehearsalResult:
        return run(cell, monkeypatch, entry.name, wrong, watch=watch).result

    end = execute(cell, baseline, 0, rehearse)
    assert end.limits.peaks != ()
    told = [line for line in failure_lines(end, "again") if "against the contract: cancel_ignored" in line]
    assert bool(told) is not passes


def test_a_step_that_cannot_be_seen_from_outside_is_refused(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    entry = cell.entry("pick_and_place")
    called = entry.model_copy(update={"steps": (StepEntry(kind=StepKind.CALL, target="/x"),)})
    with pytest.raises(MockError, match="step `call /x` of `pick_and_place` cannot be followed from outside"):
        run(cell_of(replace(cell.folder, rehearsals=(called,))), monkeypatch)
