"""The program of the first goals on a robot in memory, behind the modules of ROS: one joint moves a little, or none."""

from __future__ import annotations

import csv
import json
import math
import re
import signal
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

from tests.cells import ROOT, built
from tests.consumers.matrix import Build, build
from tests.consumers.permissions import policy_of
from tests.consumers.starting import launched

_START = {"arm_shoulder_pan_joint": 0.3, "arm_shoulder_lift_joint": -1.5, "arm_elbow_joint": 1.4}
_START |= {"arm_wrist_1_joint": -1.6, "arm_wrist_2_joint": -1.57, "arm_wrist_3_joint": 0.1, "finger": 0.0}
_WORD = "I_HAVE_PASSED_GATES_G0_TO_G6"
_WRIST = "arm_wrist_3_joint"
_HALF = math.radians(2.5)
"""Half of the 5 deg that the spec allows."""
_SUCCEEDED, _CANCELED = 4, 5  # action_msgs/msg/GoalStatus


def _words(joint: str = _WRIST, **given: str) -> list[str]:
    (process,) = launched(build("ur5e_pick", "jazzy"), "goal", confirm_goal=_WORD, joint=joint, **given).processes
    return [*process.arguments, "--ros-args", "-r", "__node:=first_goal"]


@dataclass
class Later:
    """A future of rclpy: its answer from a time on."""

    robot: Robot
    answer: Callable[[], Any]
    at_s: float = 0.0

    def done(self) -> bool:
        return self.robot.now_s >= self.at_s and self.answer() is not None

    def result(self) -> Any:
        return self.answer()


@dataclass
class Robot:
    """An arm whose controller moves its joints evenly to where a goal sends them; each look takes 10 ms.

    Attributes:
        follows: what a joint does with its command, rad: the joint itself where absent.
        age_s: of the stamps.
        speed: share of its speed that people have set; its controller's time runs as slowly.
        interrupt_at: positions at which a person presses Ctrl-C.
    """

    there: list[str] = field(default_factory=list)
    served: bool = True
    accepts: bool = True
    ends: bool = True
    states: bool = True
    drifts: Mapping[str, float] = field(default_factory=dict)
    follows: Callable[[str, float], float] = lambda _name, command: command
    velocities: bool = True
    age_s: float = 0.01
    speed: float = 1.0
    silent_after_s: float = math.inf
    interrupt_at_s: float = math.inf
    positions: dict[str, float] = field(default_factory=lambda: dict(_START))
    goals: list[dict[str, float]] = field(default_factory=list)
    log: list[str] = field(default_factory=list)
    now_s: float = 100.0
    _goal: tuple[float, float, dict[str, float], dict[str, float]] | None = None
    _status: int | None = None
    _take: Callable[[Any], None] = lambda _message: None
    _feedback: Callable[[Any], None] = lambda _message: None

    def spin_once(self, _node: Any, timeout_sec: float) -> None:
        self.now_s += min(timeout_sec, 0.01)
        before = dict(self.positions)
        self._move()
        for name, speed in self.drifts.items():
            self.positions[name] += speed * 0.01
        if self.now_s >= self.interrupt_at_s:
            self.interrupt_at_s = math.inf
            signal.raise_signal(signal.SIGINT)
        if self.states and self.now_s < self.silent_after_s:
            stamp_s = self.now_s - self.age_s
            stamp = SimpleNamespace(sec=int(stamp_s), nanosec=round(stamp_s % 1.0 * 1e9))
            speeds = [(self.positions[name] - before[name]) / 0.01 for name in before] if self.velocities else []
            header = SimpleNamespace(stamp=stamp)
            self._take(
                SimpleNamespace(header=header, name=[*before], position=[*self.positions.values()], velocity=speeds)
            )

    def _move(self) -> None:
        if self._goal is None:
            return
        begun_s, seconds, start, target = self._goal
        share = min(self.speed * (self.now_s - begun_s) / seconds, 1.0)
        command = {name: start[name] + share * (target[name] - start[name]) for name in target}
        self.positions |= {name: self.follows(name, value) for name, value in command.items()}
        actual = [self.positions[name] for name in command]
        points = [SimpleNamespace(positions=column) for column in ([*command.values()], actual)]
        error = SimpleNamespace(positions=[wanted - got for wanted, got in zip(command.values(), actual, strict=True)])
        feedback = SimpleNamespace(joint_names=[*command], desired=points[0], actual=points[1], error=error)
        self._feedback(SimpleNamespace(feedback=feedback))
        if share == 1.0 and self.ends:
            self._goal, self._status = None, _SUCCEEDED

    def send_goal_async(self, goal: Any, feedback_callback: Callable[[Any], None]) -> Later:
        (point,) = goal.trajectory.points
        target = dict(zip(goal.trajectory.joint_names, point.positions, strict=True))
        seconds = point.time_from_start.sec + point.time_from_start.nanosec * 1e-9
        self.goals.append(target)
        if self.accepts:
            start = {  # the shorter way, as a controller goes whose joint turns without limits
                name: target[name] + math.remainder(place - target[name], math.tau) if name in target else place
                for name, place in self.positions.items()
            }
            self._goal, self._status = (self.now_s, seconds, start, target), None
        self._feedback = feedback_callback
        answer = SimpleNamespace(status=0, result=SimpleNamespace(error_code=0, error_string=""))

        def ended() -> Any:
            answer.status = self._status
            return None if self._status is None else answer

        def cancel() -> None:
            self.log.append("cancel")
            if self._status is None:
                self._goal, self._status = None, _CANCELED

        handle = SimpleNamespace(
            accepted=self.accepts, get_result_async=lambda: Later(self, ended), cancel_goal_async=cancel
        )
        return Later(self, lambda: handle, self.now_s + 0.02)

    def subscribe(self, _type: Any, topic: str, take: Callable[[Any], None], _qos: Any) -> None:
        self.log.append(topic)
        self._take = take


def _modules(robot: Robot) -> dict[str, ModuleType]:
    """Return what the program imports of ROS, around one robot."""
    clock = SimpleNamespace(now=lambda: SimpleNamespace(nanoseconds=round(robot.now_s * 1e9)))
    node = SimpleNamespace(
        create_subscription=robot.subscribe,
        get_clock=lambda: clock,
        get_node_names_and_namespaces=lambda: [(path.rpartition("/")[2], "/") for path in robot.there],
        destroy_node=lambda: robot.log.append("leave"),
    )
    client = SimpleNamespace(server_is_ready=lambda: robot.served, send_goal_async=robot.send_goal_async)
    goal = SimpleNamespace(Goal=lambda: SimpleNamespace(trajectory=SimpleNamespace()))
    content: dict[str, dict[str, Any]] = {
        "rclpy": {
            "init": lambda **_arguments: None,
            "create_node": lambda *_arguments, **_named: node,
            "spin_once": robot.spin_once,
            "try_shutdown": lambda: None,
        },
        "rclpy.action": {"ActionClient": lambda _node, _type, action: client},
        "rclpy.qos": {"qos_profile_sensor_data": None},
        "rclpy.signals": {"SignalHandlerOptions": SimpleNamespace(NO=0)},
        "control_msgs": {},
        "control_msgs.action": {"FollowJointTrajectory": goal},
        "sensor_msgs": {},
        "sensor_msgs.msg": {"JointState": None},
        "builtin_interfaces": {},
        "builtin_interfaces.msg": {"Duration": SimpleNamespace},
        "trajectory_msgs": {},
        "trajectory_msgs.msg": {"JointTrajectoryPoint": SimpleNamespace},
    }
    modules = {name: ModuleType(name) for name in content}
    for name, module in modules.items():
        module.__dict__.update(content[name])
    return modules


def _run(robot: Robot, words: list[str]) -> int:
    program: Any = ModuleType("first_goal_of_a_test")
    text = build("ur5e_pick", "jazzy").texts["scripts/first_goal"]
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    with pytest.MonkeyPatch.context() as patch:
        for name, module in _modules(robot).items():
            patch.setitem(sys.modules, name, module)
        patch.setitem(sys.modules, program.__name__, program)
        exec(compile(text, "scripts/first_goal", "exec"), program.__dict__)
        clock = {"monotonic": lambda: robot.now_s, "gmtime": lambda: None, "strftime": lambda *_: "20260701T120000Z"}
        program.time = SimpleNamespace(**clock)
        try:
            ended = program.main(words)
        finally:
            for number, handler in handlers.items():
                signal.signal(number, handler)
    assert isinstance(ended, int)
    return ended


@pytest.fixture(autouse=True)
def _in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("joint", [_WRIST, "arm_shoulder_pan_joint"])
def test_one_joint_moves_to_both_sides_within_what_the_spec_allows_and_every_other_keeps_its_position(
    joint: str,
) -> None:
    robot = Robot()
    assert _run(robot, _words(joint)) == 0
    moves = [{name: goal[name] - _START[name] for name in goal} for goal in robot.goals]
    assert [move.pop(joint) for move in moves] == pytest.approx([_HALF, 0.0, -_HALF, 0.0])
    assert all(len(move) == 5 and set(move.values()) == {0.0} for move in moves)  # no joint of the gripper
    assert robot.positions == pytest.approx(_START)


def test_a_canceled_goal_ends_halfway_and_the_joint_moves_back(capsys: pytest.CaptureFixture[str]) -> None:
    robot = Robot()
    assert _run(robot, _words(then="cancel")) == 0
    assert [goal[_WRIST] - _START[_WRIST] for goal in robot.goals] == pytest.approx([_HALF, 0.0])
    assert robot.log.count("cancel") == 1
    printed = capsys.readouterr().out
    half = next(line for line in printed.splitlines() if line.startswith(f"canceled: {_WRIST}"))
    assert float(half.split()[-1]) == pytest.approx(_HALF / 2.0, abs=2e-3)
    assert "standstill 0.0" in printed
    assert robot.positions == pytest.approx(_START)


def test_a_robot_at_a_tenth_of_its_speed_ends_every_goal_and_is_canceled_halfway() -> None:
    robot = Robot(speed=0.1)
    assert _run(robot, _words()) == 0
    assert len(robot.goals) == 4
    canceled = Robot(speed=0.1)
    assert _run(canceled, _words(then="cancel")) == 0
    assert canceled.positions == pytest.approx(_START)


@pytest.mark.parametrize(("at", "side", "open_side"), [(2.0 * math.pi - 0.04, -1.0, "-"), (-2.0 * math.pi, 1.0, "+")])
def test_joint_at_a_limit_moves_to_its_open_side_alone(
    at: float, side: float, open_side: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for then in ("end", "cancel"):
        robot = Robot(positions=_START | {_WRIST: at})
        assert _run(robot, _words(then=then)) == 0
        assert [goal[_WRIST] - at for goal in robot.goals] == pytest.approx([side * _HALF, 0.0])
        assert f"moving only to the {open_side} side" in capsys.readouterr().out


def test_a_joint_without_limits_may_be_reported_a_turn_away() -> None:
    # kortex_driver reports a continuous joint within a turn: beyond 180 deg its state goes on at -180 deg.
    words = [f"{_WRIST}::" if word.startswith(f"{_WRIST}:") else word for word in _words()]
    at = math.pi - 0.01
    robot = Robot(positions=_START | {_WRIST: at}, follows=lambda _name, place: math.remainder(place, math.tau))
    assert _run(robot, words) == 0
    assert [goal[_WRIST] - at for goal in robot.goals] == pytest.approx([_HALF, 0.0, -_HALF, 0.0])


def test_a_joint_that_does_not_move_fails_where_a_wide_tolerance_lets_its_goal_succeed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    # An OpenArm has a goal tolerance of 0.05 rad and a first goal of 0.0436: a silent motor would end it as succeeded.
    robot = Robot(follows=lambda name, _place: _START[name])
    assert _run(robot, _words()) == 1
    assert len(robot.goals) == 1
    assert f"out: {_WRIST} moved +0.0000 of +0.0436" in capsys.readouterr().err


def test_joint_without_an_open_side_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    words = [f"{_WRIST}:0.08:0.12" if word.startswith(f"{_WRIST}:") else word for word in _words()]
    robot = Robot()
    assert _run(robot, words) == 1
    assert robot.goals == []
    assert "closer than 0.0436 to one of its limits 0.08 and 0.12" in capsys.readouterr().err


def test_goal_is_no_faster_than_the_first_motion_of_the_spec() -> None:
    words = dict(word[2:].split("=") for word in _words() if word.startswith("--") and "=" in word)
    # From rest to rest on a cubic the peak is 1.5 times the mean.
    assert 1.5 * float(words["by"]) / float(words["seconds"]) <= math.radians(5.0) + 1e-12
    # A robot whose slider is at 10 % takes ten times as long: its controller's clock runs as slowly as it moves.
    assert float(words["seconds"]) < float(words["timeout"]) == 50.0


@pytest.mark.parametrize(
    ("robot", "expected"),
    [
        (Robot(there=["/move_group", "/task"]), "stop /task first"),
        (Robot(served=False), "no server for /arm_trajectory/follow_joint_trajectory"),
        (Robot(states=False), "no state of arm_elbow_joint, arm_shoulder_lift_joint"),
        (Robot(positions={"arm_elbow_joint": 1.4}), "no state of arm_shoulder_lift_joint"),
        (Robot(age_s=0.7), "stamps on /joint_states are 0.70 s old"),
        (Robot(age_s=-0.7), "stamps on /joint_states are -0.70 s old"),
        (Robot(drifts={"arm_elbow_joint": 0.01}), "arm_elbow_joint not at standstill"),
        (Robot(drifts={"arm_elbow_joint": 0.01}, velocities=False), "arm_elbow_joint not at standstill"),
    ],
)
def test_nothing_is_sent_unless_everything_is_ready(
    robot: Robot, expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(robot, _words()) == 1
    assert robot.goals == []
    assert expected in capsys.readouterr().err
    assert robot.log[-1] == "leave"


@pytest.mark.parametrize(
    ("robot", "expected"),
    [
        (Robot(ends=False), "out: the goal did not end within 50 s and was canceled"),
        (Robot(follows=lambda name, to: 0.2 - to if name == _WRIST else to), f"out: {_WRIST} at 0.09"),
        (Robot(follows=lambda name, to: 0.1 + 1.5 * (to - 0.1) if name == _WRIST else to), f"out: {_WRIST} at 0.15"),
        (
            Robot(follows=lambda name, to: to + 0.01 if name == "arm_elbow_joint" else to),
            "out: arm_elbow_joint at 1.41",
        ),
        (Robot(silent_after_s=102.0), "out: states on /joint_states stopped arriving"),
        (Robot(interrupt_at_s=102.0), "out: interrupted"),
        # Before the goal is accepted: the cancel waits for its answer.
        (Robot(interrupt_at_s=100.52), "out: interrupted"),
    ],
    ids=["never ends", "wrong direction", "overshoot", "another joint", "silent", "Ctrl-C", "Ctrl-C before acceptance"],
)
def test_motion_that_is_not_as_requested_is_canceled(
    robot: Robot, expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(robot, _words()) == 1
    assert len(robot.goals) == 1
    assert robot.log[-2:] == ["cancel", "leave"]
    assert expected in capsys.readouterr().err


def test_refused_goal_ends_the_program(capsys: pytest.CaptureFixture[str]) -> None:
    robot = Robot(accepts=False)
    assert _run(robot, _words()) == 1
    assert "did not accept the goal" in capsys.readouterr().err
    assert "cancel" not in robot.log


def test_evidence_holds_command_state_and_error_of_every_joint_and_a_plot(tmp_path: Path) -> None:
    folder = tmp_path / "attempt 1"
    lag = 0.001
    assert _run(Robot(follows=lambda _name, command: command - lag), _words(evidence=str(folder))) == 0
    (table,) = folder.glob("*.csv")
    with table.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["command"]]
    assert {row["joint"] for row in rows} == _START.keys() - {"finger"}
    assert {row["goal"] for row in rows} == {"out", "back", "other side", "back again"}
    assert all(float(row["error"]) == pytest.approx(lag, abs=1e-6) for row in rows)
    drawn = fromstring((folder / f"{table.stem}.svg").read_text(encoding="utf-8"))
    lines = drawn.findall("{http://www.w3.org/2000/svg}polyline")
    assert all(len(line.get("points", "").split()) > 500 for line in lines)
    assert len(lines) == 3


@pytest.mark.parametrize(("robot", "verdict"), [(Robot(), "PASSED"), (Robot(accepts=False), "FAILED")])
def test_evidence_says_how_it_ended_and_of_which_configuration(robot: Robot, verdict: str, tmp_path: Path) -> None:
    package = ROOT / "generated/ur5e_pick"
    words = _words(evidence=str(tmp_path))
    words[words.index("--package") + 1] = str(package)
    _run(robot, words)
    (record,) = (json.loads(file.read_text(encoding="utf-8")) for file in tmp_path.glob("*.json"))
    manifest = json.loads((package / "manifest.json").read_text(encoding="utf-8"))
    assert record["configuration_id"] == manifest["configuration_id"]
    assert (record["cell"], record["joint"], record["then"]) == ("ur5e_pick", _WRIST, "end")
    assert (record["verdict"], bool(record["seen"])) == (verdict, verdict == "FAILED")


def test_evidence_without_a_package_has_no_configuration(tmp_path: Path) -> None:
    _run(Robot(), _words(evidence=str(tmp_path)))
    (record,) = (json.loads(file.read_text(encoding="utf-8")) for file in tmp_path.glob("*.json"))
    assert "configuration_id" not in record


def test_evidence_is_never_replaced(tmp_path: Path) -> None:
    assert _run(Robot(), _words(evidence=str(tmp_path))) == 0
    with pytest.raises(FileExistsError):
        _run(Robot(), _words(evidence=str(tmp_path)))


def test_joint_of_another_device_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    words = [word.replace(_WRIST, "finger") if word == _WRIST else word for word in _words()]
    robot = Robot()
    assert _run(robot, words) == 1
    assert "finger is not a joint of /arm_trajectory" in capsys.readouterr().err
    assert robot.goals == []


def test_it_is_started_behind_the_proofs_of_every_motion_client() -> None:
    package = build("ur5e_pick", "jazzy")
    (process,) = launched(package, "goal", confirm_goal=_WORD, joint=_WRIST).processes
    assert process.prefix[-4:] == ("--target", "real", "move", "--")
    arguments = {arg.get("name"): arg for arg in fromstring(package.texts["launch/goal.launch.xml"]).findall("arg")}
    assert "default" not in arguments["confirm_goal"].attrib
    assert {choice.get("value") for choice in arguments["joint"]} == _START.keys() - {"finger"}
    (enclave,) = policy_of(package.texts).findall(".//enclave[@path='/ur5e_pick/first_goal']")
    called = [action.text for action in enclave.findall(".//actions[@call='ALLOW']/action")]
    assert called == ["/arm_trajectory/follow_joint_trajectory"]


@pytest.mark.parametrize(("device", "other"), [("loader", "unloader"), ("unloader", "loader")])
def test_each_of_two_arms_has_its_own_word_and_its_own_goals(device: str, other: str) -> None:
    both = built("dual_ur")
    package = Build(both.graph, both.artifacts, "dual_ur", "jazzy")
    given = {"confirm_goal": f"{_WORD}_FOR_{device}", "joint": f"{device}_elbow_joint"}
    (process,) = launched(package, "goal", **given).processes
    assert len([word for word in process.arguments if re.match(f"{device}_.*:", word)]) == 6
    assert not [word for word in process.arguments if re.match(f"{other}_", word)]
