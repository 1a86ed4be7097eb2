"""The end of the bridge to a ROS graph on this side: a program under a ROS environment's interpreter, and its socket.

This process has no ROS in it: its libraries want another numpy than the Python of a distribution. The program at the
other end, `program/cellc_bridge.py`, says what a frame on the socket is. It ends when this process does.
"""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import struct
import subprocess
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import asdict
from pathlib import Path
from time import monotonic
from typing import Any

from cellc.contract.entities import Qos
from cellc.contract.frozen import dataclass
from cellc.contract.store.swap import temporary_file
from cellc.mock.errors import MockError

PROGRAM = Path(__file__).with_name("program") / "cellc_bridge.py"
_JSON, _MESSAGE = 0, 1
_HEAD = struct.Struct("<IB")
_CHANNEL = struct.Struct("<H")
_PIECE = 1 << 16
_START_S = 60.0
"""How long the ROS environment may take to import its client library; a cold disk needs some seconds."""
_ANSWER_S = 30.0
_END_S = 10.0
_STDERR = 2
"""What nodes print goes where the messages of cellc go."""


@dataclass(frozen=True, slots=True)
class Received:
    """A message that arrived on a channel, as it is serialized."""

    channel: int
    data: bytes


@dataclass(frozen=True, slots=True)
class GraphEnd:
    """A publisher or subscription on the graph of a node that the bridge does not play.

    Attributes:
        node: its full name.
    """

    node: str
    type: str
    reliability: str
    durability: str


class Bridge:
    """Speaks to the program; used as a context, so that it never outlives the run."""

    def __init__(self, interpreter: str, environment: Mapping[str, str]) -> None:
        """Start the program; it is on the graph when it answers first.

        Args:
            interpreter: Python of a ROS environment.
            environment: of the program.

        Raises:
            MockError: there is no such interpreter, or it has no rclpy.
        """
        if os.name != "posix":
            raise MockError("", "--ros needs a POSIX system")
        self._interpreter = interpreter
        self._group: int | None = None
        self._arrived: deque[Received] = deque()
        self._read = bytearray()
        self._open = ExitStack()
        self._errors = self._open.enter_context(temporary_file())
        self._end, theirs = socket.socketpair()
        try:
            self._child = subprocess.Popen(
                [interpreter, str(PROGRAM), str(theirs.fileno())],
                pass_fds=[theirs.fileno()],
                env=dict(environment),
                stdin=subprocess.DEVNULL,
                stdout=_STDERR,
                stderr=self._errors,
                start_new_session=True,  # Ctrl-C ends cellc, which ends the program
            )
        except OSError as error:
            self._end.close()
            raise MockError(
                "", f"`{interpreter}` cannot be run: {error.strerror}; name one with --ros-python"
            ) from None
        finally:
            theirs.close()

    def __enter__(self) -> Bridge:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the program, which ends what it started, and forget what it sent."""
        self._end.close()
        try:
            self._child.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
        if self._group is not None:  # where the program itself was killed
            with suppress(ProcessLookupError):
                os.killpg(self._group, signal.SIGKILL)
        self._open.close()

    def environment(self) -> dict[str, str]:
        """Return the distribution, the middleware and the domain of the other side."""
        answer = self._ask({"ask": "environment"}, _START_S)
        return {key: str(value) for key, value in answer.items()}

    def nodes(self) -> frozenset[str]:
        """Return the full names of the nodes on the graph that the bridge does not play."""
        return frozenset(self._ask({"ask": "nodes"})["nodes"])

    def heard(self) -> frozenset[int]:
        """Return the channels of publishers whose topics somebody subscribes to."""
        return frozenset(self._ask({"ask": "heard"})["channels"])

    def publishers(self, topic: str) -> tuple[GraphEnd, ...]:
        """Return the publishers of a topic that the bridge does not play."""
        return tuple(GraphEnd(**end) for end in self._ask({"ask": "ends", "topic": topic, "publishers": True})["ends"])

    def subscriptions(self, topic: str) -> tuple[GraphEnd, ...]:
        """Return the subscriptions of a topic that the bridge does not play."""
        return tuple(GraphEnd(**end) for end in self._ask({"ask": "ends", "topic": topic, "publishers": False})["ends"])

    def open_node(self, node: str, parameters: Mapping[str, object]) -> None:
        """Put a node on the graph; one with parameters has the services of parameters, as `ros2 param` asks them."""
        self._ask({"ask": "node", "node": node, "parameters": dict(parameters)})

    def open_publisher(self, channel: int, node: str, topic: str, kind: str, qos: Qos) -> None:
        """Open a publisher of a node.

        Raises:
            MockError: its type is not installed.
        """
        self._opened({"ask": "publish", "channel": channel, "node": node, "topic": topic, "kind": kind}, qos)

    def open_subscription(self, channel: int, node: str, topic: str, kind: str, qos: Qos) -> None:
        """Open a subscription of a node; what arrives is taken under the number of the channel.

        Raises:
            MockError: its type is not installed.
        """
        self._opened({"ask": "subscribe", "channel": channel, "node": node, "topic": topic, "kind": kind}, qos)

    def open_action(self, channel: int, node: str, action: str, kind: str) -> None:
        """Offer an action of a node; goals and requests to cancel are taken under the number of the channel.

        Raises:
            MockError: its type is not installed.
        """
        self._offered({"ask": "act", "channel": channel, "node": node, "name": action, "kind": kind})

    def open_service(self, channel: int, node: str, service: str, kind: str) -> None:
        """Offer a service of a node; requests are taken under the number of the channel.

        Raises:
            MockError: its type is not installed.
        """
        self._offered({"ask": "serve", "channel": channel, "node": node, "name": service, "kind": kind})

    def answer(self, number: int, value: object) -> None:
        """Answer what was asked under a number: whether a goal or a cancel is accepted, or a response."""
        self._ask({"ask": "answer", "number": number, "value": value})

    def end_goal(self, end: int, status: int, result: Mapping[str, object]) -> None:
        """End an accepted goal, by a state of action_msgs/msg/GoalStatus and the fields of its result."""
        self.answer(end, {"status": status, "result": result})

    def feed_back(self, end: int, kind: str, values: Mapping[str, object]) -> None:
        """Publish feedback of a goal of an action of a type."""
        self._ask({"ask": "feedback", "end": end, "kind": kind, "values": values})

    def settle(self, node: str, within_s: float) -> str:
        """Wait until a node has handled what was published so far; return why it has not, or nothing."""
        asked = {"ask": "settle", "node": node, "within_s": within_s}
        return str(self._ask(asked, 2.0 * within_s + _ANSWER_S, may_fail=True).get("error", ""))

    def trigger(self, service: str, within_s: float) -> str:
        """Call a std_srvs/srv/Trigger; return why it was not answered, or nothing."""
        asked = {"ask": "trigger", "service": service, "within_s": within_s}
        return str(self._ask(asked, within_s + _ANSWER_S, may_fail=True).get("error", ""))

    def start(self, command: Sequence[str]) -> None:
        """Start a command in the ROS environment; it ends with the bridge.

        Raises:
            MockError: it cannot be run.
        """
        answer = self._ask({"ask": "start", "command": list(command)}, may_fail=True)
        if "error" in answer:
            raise MockError("", f"`{' '.join(command)}` cannot be run: {answer['error']}")
        self._group = int(answer["group"])

    def exit_code(self) -> int | None:
        """Return the exit code of what was started; None while it runs, or where nothing was."""
        code = self._ask({"ask": "ended"})["code"]
        return None if code is None else int(code)

    def transition(self, node: str, name: str, within_s: float) -> str:
        """Ask a lifecycle node for a transition; return why it was not made, or nothing."""
        asked = {"ask": "transition", "node": node, "name": name, "within_s": within_s}
        return str(self._ask(asked, within_s + _ANSWER_S, may_fail=True).get("error", ""))

    def publish(self, channel: int, data: bytes) -> None:
        """Publish a serialized message."""
        self._send(_MESSAGE, _CHANNEL.pack(channel) + data)

    def take(self, within_s: float = 0.0) -> Received | None:
        """Return what arrived first and was not taken yet; None where nothing arrives in time."""
        until_s = monotonic() + within_s
        while not self._arrived:
            if not self._hear(until_s):
                return None
        return self._arrived.popleft()

    def _offered(self, asked: dict[str, Any]) -> None:
        answer = self._ask(asked, may_fail=True)
        if "error" in answer:
            raise MockError("", f"`{asked['name']}` of type `{asked['kind']}` cannot be offered: {answer['error']}")

    def _opened(self, asked: dict[str, Any], qos: Qos) -> None:
        answer = self._ask({**asked, "qos": asdict(qos)}, may_fail=True)
        if "error" in answer:
            raise MockError("", f"`{asked['topic']}` of type `{asked['kind']}` cannot be opened: {answer['error']}")

    def _ask(self, asked: dict[str, Any], within_s: float = _ANSWER_S, *, may_fail: bool = False) -> dict[str, Any]:
        self._send(_JSON, json.dumps(asked).encode())
        until_s = monotonic() + within_s
        while True:
            answer = self._hear(until_s)
            if answer is None:
                raise MockError("", f"the ROS environment of `{self._interpreter}` did not answer in {within_s:g} s")
            if isinstance(answer, dict):
                if "error" in answer and not may_fail:
                    raise MockError("", f"the ROS side, run by `{self._interpreter}`, fails: {answer['error']}")
                return answer

    def _send(self, kind: int, rest: bytes) -> None:
        try:
            self._end.sendall(_HEAD.pack(len(rest), kind) + rest)
        except OSError:
            raise self._gone() from None

    def _hear(self, until_s: float) -> dict[str, Any] | Received | None:
        """Take the next frame; a message is kept in order, an answer is returned. None where no frame comes in time."""
        while (frame := self._whole()) is None:
            ready, _, _ = select.select([self._end], [], [], max(0.0, until_s - monotonic()))
            if not ready:
                return None
            try:
                piece = self._end.recv(_PIECE)
            except OSError:
                piece = b""
            if not piece:
                raise self._gone()
            self._read += piece
        kind, rest = frame
        if kind == _MESSAGE:
            message = Received(_CHANNEL.unpack_from(rest)[0], rest[_CHANNEL.size :])
            self._arrived.append(message)
            return message
        answer: dict[str, Any] = json.loads(rest)
        return answer

    def _whole(self) -> tuple[int, bytes] | None:
        if len(self._read) < _HEAD.size:
            return None
        size, kind = _HEAD.unpack_from(self._read)
        if len(self._read) < _HEAD.size + size:
            return None
        rest = bytes(self._read[_HEAD.size : _HEAD.size + size])
        del self._read[: _HEAD.size + size]
        return kind, rest

    def _gone(self) -> MockError:
        """Say why the program is no longer there, in its own last line."""
        self._child.wait()
        self._errors.seek(0)
        lines = self._errors.read().decode(errors="replace").strip().splitlines()
        why = lines[-1].strip() if lines else f"exit code {self._child.returncode}"
        return MockError("", f"the ROS side, run by `{self._interpreter}`, has ended: {why}")
