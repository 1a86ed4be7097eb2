"""Carries messages between cellc and a ROS graph, for the interpreter of a ROS environment, which has no cellc in it.

Started by cellc as ``cellc_bridge.py FD``, where FD is one end of a socket pair. What is sent on it are frames: the
length of the rest as uint32, its kind as uint8, and the rest. JSON (kind 0) asks and answers; a message (kind 1) is the
number of a channel as uint16, and the message as it is serialized. It ends when the other end of the socket does, and
ends what it started.

Types are imported by their names from the ROS installation; messages of topics are not read here (rclpy publishes and
subscribes serialized ones: https://docs.ros.org/en/jazzy/p/rclpy/rclpy.node.html). Goals, results and requests are sent
as JSON, field by field: their definitions differ between distributions. What asks for an answer has a number, under
which `answer` gives it.
"""

from __future__ import annotations

import importlib
import itertools
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Generator
from contextlib import suppress
from typing import Any

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future

JSON, MESSAGE = 0, 1
HEAD = struct.Struct("<IB")
CHANNEL = struct.Struct("<H")
END_S = 3.0
RESULT_S = 900
"""How long a result can be asked for: the default of rcl_action before Kilted."""
ENDS = {4: "succeed", 5: "canceled", 6: "abort"}
"""By the states of action_msgs/msg/GoalStatus."""


def imported(kind: str) -> Any:
    """Return the class of an interface type such as ``sensor_msgs/msg/Image``."""
    package, part, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.{part}"), name)


def profile(stated: dict[str, Any]) -> QoSProfile:
    """Return a profile; durations are in seconds, and infinite where they are null."""
    qos = QoSProfile(
        history=HistoryPolicy[stated["history"].upper()],
        depth=stated["depth"],
        reliability=ReliabilityPolicy[stated["reliability"].upper()],
        durability=DurabilityPolicy[stated["durability"].upper()],
        liveliness=LivelinessPolicy[stated["liveliness"].upper()],
    )
    for policy, key in (("deadline", "deadline_s"), ("lifespan", "lifespan_s")):
        if stated[key] is not None:
            setattr(qos, policy, Duration(nanoseconds=round(stated[key] * 1e9)))
    if stated["lease_duration_s"] is not None:
        qos.liveliness_lease_duration = Duration(nanoseconds=round(stated["lease_duration_s"] * 1e9))
    return qos


def full_name(name: str, namespace: str) -> str:
    """Return the fully qualified name of a node."""
    return f"{namespace.rstrip('/')}/{name}"


def plain(value: Any) -> Any:
    """Return a message as JSON has it: a mapping of its fields."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, (bytes, bytearray)):
        return list(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    return [plain(each) for each in value] if isinstance(value, (list, tuple)) else value


def filled(message: Any, values: dict[str, Any]) -> Any:
    """Return a message with values in its fields; a field that this distribution does not have is left out."""
    kinds = message.get_fields_and_field_types()
    for name, value in values.items():
        if name not in kinds:
            continue
        if isinstance(value, dict):
            filled(getattr(message, name), value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            package, element = re.findall(r"(\w+)/(\w+)", kinds[name])[0]
            made = imported(f"{package}/msg/{element}")
            setattr(message, name, [filled(made(), each) for each in value])
        else:
            setattr(message, name, value)
    return message


class Turn:
    """Lets other callbacks run once."""

    def __await__(self) -> Generator[None, None, None]:
        yield


class Bridge:
    """The nodes that cellc plays, in one process."""

    def __init__(self, end: socket.socket) -> None:
        """Bind the end of the socket; nothing is on the graph yet but a node that looks."""
        self._end = end
        self._sending = threading.Lock()
        self._context = Context()
        rclpy.init(args=[], context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._nodes: dict[str, Node] = {}
        self._publishers: dict[int, Any] = {}
        self._started: subprocess.Popen[bytes] | None = None
        self._numbers = itertools.count(1)
        self._awaited: dict[int, Future] = {}
        self._requests: dict[int, tuple[int, Future]] = {}
        self._handles: dict[int, Any] = {}
        self._clients: dict[str, Any] = {}
        self._looking = self._node("/cellc_mock")
        threading.Thread(target=self._spin, daemon=True).start()

    def run(self) -> None:
        """Answer until the other end is gone."""
        try:
            while True:
                size, kind = HEAD.unpack(self._take(HEAD.size))
                rest = self._take(size)
                if kind == MESSAGE:
                    self._publishers[CHANNEL.unpack_from(rest)[0]].publish(bytes(rest[CHANNEL.size :]))
                else:
                    self._answer(json.loads(rest))
        except (EOFError, ConnectionError):
            self._end_started()

    def _end_started(self) -> None:
        """End what was started, and all that it started."""
        if self._started is None:
            return
        for number in (signal.SIGINT, signal.SIGKILL):
            with suppress(ProcessLookupError):
                os.killpg(self._started.pid, number)
            with suppress(subprocess.TimeoutExpired):
                self._started.wait(END_S)

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            return

    def _take(self, size: int) -> bytes:
        taken = bytearray()
        while len(taken) < size:
            piece = self._end.recv(size - len(taken))
            if not piece:
                raise EOFError
            taken += piece
        return bytes(taken)

    def _send(self, kind: int, rest: bytes) -> None:
        with self._sending:
            self._end.sendall(HEAD.pack(len(rest), kind) + rest)

    def _answer(self, asked: dict[str, Any]) -> None:
        try:
            answer = getattr(self, f"on_{asked.pop('ask')}")(**asked)
        except Exception as error:  # whatever an installation answers is reported, and the bridge goes on
            answer = {"error": f"{type(error).__name__}: {error}"}
        self._send(JSON, json.dumps(answer).encode())

    def _node(self, name: str, parameters: dict[str, Any] | None = None) -> Node:
        if name not in self._nodes:
            namespace, _, bare = name.rpartition("/")
            node = Node(
                bare,
                namespace=namespace or "/",
                context=self._context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=bool(parameters),
                parameter_overrides=[Parameter(key, value=value) for key, value in (parameters or {}).items()],
                automatically_declare_parameters_from_overrides=True,
            )
            self._nodes[name] = node
            self._executor.add_node(node)
        return self._nodes[name]

    def on_environment(self) -> dict[str, Any]:
        """Say what is installed here."""
        return {
            "distro": os.environ.get("ROS_DISTRO", ""),
            "rmw": rclpy.get_rmw_implementation_identifier(),
            "domain": os.environ.get("ROS_DOMAIN_ID", "0"),
        }

    def on_nodes(self) -> dict[str, Any]:
        """Name the nodes on the graph that are not played here, and those played here that are there twice."""
        seen = Counter(full_name(name, namespace) for name, namespace in self._looking.get_node_names_and_namespaces())
        return {"nodes": sorted((seen - Counter(self._nodes.keys())).keys())}

    def on_ends(self, topic: str, publishers: bool) -> dict[str, Any]:
        """Describe the publishers of a topic, or its subscriptions, of nodes that are not played here."""
        by_topic = self._looking.get_publishers_info_by_topic if publishers else None
        found = (by_topic or self._looking.get_subscriptions_info_by_topic)(topic)
        return {
            "ends": [
                {
                    "node": name,
                    "type": end.topic_type,
                    "reliability": end.qos_profile.reliability.name.lower(),
                    "durability": end.qos_profile.durability.name.lower(),
                }
                for end in found
                if (name := full_name(end.node_name, end.node_namespace)) not in self._nodes
            ]
        }

    def on_heard(self) -> dict[str, Any]:
        """Name the channels whose topics somebody subscribes to."""
        return {"channels": [number for number, each in self._publishers.items() if each.get_subscription_count()]}

    def on_node(self, node: str, parameters: dict[str, Any]) -> dict[str, Any]:
        """Put a node on the graph; one with parameters has their services."""
        self._node(node, parameters)
        return {}

    def on_publish(self, channel: int, node: str, topic: str, kind: str, qos: dict[str, Any]) -> dict[str, Any]:
        """Open a publisher of a node."""
        self._publishers[channel] = self._node(node).create_publisher(imported(kind), topic, profile(qos))
        return {}

    def on_subscribe(self, channel: int, node: str, topic: str, kind: str, qos: dict[str, Any]) -> dict[str, Any]:
        """Open a subscription of a node; what arrives is sent on under the number of the channel."""
        head = CHANNEL.pack(channel)
        self._node(node).create_subscription(
            imported(kind), topic, lambda data: self._send(MESSAGE, head + bytes(data)), profile(qos), raw=True
        )
        return {}

    def _tell(self, channel: int, said: dict[str, Any]) -> None:
        self._send(MESSAGE, CHANNEL.pack(channel) + json.dumps(said).encode())

    def _await(self) -> tuple[int, Future]:
        number = next(self._numbers)
        self._awaited[number] = Future(executor=self._executor)
        return number, self._awaited[number]

    async def _inquire(self, channel: int, said: dict[str, Any]) -> Any:
        """Send what asks for an answer, and return the answer; other callbacks run meanwhile."""
        number, answer = self._await()
        self._tell(channel, {**said, "number": number})
        return await answer

    def on_answer(self, number: int, value: Any) -> dict[str, Any]:
        """Take an answer."""
        answer = self._awaited.pop(number)

        def give() -> None:
            answer.set_result(value)
            self._look_again()

        self._executor.create_task(give)
        return {}

    def _look_again(self) -> None:
        """Let the executor ask its tasks again before it waits: one that awaits a result was asked too early."""
        self._executor.create_task(lambda: None)

    def on_serve(self, channel: int, node: str, name: str, kind: str) -> dict[str, Any]:
        """Offer a service of a node; each request is asked for."""
        made = imported(kind)

        async def respond(request: Any, response: Any) -> Any:
            return filled(response, await self._inquire(channel, {"request": plain(request)}))

        self._node(node).create_service(made, name, respond, callback_group=ReentrantCallbackGroup())
        return {}

    def on_act(self, channel: int, node: str, name: str, kind: str) -> dict[str, Any]:
        """Offer an action of a node; each goal is asked for, and ends as it is answered under the number of its end."""
        made = imported(kind)

        async def decide(request: Any) -> GoalResponse:
            end, ended = self._await()
            if await self._inquire(channel, {"goal": plain(request), "end": end}):
                self._requests[id(request)] = end, ended
                return GoalResponse.ACCEPT
            self._awaited.pop(end)
            return GoalResponse.REJECT

        async def execute(handle: Any) -> Any:
            end, awaited = self._requests.pop(id(handle.request))
            self._handles[end] = handle
            ended = await awaited
            while ended["status"] == 5 and handle.status == 2:  # the request to cancel is still being answered
                self._look_again()
                await Turn()
            getattr(handle, ENDS[ended["status"]])()
            del self._handles[end]
            return filled(made.Result(), ended["result"])

        async def cancel(handle: Any) -> CancelResponse:
            end = next((end for end, each in self._handles.items() if each is handle), 0)
            accepted = await self._inquire(channel, {"cancel": end})
            return CancelResponse.ACCEPT if accepted else CancelResponse.REJECT

        ActionServer(
            self._node(node),
            made,
            name,
            execute_callback=execute,
            goal_callback=decide,
            cancel_callback=cancel,
            callback_group=ReentrantCallbackGroup(),
            result_timeout=RESULT_S,
        )
        return {}

    def on_feedback(self, end: int, kind: str, values: dict[str, Any]) -> dict[str, Any]:
        """Publish feedback of a goal that executes."""
        if end in self._handles:
            self._handles[end].publish_feedback(filled(imported(kind).Feedback(), values))
        return {}

    def on_settle(self, node: str, within_s: float) -> dict[str, Any]:
        """Wait until a node has handled what was published: it answers requests after the messages before them.

        It is asked twice: what it sent before its second answer has arrived here.
        """
        for _ in range(2):
            error, _ = self._call(f"{node}/get_parameters", "rcl_interfaces/srv/GetParameters", within_s)
            if error:
                return {"error": error}
        return {}

    def on_trigger(self, service: str, within_s: float) -> dict[str, Any]:
        """Call a service that has no arguments."""
        error, _ = self._call(service, "std_srvs/srv/Trigger", within_s)
        return {"error": error} if error else {}

    def _call(self, service: str, kind: str, within_s: float, request: Any = None) -> tuple[str, Any]:
        """Call a service; return why it was not answered, or nothing, and the response."""
        made = imported(kind)
        if service not in self._clients:
            self._clients[service] = self._looking.create_client(made, service)
        client, until = self._clients[service], time.monotonic() + within_s
        if not client.service_is_ready() and not client.wait_for_service(timeout_sec=within_s):
            return f"{service} does not exist", None
        answered = threading.Event()
        future = client.call_async(made.Request() if request is None else request)
        future.add_done_callback(lambda _: answered.set())
        if not answered.wait(max(0.0, until - time.monotonic())):
            client.remove_pending_request(future)
            return f"{service} did not answer within {within_s:g} s", None
        return "", future.result()

    def on_start(self, command: list[str]) -> dict[str, Any]:
        """Start a command; what it prints goes where this program's output goes."""
        self._started = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=1, stderr=1, start_new_session=True)
        return {"group": self._started.pid}

    def on_ended(self) -> dict[str, Any]:
        """Return the exit code of what was started; null while it runs, or where nothing was."""
        return {"code": None if self._started is None else self._started.poll()}

    def on_transition(self, node: str, name: str, within_s: float) -> dict[str, Any]:
        """Ask a lifecycle node for a transition, ``configure`` or ``activate``."""
        kind, state = "lifecycle_msgs/srv/ChangeState", imported("lifecycle_msgs/msg/Transition")
        number = {"configure": state.TRANSITION_CONFIGURE, "activate": state.TRANSITION_ACTIVATE}[name]
        request = imported(kind).Request(transition=state(id=number))
        error, response = self._call(f"{node}/change_state", kind, within_s, request)
        return {"error": error or f"{node} refused to {name}"} if error or not response.success else {}


def main() -> None:
    """Run the bridge at the end of the socket whose number is the argument."""
    # A worker of cellc hears no Ctrl-C, and what it starts inherits that; nodes are ended by SIGINT.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGHUP})
    Bridge(socket.socket(fileno=int(sys.argv[1]))).run()
    os._exit(0)  # rclpy's threads may be within a callback; nothing is left to be done


if __name__ == "__main__":
    main()
