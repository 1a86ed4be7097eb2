"""A graph without ROS with a task node on it, which does what a program of `task_program` says."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pytest

from cellc.contract.transforms import Pose
from cellc.mock import MockCell
from cellc.mock.cell import Watch
from cellc.mock.evidence.bag import messages
from cellc.mock.plant import Plant
from cellc.mock.ros import session
from cellc.mock.ros.asked import AmongNodes, Timing
from cellc.mock.ros.bridge import GraphEnd, Received
from cellc.mock.ros.session import Judged, rehearse_among
from cellc.mock.tf.buffer import Transform
from tests.mock.ros.stand_in import Graph
from tests.mock.ros.task_program import Program, Seen, States

STATES, POSES = "/joint_states", "/object_pose"
MOVES, GRIPS = "/move_action", "/gripper_action/gripper_cmd"


class Goal:
    """A goal of the node, told by what the mock answers."""

    def __init__(self, graph: TaskGraph, end: int) -> None:
        self.status: int | None = None
        self.good = False
        self.end = end
        self._graph = graph

    def cancel(self) -> None:
        if self.status is None:
            self._graph.say(self._graph.channel_of[self.end], {"cancel": self.end})

    def ended(self, value: Any) -> None:
        self.status = value["status"]
        self.good = value["result"].get("error_code", {"val": 1})["val"] == 1


class TaskGraph(Graph):
    """Answers as the bridge does, and runs the node whenever it is asked whether it has handled its messages."""

    def __init__(self, wrong: str = "", **changes: Any) -> None:
        ends = {
            STATES: [GraphEnd("/task", "sensor_msgs/msg/JointState", "reliable", "volatile")],
            POSES: [GraphEnd("/task", messages.POSE_STAMPED, "reliable", "volatile")],
        }
        super().__init__(lambda *_: (), nodes={"/task"}, ends={**ends, **changes})
        self.wrong = wrong
        self.rehearsal = ""
        self.canceled = self.acknowledged = False
        self.channel_of: dict[int, int] = {}
        self.rejected: list[int] = []
        self.feedback: list[Mapping[str, object]] = []
        self.program: Any = iter(())
        self._goals: dict[int, Goal] = {}
        self._asked: dict[int, Goal] = {}
        self._numbers = 0

    # -- the bridge --------------------------------------------------------------------------------------------------

    def start(self, command: Sequence[str]) -> None:
        self.rehearsal = command[-1]

    def subscriptions(self, topic: str) -> Sequence[GraphEnd]:
        return self.ends.get(topic, ())

    def publishers(self, topic: str) -> Sequence[GraphEnd]:
        return ()

    def answer(self, number: int, value: Any) -> None:
        if number in self._asked and not value:
            self._asked[number].status = -1
            self.rejected.append(number)

    def end_goal(self, end: int, status: int, result: Mapping[str, object]) -> None:
        json.dumps(result)
        self._goals[end].ended({"status": status, "result": result})

    def feed_back(self, end: int, kind: str, values: Mapping[str, object]) -> None:
        self.feedback.append(values)

    def publish(self, channel: int, data: bytes) -> None:
        super().publish(channel, data)
        if self.wrong == "dies" and self._topics[channel] == POSES and b"\x00\x00\xf8\x7f" in data:
            self.code = 1

    def settle(self, node: str, within_s: float) -> str:
        if self.code is not None or (self.wrong == "blocks" and self._goals):
            return "/task/get_parameters did not answer within 5 s"
        if self.actions:
            next(self.program, None)
        return ""

    def trigger(self, service: str, within_s: float) -> str:
        if service == "/task/cancel":
            self.canceled = True
        else:
            self.acknowledged = True
        return ""

    def say(self, channel: int, what: Mapping[str, Any]) -> int:
        """Send what asks for an answer."""
        self._numbers += 1
        self._said.append(Received(channel, json.dumps({**what, "number": self._numbers}).encode()))
        return self._numbers

    # -- what the node has heard, and can do -------------------------------------------------------------------------

    @property
    def bound(self) -> Plant:
        assert self.plant is not None
        return self.plant

    @property
    def now_ns(self) -> int:
        return self.bound.clocks.of("task").read(self.bound.now_ns)

    @property
    def states(self) -> States | None:
        (feed,) = self.bound.task.feeds
        newest, arrived_ns = feed.newest(self.bound.now_ns), feed.newest_arrival_ns(self.bound.now_ns)
        if newest is None or arrived_ns is None:
            return None
        stamp_ns = self.bound.clocks.of(feed.history.broadcaster).read(int(feed.history.stamps[newest]))
        positions = dict(zip(feed.history.names, feed.history.positions[newest].tolist(), strict=True))
        return States(stamp_ns, arrived_ns, positions)

    @property
    def observed(self) -> Seen | None:
        inbox = self.bound.task.observations["object"]
        if inbox.newest is None or inbox.arrived_ns is None:
            return None
        return Seen(inbox.newest.stamp_ns, inbox.arrived_ns, inbox.newest.frame, inbox.newest.pose)

    def is_known(self, frame: str, stamp_ns: int) -> bool:
        return isinstance(self._lookup(frame, stamp_ns), Transform)

    def in_world(self, frame: str, stamp_ns: int) -> Pose:
        found = self._lookup(frame, stamp_ns)
        assert isinstance(found, Transform)
        return found.pose

    def _lookup(self, frame: str, stamp_ns: int) -> Any:
        self.bound.robot_state_publisher.catch_up(self.bound.now_ns)
        return self.bound.task.buffer.lookup(self.bound.contract.root_frame, frame, stamp_ns)

    def move_joints(self, group: str, positions: Mapping[str, float]) -> Goal:
        joints = [{"joint_name": joint, "position": at} for joint, at in positions.items()]
        return self._move(group, {"joint_constraints": joints})

    def move_tip(self, group: str, link: str, frame: str, pose: Pose) -> Goal:
        x, y, z = pose.position
        qx, qy, qz, qw = pose.quaternion
        named = {"header": {"frame_id": frame}, "link_name": link}
        place = {**named, "constraint_region": {"primitive_poses": [{"position": {"x": x, "y": y, "z": z}}]}}
        turn = {**named, "orientation": {"x": qx, "y": qy, "z": qz, "w": qw}}
        return self._move(group, {"position_constraints": [place], "orientation_constraints": [turn]})

    def _move(self, group: str, constraints: Mapping[str, Any]) -> Goal:
        return self._send(MOVES, {"request": {"group_name": group, "goal_constraints": [constraints]}})

    def grip(self, joint: str, position: float) -> Goal:
        return self._send(GRIPS, {"command": {"name": [joint], "position": [position]}})

    def _send(self, action: str, goal: Mapping[str, Any]) -> Goal:
        end = 1000 + len(self._goals)
        sent = self._goals[end] = Goal(self, end)
        self.channel_of[end] = self.actions[action]
        self._asked[self.say(self.actions[action], {"goal": goal, "end": end})] = sent
        return sent


def stand_in(monkeypatch: pytest.MonkeyPatch, cell: MockCell, graph_of: Callable[[], TaskGraph]) -> None:
    """Let every run be on a graph without ROS, with a node that is started by the name of its rehearsal."""
    begin = session._Around.begin
    contract = json.loads(cell.contract.model_dump_json())

    def watched(around: Any, plant: Plant) -> None:
        graph = around._bridge
        steps = [step.model_dump(mode="json") for step in cell.entry(graph.rehearsal).steps]
        graph.plant = plant
        graph.program = Program(graph, contract, steps, graph.wrong).run()
        begin(around, plant)

    monkeypatch.setattr(session._Around, "begin", watched)
    monkeypatch.setattr(session, "Bridge", lambda *_: graph_of())
    for wait in ("_DISCOVERY_S", "_AGAIN_S", "_LOOK_S", "_MEET_S"):
        monkeypatch.setattr(session, wait, 0.0)


def run(
    cell: MockCell,
    monkeypatch: pytest.MonkeyPatch,
    name: str = "pick_and_place",
    wrong: str = "",
    *,
    graph: TaskGraph | None = None,
    watch: Watch | None = None,
    patience_s: float = 0.0,
) -> Judged:
    """Run a rehearsal around a task node, in lockstep."""
    stand_in(monkeypatch, cell, lambda: TaskGraph(wrong) if graph is None else graph)
    asked = AmongNodes(("task",), "python3", Timing(None, patience_s), launch="node {rehearsal}", appear_s=0.0)
    try:
        return rehearse_among(cell, cell.entry(name), 0, asked, watch)
    finally:
        monkeypatch.undo()
