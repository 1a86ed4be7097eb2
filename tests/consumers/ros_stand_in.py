"""Stands in for the nodes of one process: opens their ends with the real client library, talks, and tells what it met.

Run as a program, one for each enclave: a job as JSON on the first line of standard input. It tells in a line of JSON
what was refused as soon as all is opened, and what arrived when its standard input ends, or when it has heard as often
as it was told to wait for. Who publishes says something all the time, who requests asks until it is answered. Types
that are not installed are stood in for: access is granted to names alone.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any

import rclpy
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import Log
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from tests.consumers.ros_endpoints import ends

_OF_ACTION = {
    "execute": {"reply": ("send_goal", "cancel_goal", "get_result"), "publish": ("feedback", "status")},
    "call": {"request": ("send_goal", "cancel_goal", "get_result"), "subscribe": ("feedback", "status")},
}

_SAID = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_HEARD = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
_EVERY_S = 0.05
_AT_MOST_S = 300.0
_AGAIN_S = 3.0  # an answer may be lost while both sides still find each other


def kind_of(name: str, stand_in: Any) -> Any:
    """Return the class of an interface type, or what stands in for it where it is not installed."""
    try:
        package, part, last = name.split("/")
        return getattr(importlib.import_module(f"{package}.{part}"), last)
    except (ImportError, ValueError, AttributeError):
        return stand_in


def filled(message: Any, values: Any) -> Any:
    """Return a message with values in its fields; those of transforms are pairs of frames."""
    for field, value in (values or {}).items():
        if field == "transforms":
            one = kind_of("geometry_msgs/msg/TransformStamped", None)
            value = [one(child_frame_id=child) for _, child in value]
            for transform, (parent, _) in zip(value, values[field], strict=True):
                transform.header.frame_id = parent
        setattr(message, field, value)
    return message


class Process:
    """The nodes of one enclave."""

    def __init__(self, job: Any) -> None:
        self._job, self._open = job, True
        self._heard: Counter[str] = Counter()
        self._answered: Counter[str] = Counter()
        self.refused: list[tuple[str, str, str]] = []
        self._says: list[Callable[[], None]] = []
        self._context = Context()
        self._nodes: list[Any] = []
        try:
            rclpy.init(args=["--ros-args", "--enclave", job["enclave"]], context=self._context)
        except Exception as error:
            self.refused.append(("start", job["enclave"], str(error)))
            return
        for wanted in job["nodes"]:
            self._tried("start", wanted["name"], partial(self._start, wanted))

    def _tried(self, right: str, name: str, call: Callable[[], None]) -> None:
        try:
            call()
        except Exception as error:
            self.refused.append((right, name, str(error)))

    def _start(self, wanted: Any) -> None:
        kind: Any = LifecycleNode if wanted.get("lifecycle") else Node
        node = kind(wanted["name"], namespace=wanted.get("namespace") or "/", context=self._context)
        self._nodes.append(node)
        for name, value in wanted.get("parameters", {}).items():
            node.declare_parameter(name, value)
        own = set(ends(node))
        for right, name, kind_name in wanted["ends"]:
            if (right, name) not in own:
                self._open_one(node, right, name, kind_name)

    def _open_one(self, node: Any, right: str, name: str, kind: str) -> None:
        if right in _OF_ACTION and (right == "call" or kind_of(kind, None) is None):
            for part, names in _OF_ACTION[right].items():
                for one in names:
                    self._open_one(node, part, f"{name}/_action/{one}", "")
        else:
            self._tried(right, name, lambda: getattr(self, f"_{right}")(node, name, kind))

    def _publish(self, node: Any, name: str, kind: str) -> None:
        message = filled(kind_of(kind, Log)(), self._job.get("says", {}).get(name))
        publisher = node.create_publisher(type(message), name, _SAID)
        self._says.append(lambda: publisher.publish(message))

    def _subscribe(self, node: Any, name: str, kind: str) -> None:
        node.create_subscription(kind_of(kind, Log), name, lambda _: self._heard.update([name]), _HEARD)

    def _reply(self, node: Any, name: str, kind: str) -> None:
        group = ReentrantCallbackGroup()
        node.create_service(
            kind_of(kind, GetState), name, lambda *both: self._answer(name, *both), callback_group=group
        )

    def _request(self, node: Any, name: str, kind: str) -> None:
        service = kind_of(kind, GetState)
        client, asked = node.create_client(service, name), [-_AGAIN_S]

        def ask() -> None:
            if not self._heard[name] and time.monotonic() - asked[0] > _AGAIN_S and client.service_is_ready():
                asked[0] = time.monotonic()
                client.call_async(service.Request()).add_done_callback(lambda _: self._heard.update([name]))

        self._says.append(ask)

    def _execute(self, node: Any, name: str, kind: str) -> None:
        from rclpy.action import ActionServer, CancelResponse

        action = kind_of(kind, None)

        def execute(handle: Any) -> Any:
            self._answered.update([name])
            until = time.monotonic() + 0.5
            while time.monotonic() < until:
                if handle.is_cancel_requested:
                    handle.canceled()
                    return action.Result()
                time.sleep(0.01)
            handle.succeed()
            return action.Result()

        group, accepted = ReentrantCallbackGroup(), CancelResponse.ACCEPT
        ActionServer(node, action, name, execute, callback_group=group, cancel_callback=lambda _: accepted)

    def _answer(self, name: str, request: Any, response: Any) -> Any:
        """Answer as a controller manager does; whatever else is asked is answered with what is empty."""
        self._answered.update([name])
        home, _, verb = name.rpartition("/")
        held = self._job.get("managers", {}).get(home, {"controllers": {}, "hardware": {}})
        if verb == "list_controllers":
            one = kind_of("controller_manager_msgs/msg/ControllerState", None)
            response.controller = [one(name=entry, state=state) for entry, state in held["controllers"].items()]
        elif verb == "list_hardware_components":
            one = kind_of("controller_manager_msgs/msg/HardwareComponentState", None)
            response.component = [one(name=entry) for entry in held["hardware"]]
            for component in response.component:
                component.state.label = held["hardware"][component.name]
        elif verb == "switch_controller":
            held["controllers"] |= dict.fromkeys(request.deactivate_controllers, "inactive")
            held["controllers"] |= dict.fromkeys(request.activate_controllers, "active")
            response.ok = True
        elif verb == "set_hardware_component_state":
            held["hardware"][request.name] = request.target_state.label
            response.ok = True
        return response

    def talk(self) -> dict[str, Any]:
        """Talk until nothing more is read from standard input, and tell what arrived."""
        executor = MultiThreadedExecutor(4, context=self._context)
        for node in self._nodes:
            executor.add_node(node)
        threading.Thread(target=self._until_closed, daemon=True).start()
        ends_at = time.monotonic() + _AT_MOST_S
        while self._open and not self._has_met() and time.monotonic() < ends_at:
            for say in self._says:
                say()
            until = time.monotonic() + _EVERY_S
            while time.monotonic() < until:
                executor.spin_once(timeout_sec=0.01)
        return {"heard": self._heard, "answered": self._answered}

    def _has_met(self) -> bool:
        until = self._job.get("until", {})
        return bool(until) and all(self._heard[name] >= times for name, times in until.items())

    def _until_closed(self) -> None:
        sys.stdin.read()
        self._open = False


def main() -> None:
    """Take the job, and leave without waiting for threads of the middleware."""
    process = Process(json.loads(sys.stdin.readline()))
    print(json.dumps({"refused": process.refused}), flush=True)
    print(json.dumps(process.talk()), flush=True)
    os._exit(0)


if __name__ == "__main__":
    main()
