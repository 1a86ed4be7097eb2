"""What a person finds on the graph of a played cell: parameters, states of nodes, and actions that take goals."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import MockCell
from cellc.mock.cell import cell_of
from cellc.mock.plant import Plant
from cellc.mock.ros import session
from cellc.mock.ros.bridge import Received
from tests.mock.ros import stand_in, task_stand_in
from tests.mock.ros.stand_in import Graph, right
from tests.mock.ros.task_stand_in import TaskGraph

_GRIP, _MOVE = "/gripper_action/gripper_cmd", "/arm_trajectory/follow_joint_trajectory"
_KNUCKLE = "gripper_robotiq_85_left_knuckle_joint"


class _Client(Graph):
    """A second client of an action beside the task that is played."""

    def __init__(self, action: str, goal: dict[str, Any]) -> None:
        super().__init__(right)
        self.answers: list[Any] = []
        self.feedback: list[Any] = []
        self._action, self._goal = action, goal

    def send(self, plant: Plant) -> None:
        """Send the goal when the cell has been up for a while."""
        said = {"goal": self._goal, "end": 1, "number": 2}
        received = Received(self.actions[self._action], json.dumps(said).encode())
        plant.simulation.at(plant.now_ns + 3_000_000_000, partial(self._said.append, received))

    def answer(self, number: int, value: Any) -> None:
        self.answers.append(value)

    def end_goal(self, end: int, status: int, result: Any) -> None:
        return

    def feed_back(self, end: int, kind: str, values: Any) -> None:
        self.feedback.append(values)


def test_a_goal_beside_that_of_the_played_task_has_another_owner(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph = _Client(_GRIP, {"command": {"name": [_KNUCKLE], "position": [0.1]}})
    begin = session._Around.begin

    def begun(around: Any, plant: Plant) -> None:
        begin(around, plant)
        graph.send(plant)

    monkeypatch.setattr(session._Around, "begin", begun)
    result = stand_in.run(cell, monkeypatch, graph).result
    assert graph.answers == [True]
    assert result.outcome == AttemptOutcome.WRONG_OWNER
    assert result.attempts[-1].fault_code == "a client on the graph sent a goal to gripper_action"


def test_every_played_node_is_there_with_its_parameters(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph(right)
    stand_in.run(cell, monkeypatch, graph)
    assert {"/task", "/move_group", "/arm_trajectory", "/gripper_action", "/arm_io"} <= set(graph.parameters)
    assert "/perception" not in graph.parameters
    assert graph.parameters["/robot_state_publisher"]["robot_description"] == cell.folder.urdf
    assert graph.parameters["/controller_manager"]["update_rate"] == 500
    arm = graph.parameters["/arm_trajectory"]
    assert arm["constraints.arm_elbow_joint.goal"] == 0.01
    assert arm["command_interfaces"] == ["position"]
    assert graph.parameters["/move_group"] == {}


class _Looking(TaskGraph):
    """Asks for the state of a node when the task works."""

    state: Any = None
    asked = False

    def settle(self, node: str, within_s: float) -> str:
        if self.actions and not self.asked:
            self.asked = True
            self.number = self.say(self.services["/perception/get_state"], {"request": {}})
        return super().settle(node, within_s)

    def answer(self, number: int, value: Any) -> None:
        if self.asked and number == self.number:
            self.state = value
        else:
            super().answer(number, value)


def test_a_played_managed_node_is_active_when_the_task_works(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = _Looking()
    task_stand_in.run(cell, monkeypatch, "gripper_activated", graph=graph)
    assert graph.state == {"current_state": {"id": 3, "label": "active"}}  # of lifecycle_msgs/msg/State


class _Trajectory(TaskGraph):
    """Sends the first move to the controller of the arm itself, without the planner."""

    def move_joints(self, group: str, positions: Any) -> Any:
        point = {"positions": list(positions.values()), "time_from_start": {"sec": 3, "nanosec": 0}}
        return self._send(_MOVE, {"trajectory": {"joint_names": list(positions), "points": [point]}})

    def end_goal(self, end: int, status: int, result: Any) -> None:
        succeeded = result.get("error_code") == 0  # FollowJointTrajectory has a number, MoveGroup a message
        super().end_goal(end, status, {"error_code": {"val": 1}} if succeeded else result)


def test_a_goal_of_the_controller_itself_has_feedback(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    graph = _Trajectory()
    judged = task_stand_in.run(cell, monkeypatch, graph=graph)
    assert judged.result.outcome == AttemptOutcome.SUCCEEDED
    told = [each for each in graph.feedback if "actual" in each]
    assert told[0]["joint_names"] == list(cell.contract.groups[cell.contract.poses["home"][0].group].joints)
    assert len(told) > 40  # action_monitor_rate of the folder is 20 Hz, and two moves of 3 s go home


def test_a_gripper_that_answers_no_goal_is_waited_for(cell: MockCell, monkeypatch: pytest.MonkeyPatch) -> None:
    known = cell.entry("pick_and_place")
    event = FaultEvent.model_validate({"step": 3, "when": "started"})
    silent = FaultEntry(kind=FaultKind.UNRESPONSIVE, target="gripper_action", event=event)
    changed = known.model_copy(update={"faults": (silent,), "expect": AttemptOutcome.TIMEOUT})
    judged = task_stand_in.run(cell_of(replace(cell.folder, rehearsals=(changed,))), monkeypatch)
    assert judged.result.violations == ()
    assert judged.result.outcome == AttemptOutcome.TIMEOUT
    assert judged.result.attempts[-1].fault_code.startswith("no answer from gripper_action within")


def test_the_command_has_the_name_of_the_rehearsal_in_each_run_of_a_campaign(
    cell: MockCell, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph = TaskGraph()
    run = cell.entry("gripper_activated").model_copy(update={"name": "gripper_activated/freeze:arm@1"})
    changed = cell_of(replace(cell.folder, rehearsals=(cell.entry("gripper_activated"), run)))
    task_stand_in.run(changed, monkeypatch, run.name, graph=graph)
    assert graph.rehearsal == "gripper_activated"
