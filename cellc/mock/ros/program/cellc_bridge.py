"""Carries messages between cellc and a ROS graph, for the interpreter of a ROS environment, which has no cellc in it.

Started by cellc as ``cellc_bridge.py FD``, where FD is one end of a socket pair. What is sent on it are frames: the
length of the rest as uint32, its kind as uint8, and the rest. JSON (kind 0) asks and answers; a message (kind 1) is the
number of a channel as uint16, and the message as it is serialized. It ends when the other end of the socket does, and
ends what it started.

Types are imported by their names from the ROS installation; messages are not read here (rclpy publishes and subscribes
serialized ones: https://docs.ros.org/en/jazzy/p/rclpy/rclpy.node.html).
"""

from __future__ import annotations

import importlib
import json
import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from contextlib import suppress
from typing import Any

import rclpy
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

JSON, MESSAGE = 0, 1
HEAD = struct.Struct("<IB")
CHANNEL = struct.Struct("<H")
END_S = 3.0


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

    def _node(self, name: str) -> Node:
        if name not in self._nodes:
            namespace, _, bare = name.rpartition("/")
            node = Node(
                bare,
                namespace=namespace or "/",
                context=self._context,
                use_global_arguments=False,
                enable_rosout=False,
                start_parameter_services=False,
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
        """Name the nodes on the graph that are not played here."""
        seen = {full_name(name, namespace) for name, namespace in self._looking.get_node_names_and_namespaces()}
        return {"nodes": sorted(seen - set(self._nodes))}

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

    def on_start(self, command: list[str]) -> dict[str, Any]:
        """Start a command; what it prints goes where this program's output goes."""
        out = 1
        self._started = subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=out, stderr=out, start_new_session=True
        )
        return {"group": self._started.pid}

    def on_ended(self) -> dict[str, Any]:
        """Return the exit code of what was started; null while it runs, or where nothing was."""
        return {"code": None if self._started is None else self._started.poll()}

    def on_transition(self, node: str, name: str, within_s: float) -> dict[str, Any]:
        """Ask a lifecycle node for a transition, ``configure`` or ``activate``."""
        service, state = imported("lifecycle_msgs/srv/ChangeState"), imported("lifecycle_msgs/msg/Transition")
        client = self._looking.create_client(service, f"{node}/change_state")
        until = time.monotonic() + within_s
        try:
            if not client.wait_for_service(timeout_sec=within_s):
                return {"error": f"{node}/change_state does not exist"}
            number = {"configure": state.TRANSITION_CONFIGURE, "activate": state.TRANSITION_ACTIVATE}[name]
            future = client.call_async(service.Request(transition=state(id=number)))
            while not future.done() and time.monotonic() < until:
                time.sleep(0.005)
            if not future.done():
                return {"error": f"{node}/change_state did not answer within {within_s:g} s"}
            return {} if future.result().success else {"error": f"{node} refused to {name}"}
        finally:
            self._looking.destroy_client(client)


def main() -> None:
    """Run the bridge at the end of the socket whose number is the argument."""
    Bridge(socket.socket(fileno=int(sys.argv[1]))).run()
    os._exit(0)  # rclpy's threads may be within a callback; nothing is left to be done


if __name__ == "__main__":
    main()
