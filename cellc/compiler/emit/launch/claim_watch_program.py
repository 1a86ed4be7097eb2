#!/usr/bin/env python3
"""Takes claims from a robot that stops, pauses or loses its publisher, and keeps them away until a person acknowledges.

    claim_watch --plan FILE [--host HOST]

Each entry of `watches` in config/bring_up.json has the topics that prove that its robot follows set points. The message
that proves otherwise is acted upon in its callback and remembered: a robot that stops and resumes between two messages
of another topic has stopped. Goals are canceled; controllers and managed motion clients are deactivated. From then on,
and from the start of this program on, each claim is removed again until claim.launch.xml acknowledges on behalf of the
person who authorizes it. That is refused while a proof is missing. This program is not a safety function.
"""

from __future__ import annotations

import argparse
import importlib
import json
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import takewhile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

LOOK_S = 0.1  # period of checks for claims that are back and for topics without a publisher
RETRY_S = 1.0  # how long an answer about claims is waited for
BEST_EFFORT = 1  # controller_manager_msgs/srv/SwitchController: as far as possible
DEACTIVATE = 4  # lifecycle_msgs/msg/Transition
SWITCH, LIST = "controller_manager_msgs/srv/SwitchController", "controller_manager_msgs/srv/ListControllers"
CANCEL, CHANGE = "action_msgs/srv/CancelGoal", "lifecycle_msgs/srv/ChangeState"
ACKNOWLEDGE = "std_srvs/srv/Trigger"


class Ros:
    """One node: every client is there before it is needed, for a new one is discovered for seconds."""

    def __init__(self, enclave: str) -> None:
        import rclpy

        rclpy.init(args=["--ros-args", "--enclave", enclave])
        self._rclpy = rclpy
        self._node = rclpy.create_node("claim_watch", start_parameter_services=False)
        self._clients: dict[str, Any] = {}

    def published(self, topic: str) -> bool:
        return bool(self._node.count_publishers(topic))

    def listen(self, topic: str, kind: str, take: Callable[[Any], None]) -> bool:
        """Subscribe with what the publishers offer; return whether there is one."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        offered = [end.qos_profile for end in self._node.get_publishers_info_by_topic(topic)]
        latched = all(profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for profile in offered)
        reliable = all(profile.reliability == ReliabilityPolicy.RELIABLE for profile in offered)
        qos = QoSProfile(
            depth=100,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
            reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        )
        if offered:
            self._node.create_subscription(loaded(kind), topic, take, qos)
        return bool(offered)

    def serve(self, name: str, kind: str, answer: Callable[[Any, Any], Any]) -> None:
        self._node.create_service(loaded(kind), name, answer)

    def prepare(self, name: str, kind: str) -> None:
        self._clients[name] = self._node.create_client(loaded(kind), name)

    def ask(self, name: str, done: Callable[[Any], None] = lambda _: None, /, **fields: Any) -> None:
        """Send a request; `done` gets the answer when there is one."""
        client = self._clients[name]
        if client.service_is_ready():
            future = client.call_async(client.srv_type.Request(**fields))
            future.add_done_callback(lambda answered: done(answered.result()))

    def run(self, look: Callable[[], None]) -> None:
        """Handle messages and call `look` in its period, forever."""
        self._node.create_timer(LOOK_S, look)
        self._rclpy.spin(self._node)


def loaded(kind: str) -> Any:
    """Return the class of an interface type such as ``std_msgs/msg/Bool``."""
    package, part, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.{part}"), name)


def contradiction(proof: SimpleNamespace, message: Any) -> str:
    """Return what a message says against its proof; empty where it proves it."""
    value, above = getattr(message, proof.field), getattr(proof, "above", None)
    proven = value > above if above is not None else value in proof.values
    return "" if proven else f"{proof.topic} is {value}"


class Watch:
    """One robot of the plan.

    Attributes:
        latched: why nothing may claim it; empty once a person has acknowledged.
        missing: by topic, why its proof does not hold now; empty where it does.
    """

    def __init__(self, ros: Any, entry: SimpleNamespace) -> None:
        self._ros, self._entry = ros, entry
        self._proofs = list(vars(entry.while_hold).values())
        self._heard: set[str] = set()
        self._lost_s, self._asked_s = 0.0, -RETRY_S
        self.latched = "not acknowledged since this program started"
        self.missing = {proof.topic: f"no message on {proof.topic}" for proof in self._proofs}
        ros.serve(entry.acknowledge, ACKNOWLEDGE, self._acknowledge)
        for name, kind in self._services():
            ros.prepare(name, kind)

    def _services(self) -> Iterable[tuple[str, str]]:
        yield f"{self._entry.manager}/switch_controller", SWITCH
        yield f"{self._entry.manager}/list_controllers", LIST
        yield from ((f"{action}/_action/cancel_goal", CANCEL) for action in getattr(self._entry, "actions", ()))
        yield from ((f"{node}/change_state", CHANGE) for node in getattr(self._entry, "nodes", ()))

    def look(self) -> None:
        """Subscribe to what is published by now, and take away claims that are back."""
        for proof in self._proofs:
            if proof.topic not in self._heard and self._ros.listen(proof.topic, proof.type, partial(self._take, proof)):
                self._heard.add(proof.topic)
            if not self._ros.published(proof.topic):
                self._lose(proof.topic, f"{proof.topic} has no publisher")
        if self.latched and time.monotonic() - self._asked_s >= RETRY_S:  # a manager that is held up gets no queue
            self._asked_s = time.monotonic()
            self._ros.ask(f"{self._entry.manager}/list_controllers", self._again)

    def _take(self, proof: SimpleNamespace, message: Any) -> None:
        if absent := contradiction(proof, message):
            self._lose(proof.topic, absent)
        else:
            self.missing[proof.topic] = ""

    def _lose(self, topic: str, why: str) -> None:
        """Latch what a robot says against a claim, and end what it may not outlast."""
        self.missing[topic] = why
        if not self.latched:
            self.latched = why
            self._lost_s = time.monotonic()
            self.end()

    def _again(self, answer: Any) -> None:
        self._asked_s = -RETRY_S
        if self.latched and any(
            known.state == "active" and known.name in self._entry.controllers for known in answer.controller
        ):
            self.end()

    def end(self) -> None:
        """Ask for the end of goals, claims and motion clients together."""
        for action in getattr(self._entry, "actions", ()):
            self._ros.ask(f"{action}/_action/cancel_goal")  # no goal named: all of them
        self._ros.ask(
            f"{self._entry.manager}/switch_controller",
            partial(self._ended, self._lost_s, self.latched),
            deactivate_controllers=list(self._entry.controllers),
            strictness=BEST_EFFORT,
        )
        for node in getattr(self._entry, "nodes", ()):
            self._ros.ask(f"{node}/change_state", transition=loaded("lifecycle_msgs/msg/Transition")(id=DEACTIVATE))

    def _ended(self, lost_s: float, why: str, answer: Any) -> None:
        after_s = time.monotonic() - lost_s
        done = "deactivated" if answer.ok else "not deactivated, will retry (refused)"
        late = f", LATE: planned {self._entry.within_s:g} s" if after_s > self._entry.within_s else ""
        names = ", ".join(self._entry.controllers)
        print(f"{names}: {done} after {after_s:.3f} s{late}: {why}. A person must acknowledge.", flush=True)

    def _acknowledge(self, _: Any, answer: Any) -> Any:
        """Let claims be made again, if each proof holds now."""
        absent = next((why for why in self.missing.values() if why), "")
        answer.success, answer.message = not absent, absent or f"claims of {self._entry.device} may be made"
        if not absent:
            self.latched = ""
        return answer


def main(arguments: Sequence[str]) -> int:
    """Watch; return only when this program is ended."""
    own = [*takewhile(lambda word: word != "--ros-args", arguments)]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plan", type=Path, required=True, help="config/bring_up.json of the package")
    parser.add_argument("--host", default="", help="watch only what this computer watches")
    read = parser.parse_args(own)
    plan = json.loads(read.plan.read_text(encoding="utf-8"), object_hook=lambda entry: SimpleNamespace(**entry))
    ros = Ros(plan.enclave)
    watches = [Watch(ros, entry) for entry in plan.watches if read.host in ("", entry.host)]

    def look() -> None:
        for watch in watches:
            watch.look()

    ros.run(look)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
