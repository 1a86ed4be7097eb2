"""The bridge to an interpreter that has no ROS, or that ends: it is told, and nothing is left behind."""

from __future__ import annotations

import os
import stat
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import pytest

from cellc.mock.errors import MockError
from cellc.mock.ros.bridge import PROGRAM, Bridge

_OTHER_END = """#!{python}
import json, os, socket, struct, subprocess, sys
end = socket.socket(fileno=int(sys.argv[2]))
def take(size):
    taken = b""
    while len(taken) < size:
        piece = end.recv(size - len(taken))
        if not piece:
            os._exit(0)
        taken += piece
    return taken
while True:
    size, kind = struct.unpack("<IB", take(5))
    asked = take(size)
    if kind == 1:
        end.sendall(struct.pack("<IB", size, 1) + asked)  # an echo
        continue
    asked = json.loads(asked)
    if asked["ask"] == "nodes":
        print("the middleware is gone", file=sys.stderr)
        os._exit(3)
    answers = {{"environment": {{"distro": "jazzy"}}, "ended": {{"code": None}}, "heard": {{"error": "it is late"}}}}
    answers["act"] = {{"error": "no moveit_msgs"}}
    answers["settle"] = {{"error": f"{{asked.get('node')}} did not answer"}}
    if asked["ask"] == "start":
        answers["start"] = {{"group": subprocess.Popen(asked["command"], start_new_session=True).pid}}
    answer = json.dumps(answers.get(asked["ask"], {{}})).encode()
    end.sendall(struct.pack("<IB", len(answer), 0) + answer)
"""


@pytest.fixture
def interpreter(tmp_path: Path) -> str:
    """A program that speaks to the bridge whatever it is to run."""
    file = tmp_path / "python"
    file.write_text(_OTHER_END.format(python=sys.executable))
    file.chmod(file.stat().st_mode | stat.S_IXUSR)
    return str(file)


@pytest.mark.skipif(find_spec("rclpy") is not None, reason="this interpreter has rclpy")
def test_an_interpreter_without_rclpy_says_so() -> None:
    with (
        Bridge(sys.executable, {}) as bridge,
        pytest.raises(MockError, match=r"has ended: ModuleNotFoundError: .*rclpy"),
    ):
        bridge.environment()


def test_an_interpreter_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(MockError, match="cannot be run: No such file or directory; name one with --ros-python"):
        Bridge(str(tmp_path / "none"), {})


def test_messages_come_back_in_order_between_answers(interpreter: str) -> None:
    with Bridge(interpreter, dict(os.environ)) as bridge:
        for number in range(3):
            bridge.publish(number, b"x" * number)
        assert bridge.environment() == {"distro": "jazzy"}
        taken = [bridge.take(1.0) for _ in range(3)]
        assert [(each.channel, each.data) for each in taken if each] == [(0, b""), (1, b"x"), (2, b"xx")]
        assert bridge.take() is None


def test_an_action_that_cannot_be_offered_and_a_node_that_is_busy_are_told(interpreter: str) -> None:
    with Bridge(interpreter, os.environ) as bridge:
        with pytest.raises(
            MockError, match="`/move_action` of type `moveit_msgs/action/MoveGroup` cannot be offered: no"
        ):
            bridge.open_action(3, "/move_group", "/move_action", "moveit_msgs/action/MoveGroup")
        assert bridge.settle("/task", 0.1) == "/task did not answer"
        assert bridge.trigger("/task/cancel", 0.1) == ""
        bridge.end_goal(7, 4, {"error_code": {"val": 1}})


def test_an_end_and_an_error_of_the_other_side_are_told(interpreter: str) -> None:
    with Bridge(interpreter, dict(os.environ)) as bridge:
        with pytest.raises(MockError, match="fails: it is late"):
            bridge.heard()
        with pytest.raises(MockError, match="has ended: the middleware is gone"):
            bridge.nodes()


def test_what_was_started_ends_with_the_bridge(interpreter: str) -> None:
    with Bridge(interpreter, dict(os.environ)) as bridge:
        bridge.start(["sleep", "600"])
        group = bridge._group
        assert group is not None
    until_s = time.monotonic() + 30.0
    while _runs(group) and time.monotonic() < until_s:
        time.sleep(0.01)
    assert not _runs(group)


def _runs(pid: int) -> bool:
    status = Path(f"/proc/{pid}/stat")
    return status.exists() and status.read_text().split(") ")[1][0] != "Z"


def test_the_program_stands_alone() -> None:
    assert "cellc" not in {
        line.split()[1].split(".")[0]
        for line in PROGRAM.read_text().splitlines()
        if line.startswith(("import ", "from "))
    }
    assert [each.name for each in PROGRAM.parent.iterdir() if each.name != "__pycache__"] == [PROGRAM.name]
