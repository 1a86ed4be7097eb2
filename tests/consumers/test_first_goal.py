"""The program of the first goal, run on a robot in memory: it goes from where the robot stands, or not at all."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

from tests.consumers.matrix import build
from tests.consumers.starting import launched

_STOOD = {"arm_shoulder_pan_joint": 0.3, "arm_shoulder_lift_joint": -1.5, "arm_elbow_joint": 1.4}
_STOOD |= {"arm_wrist_1_joint": -1.6, "arm_wrist_2_joint": -1.57, "arm_wrist_3_joint": 0.1, "finger": 0.0}
_WORD = "I_HAVE_PASSED_GATES_G0_TO_G6"


def _words(*more: str) -> list[str]:
    (process,) = launched(build("ur5e_pick", "jazzy"), "goal", confirm_goal=_WORD).processes
    return [*process.arguments, *more, "--ros-args", "-r", "__node:=first_goal"]


@dataclass
class Future:
    """What is answered at once, or never; a value that is only known later is asked for by a function."""

    answer: Any
    later: Callable[[], Any] | None = None

    def done(self) -> bool:
        return self.answer is not None

    def result(self) -> Any:
        return self.answer if self.later is None else self.later()


@dataclass
class Robot:
    """One whose controller goes where it is told at once, and ends what is canceled."""

    there: list[str] = field(default_factory=list)
    served: bool = True
    ends: bool = True
    positions: dict[str, float] = field(default_factory=lambda: dict(_STOOD))
    velocities: dict[str, float] = field(default_factory=dict)
    asked: list[dict[str, float]] = field(default_factory=list)
    log: list[str] = field(default_factory=list)
    accepted: bool = True

    def spin(self, seconds: float) -> None:
        pass

    def nodes(self) -> list[str]:
        return self.there

    def serves(self) -> bool:
        return self.served

    def leave(self) -> None:
        self.log.append("leave")

    def send(self, joints: list[str], positions: list[float], seconds: float) -> Future:
        self.asked.append(dict(zip(joints, positions, strict=True)))
        self.positions.update(self.asked[-1])
        return Future(self)

    def get_result_async(self) -> Future:
        answer = SimpleNamespace(result=SimpleNamespace(error_code=0, error_string=""))

        def ended() -> SimpleNamespace:
            # 5 is STATUS_CANCELED and 4 STATUS_SUCCEEDED of action_msgs/msg/GoalStatus.
            return SimpleNamespace(status=5 if "cancel" in self.log else 4, result=answer.result)

        return Future(answer if self.ends else None, ended)

    def cancel_goal_async(self) -> None:
        self.log.append("cancel")


def _run(robot: Robot, *more: str) -> int:
    module: Any = ModuleType("first_goal_of_a_test")
    text = build("ur5e_pick", "jazzy").texts["scripts/first_goal"]
    exec(compile(text, "scripts/first_goal", "exec"), module.__dict__)
    module.Robot = lambda action, states: robot
    module.WAIT_S = 0.0
    ended = module.main(_words("--timeout=0.01", "--seconds=0.0", *more))
    assert isinstance(ended, int)
    return ended


def test_one_joint_moves_by_what_the_spec_says_and_every_other_stays_where_it_stands() -> None:
    robot = Robot()
    assert _run(robot) == 0
    (goal,) = robot.asked
    moved = {name: goal[name] - _STOOD[name] for name in goal}
    assert moved.pop("arm_wrist_3_joint") == pytest.approx(math.radians(5.0))
    assert len(moved) == 5  # all joints of the arm, none of the gripper
    assert all(by == 0.0 for by in moved.values())


def test_goal_is_no_faster_than_the_first_motion_of_the_spec() -> None:
    words = dict(word[2:].split("=") for word in _words() if word.startswith("--") and "=" in word)
    # From rest to rest on a cubic the peak is 1.5 times the mean.
    assert 1.5 * float(words["by"]) / float(words["seconds"]) <= math.radians(5.0) + 1e-12
    assert float(words["seconds"]) < float(words["timeout"]) == 5.0


@pytest.mark.parametrize(
    ("robot", "expected"),
    [
        (Robot(there=["/move_group", "/task"]), "end /task first"),
        (Robot(served=False), "no server of /arm_trajectory/follow_joint_trajectory"),
        (Robot(positions={"arm_elbow_joint": 1.4}), "no state of arm_shoulder_lift_joint"),
    ],
)
def test_nothing_is_sent_unless_all_is_there_and_nobody_else_asks(
    robot: Robot, expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _run(robot) == 1
    assert robot.asked == []
    assert expected in capsys.readouterr().err
    assert robot.log == ["leave"]


def test_goal_that_does_not_end_is_canceled(capsys: pytest.CaptureFixture[str]) -> None:
    robot = Robot(ends=False)
    assert _run(robot) == 1
    assert robot.log == ["cancel", "leave"]
    assert "did not end within" in capsys.readouterr().err


def test_goal_that_is_to_be_canceled_tells_how_long_it_moved_on(capsys: pytest.CaptureFixture[str]) -> None:
    robot = Robot()
    assert _run(robot, "--then=cancel") == 0
    assert robot.log == ["cancel", "leave"]
    assert "standstill 0.000 s after the request" in capsys.readouterr().out


def test_it_is_started_behind_the_proofs_of_everything_that_asks_for_motion() -> None:
    built = build("ur5e_pick", "jazzy")
    (process,) = launched(built, "goal", confirm_goal=_WORD).processes
    assert process.prefix[-4:] == ("--target", "real", "move", "--")
    (argument,) = fromstring(built.texts["launch/goal.launch.xml"]).findall("arg[@name='confirm_goal']")
    assert "default" not in argument.attrib
    (enclave,) = fromstring(built.texts["security/policy.xml"]).findall(".//enclave[@path='/ur5e_pick/first_goal']")
    called = [one.text for one in enclave.findall(".//actions[@call='ALLOW']/action")]
    assert called == ["/arm_trajectory/follow_joint_trajectory"]
