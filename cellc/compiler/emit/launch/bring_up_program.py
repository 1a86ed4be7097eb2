#!/usr/bin/env python3
"""Runs the steps of config/bring_up.json: waits for the proof of each, sends its request once, checks the effect.

    bring_up --plan FILE --target mock|sim|real [--host HOST] [--release DEVICE] PHASE...  run the steps of phases
    bring_up --plan FILE --target mock|sim|real move -- PROGRAM ARGUMENT...  prove, then run PROGRAM while claims hold

A step that fails prints what is missing and ends this with 1. It enables no drive, and restores no claim by itself.
"""

from __future__ import annotations

import argparse
import ctypes
import importlib
import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, takewhile
from pathlib import Path
from types import SimpleNamespace
from typing import Any

ANSWER_S = 3.0  # wait for one answer; an unanswered request is repeated
UNSAID_S = 1.0  # silence of a publisher that speaks of changes alone
UNSEEN_S = 10.0  # a participant that has not seen a service for this long is created again
LOOK_S = 0.2  # period of checks
LOST = 3  # checks in a row without a claim before the program behind it is stopped; one may be a late answer
PATIENCE_S = 0.0  # replaces the deadlines of the plan where it is not 0
MANIFEST = Path("manifest.json")  # of the package, beside the folder of the plan
STRICT = 2  # controller_manager_msgs/srv/SwitchController: all or nothing
TRANSITIONS, ACTIVE = {"configure": 1, "activate": 3}, 3  # lifecycle_msgs/msg/Transition; lifecycle_msgs/msg/State
FROM = {"inactive": ("inactive", "active"), "active": ("active",)}  # an active controller was inactive before
# A child gets SIGINT when this program ends, even by a kill (prctl(2), PR_SET_PDEATHSIG).
END_WITH_PARENT = partial(ctypes.CDLL(None).prctl, 1, signal.SIGINT) if sys.platform == "linux" else None


class UnansweredError(Exception):
    """The service is missing or did not answer in time."""


class Graph:
    """One participant of the ROS graph, with the newest message of each topic."""

    def __init__(self, name: str, enclave: str) -> None:
        self._name, self._enclave = name, enclave
        self.on_message: Any = lambda topic, message: None
        self._unseen_since: dict[str, float] = {}
        self._join()

    def _join(self) -> None:
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor

        self._context = Context()
        rclpy.init(args=["--ros-args", "--enclave", self._enclave], context=self._context, domain_id=None)
        self._node = rclpy.create_node(self._name, context=self._context, start_parameter_services=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._clients: dict[str, Any] = {}
        self._heard: dict[str, Any] = {}
        self._parents: dict[str, str] = {}
        self._listened: dict[str, float] = {}  # since when

    def leave(self) -> None:
        self._node.destroy_node()
        self._context.try_shutdown()

    def spin(self, seconds: float) -> None:
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self._executor.spin_once(timeout_sec=left)

    def nodes(self) -> list[str]:
        return [f"{space.rstrip('/')}/{name}" for name, space in self._node.get_node_names_and_namespaces()]

    def serves(self, name: str) -> bool:
        return any(name == seen for seen, _ in self._node.get_service_names_and_types())

    def ask(self, kind: str, name: str, answer_s: float = ANSWER_S, /, **fields: Any) -> Any:
        """Ask a service once and return its answer."""
        service = _loaded(kind)
        client = self._clients[name] = self._clients.get(name) or self._node.create_client(service, name)
        if not client.service_is_ready():
            self._miss(name)
            raise UnansweredError(f"no service {name}")
        self._unseen_since.pop(name, None)
        future, until = client.call_async(service.Request(**fields)), time.monotonic() + answer_s
        while not future.done():
            if time.monotonic() > until:
                client.remove_pending_request(future)
                raise UnansweredError(f"{name} did not answer within {answer_s:g} s")
            self._executor.spin_once(timeout_sec=0.05)
        return future.result()

    def _miss(self, name: str) -> None:
        if time.monotonic() - self._unseen_since.setdefault(name, time.monotonic()) > UNSEEN_S:
            self._unseen_since.clear()
            self.leave()
            self._join()

    def heard(self, topic: str, kind: str) -> Any:
        if topic not in self._listened and (publishers := self._node.get_publishers_info_by_topic(topic)):
            from rclpy.qos import DurabilityPolicy

            latched = all(end.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for end in publishers)
            self._listen(topic, kind, latched, partial(self._take, topic))
        # A message without a publisher is outdated, even with the wanted value.
        return self._heard.get(topic) if self._node.count_publishers(topic) else None

    def _take(self, topic: str, message: Any) -> None:
        self._heard[topic] = message
        self.on_message(topic, message)

    def silent_s(self, topic: str) -> float:
        """Return for how long a publisher that has not spoken yet has been listened to."""
        since = self._listened.get(topic, math.inf)
        return time.monotonic() - since if self._node.count_publishers(topic) else 0.0

    def connects(self, parent: str, child: str) -> bool:
        for topic, latched in (("/tf", False), ("/tf_static", True)):
            if topic not in self._listened:
                self._listen(topic, "tf2_msgs/msg/TFMessage", latched, self._place)
        return bool(self._above(parent) & self._above(child))

    def _place(self, message: Any) -> None:
        for edge in message.transforms:
            self._parents[edge.child_frame_id.lstrip("/")] = edge.header.frame_id.lstrip("/")

    def _above(self, frame: str) -> set[str]:
        known = {frame} if frame in self._parents or frame in self._parents.values() else set()
        while known and frame in self._parents and self._parents[frame] not in known:
            frame = self._parents[frame]
            known.add(frame)
        return known

    def _listen(self, topic: str, kind: str, latched: bool, take: Any) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        reliability = ReliabilityPolicy.RELIABLE if latched else ReliabilityPolicy.BEST_EFFORT
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=100, reliability=reliability, durability=durability)
        self._node.create_subscription(_loaded(kind), topic, take, qos)
        self._listened[topic] = time.monotonic()


def _loaded(kind: str) -> Any:
    """Return the class of an interface type such as ``std_msgs/msg/Bool``."""
    package, part, name = kind.split("/")
    return getattr(importlib.import_module(f"{package}.{part}"), name)


def listed_controllers(graph: Graph, manager: str) -> Any:
    return graph.ask("controller_manager_msgs/srv/ListControllers", f"{manager}/list_controllers").controller


class Unmet:
    """Why a proof does not hold, by its kind; an empty text where it holds."""

    def __init__(self, graph: Graph) -> None:
        self._graph = graph

    def reason(self, proof: SimpleNamespace) -> str:
        return str(getattr(self, f"_{proof.kind}")(proof))

    def _node(self, proof: SimpleNamespace) -> str:
        return "" if proof.node in self._graph.nodes() else f"no node {proof.node}"

    def _lifecycle(self, proof: SimpleNamespace) -> str:
        state = self._graph.ask("lifecycle_msgs/srv/GetState", f"{proof.node}/get_state").current_state.label
        return "" if state in FROM[proof.state] else f"{proof.node} must be {proof.state}, got {state}"

    def _controller(self, proof: SimpleNamespace) -> str:
        listed = listed_controllers(self._graph, proof.manager)
        state = next((entry.state for entry in listed if entry.name == proof.controller), "not loaded")
        return "" if state in FROM[proof.state] else f"controller {proof.controller} must be {proof.state}, got {state}"

    def _hardware(self, proof: SimpleNamespace) -> str:
        kind, name = "controller_manager_msgs/srv/ListHardwareComponents", "list_hardware_components"
        listed = self._graph.ask(kind, f"{proof.manager}/{name}").component
        state = next((entry.state.label for entry in listed if entry.name == proof.component), "missing")
        return "" if state == proof.state else f"hardware {proof.component} must be {proof.state}, got {state}"

    def _topic(self, proof: SimpleNamespace) -> str:
        message = self._graph.heard(proof.topic, proof.type)
        if message is not None:
            return contradiction(proof, message)
        unsaid = getattr(proof, "unsaid", False) and self._graph.silent_s(proof.topic) > UNSAID_S
        return "" if unsaid else f"no message on {proof.topic}"

    def _action(self, proof: SimpleNamespace) -> str:
        return "" if self._graph.serves(f"{proof.action}/_action/send_goal") else f"no server for {proof.action}"

    def _transform(self, proof: SimpleNamespace) -> str:
        there = self._graph.connects(proof.parent, proof.child)
        return "" if there else f"no transform from {proof.parent} to {proof.child}"

    def _alone(self, proof: SimpleNamespace) -> str:
        twice = ", ".join(name for name in proof.nodes if self._graph.nodes().count(name) > 1)
        return f"expected one node {twice}, got two: another cell with these names runs in this domain" if twice else ""

    def _mock(self, proof: SimpleNamespace) -> str:
        service = f"{proof.node}/get_parameters"
        answer = self._graph.ask("rcl_interfaces/srv/GetParameters", service, names=["robot_description"])
        text = answer.values[0].string_value if answer.values else ""
        used = {part.partition("</plugin>")[0].strip() for part in text.split("<plugin>")[1:]}
        foreign = ", ".join(sorted(used - set(proof.plugins))) if used else "no hardware"
        return f"{proof.node} must describe only {', '.join(proof.plugins)}, got {foreign}" if foreign else ""


def contradiction(proof: SimpleNamespace, message: Any) -> str:
    """Return what a message says against its proof; empty where it proves it."""
    value, above = getattr(message, getattr(proof, "field", ""), None), getattr(proof, "above", None)
    if value is None or (value > above if above is not None else value in proof.values):
        return ""
    wanted = f"above {above:g}" if above is not None else " or ".join(map(str, proof.values))
    return f"{proof.topic} must be {wanted}, got {value}"


def unmet_reason(graph: Graph, proofs: Sequence[SimpleNamespace]) -> str:
    """Return why the first proof that fails does not hold; empty where every proof holds."""
    try:
        return next((absent for absent in map(Unmet(graph).reason, proofs) if absent), "")
    except UnansweredError as unanswered:
        return str(unanswered)


def request(graph: Graph, wanted: SimpleNamespace, answer_s: float) -> str:
    """Send the request of a step; return an empty text, or why it was refused."""
    if wanted.kind == "transition":
        transition = _loaded("lifecycle_msgs/msg/Transition")(id=TRANSITIONS[wanted.transition])
        service, name = "lifecycle_msgs/srv/ChangeState", f"{wanted.node}/change_state"
        answer = graph.ask(service, name, answer_s, transition=transition)
        return "" if answer.success else f"{wanted.node} refused to {wanted.transition}"
    if wanted.kind == "versions":
        cmd = [sys.executable, Path(__file__).with_name("installed_versions.py"), "--manifest", MANIFEST, *wanted.parts]
        ended = subprocess.run(cmd, stdout=subprocess.PIPE, text=True)
        print(said := " ".join(ended.stdout.split()), flush=True)
        return (said or f"{cmd[1]} failed") if ended.returncode else ""
    if wanted.kind == "acknowledge":
        answer = graph.ask("std_srvs/srv/Trigger", wanted.service)
        return "" if answer.success else f"{wanted.service} refused: {answer.message}"
    if wanted.kind == "hardware":
        state = _loaded("lifecycle_msgs/msg/State")(id=ACTIVE, label="active")
        service, name = "controller_manager_msgs/srv/SetHardwareComponentState", "set_hardware_component_state"
        done = graph.ask(service, f"{wanted.manager}/{name}", answer_s, name=wanted.component, target_state=state).ok
        return "" if done else f"{wanted.manager} could not activate hardware {wanted.component}"
    listed, again = listed_controllers(graph, wanted.manager), wanted.kind == "restart"
    active = [entry.name for entry in listed if entry.name in wanted.controllers and entry.state == "active"]
    started = [name for name in wanted.controllers if again or name not in active]
    service, name = "controller_manager_msgs/srv/SwitchController", f"{wanted.manager}/switch_controller"
    asked = {"activate_controllers": started, "deactivate_controllers": active if again else [], "strictness": STRICT}
    done = not started or graph.ask(service, name, answer_s, **asked).ok
    return "" if done else f"{wanted.manager} refused to activate {', '.join(started)}"


def take(graph: Graph, step: SimpleNamespace) -> str:
    """Run one step; return an empty text, or why it failed."""
    deadline_s = PATIENCE_S or step.deadline_s
    effect, wanted = getattr(step, "effect", []), getattr(step, "request", None)
    if absent := _awaited(graph, step.proof, deadline_s):
        return absent
    if wanted is None or (effect and wanted.kind != "restart" and not unmet_reason(graph, effect)):
        return ""  # no request, or its effect is already there
    return _asked(graph, wanted, effect, deadline_s)


def _awaited(graph: Graph, proofs: Sequence[SimpleNamespace], deadline_s: float) -> str:
    until = time.monotonic() + deadline_s
    while absent := unmet_reason(graph, proofs):
        if time.monotonic() > until:
            return absent
        graph.spin(LOOK_S)
    return ""


def _asked(graph: Graph, wanted: SimpleNamespace, effect: Sequence[SimpleNamespace], deadline_s: float) -> str:
    until = time.monotonic() + deadline_s
    while True:
        left = max(until - time.monotonic(), ANSWER_S)
        try:
            if refused := request(graph, wanted, left if wanted.kind == "hardware" else ANSWER_S):
                return refused
            return _awaited(graph, effect, max(until - time.monotonic(), ANSWER_S))
        except UnansweredError as unanswered:
            absent = str(unanswered)
        if not unmet_reason(graph, effect):
            return ""  # done; only the answer was lost
        if time.monotonic() > until:
            return absent
        graph.spin(LOOK_S)


def take_all(graph: Graph, steps: Sequence[SimpleNamespace]) -> bool:
    """Run steps up to the first that fails; return whether all succeeded."""
    for number, step in enumerate(steps):
        started = time.monotonic()
        ended, after_s = take(graph, step), time.monotonic() - started
        if ended:
            later = ", ".join(skipped.name for skipped in steps[number + 1 :])
            rest = f" Skipped: {later}." if later else ""
            print(f"{step.name} failed after {after_s:.1f} s: {ended}.{rest}", file=sys.stderr, flush=True)
            return False
        print(f"{step.name} done after {after_s:.1f} s", flush=True)
    return True


def run_while_claimed(graph: Graph, step: SimpleNamespace, command: Sequence[str]) -> int:
    """Run a program while robots follow and controllers and managed nodes are active; return its exit status, or 1."""
    claims = [proof for proof in step.proof if proof.kind in ("controller", "lifecycle")]
    followed = {proof.topic: proof for proof in step.proof if hasattr(proof, "field")}
    children: list[subprocess.Popen[bytes]] = []
    against: list[str] = []

    def hear(topic: str, message: Any) -> None:
        if topic in followed and (absent := contradiction(followed[topic], message)):
            against.append(absent)  # latched: a robot that stops and goes on between two checks has stopped
            for child in children:
                child.send_signal(signal.SIGINT)

    def end(number: int, _: object) -> None:
        children[0].send_signal(number) if children else sys.exit(128 + number)

    signal.signal(signal.SIGTERM, end)
    graph.on_message = hear
    children.append(child := subprocess.Popen(command, preexec_fn=END_WITH_PARENT))
    misses = 0
    try:
        while (status := child.poll()) is None:
            graph.spin(LOOK_S)
            lost = "" if against else unmet_reason(graph, claims)
            misses = misses + 1 if lost else 0
            if against or misses >= LOST:
                lost = lost or against[0]
                print(f"{command[0]} stopped: {lost}", file=sys.stderr, flush=True)
                return 1
        return status if status >= 0 else 128 - status
    finally:
        _stop(child)


def _stop(child: subprocess.Popen[bytes]) -> None:
    """End a program that still runs: SIGINT, SIGTERM, then SIGKILL."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if child.poll() is not None:
            return
        child.send_signal(number)
        with suppress(subprocess.TimeoutExpired):
            child.wait(timeout=5.0)


def seconds(text: str) -> float:
    if 0.0 <= (read := float(text)) < math.inf:
        return read
    raise ValueError


def main(arguments: Sequence[str]) -> int:
    """Run phases, or a program after its proof; return the exit status."""
    global MANIFEST, PATIENCE_S
    options = [*takewhile(lambda word: word not in ("--", "--ros-args"), arguments)]
    command = [*arguments[arguments.index("--") + 1 :]] if "--" in arguments else []
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plan", type=Path, required=True, help="config/bring_up.json of the package")
    parser.add_argument("--target", choices=("mock", "sim", "real"), required=True)
    parser.add_argument("--host", default="", help="run only the steps of this computer")
    parser.add_argument("--release", default="", help="run only the steps of this device")
    wait = os.environ.get("CELL_WAIT_S") or "0"
    parser.add_argument("--wait", type=seconds, default=wait, help="seconds that replace all deadlines (CELL_WAIT_S)")
    parser.add_argument("phases", nargs="+", choices=("start", "activate", "claim", "move"))
    read = parser.parse_args(options)
    PATIENCE_S, MANIFEST = read.wait or PATIENCE_S, read.plan.parent.parent / "manifest.json"
    plan = json.loads(read.plan.read_text(encoding="utf-8"), object_hook=lambda entry: SimpleNamespace(**entry))
    taken = getattr(plan, read.target, None) or parser.error(f"{read.plan} has no steps on {read.target}")
    shared = vars(getattr(plan.shared, read.target))  # lists of proofs that several steps wait for
    for step in taken:
        step.proof = [*chain(*(shared[proof.list] if proof.kind == "shared" else [proof] for proof in step.proof))]
    hosts = (read.host, "") if read.host else {step.host for step in taken}
    released = [step for step in taken if read.release in ("", getattr(step, "release", ""))]
    steps = [step for step in released if step.phase in read.phases and step.host in hosts]
    graph = Graph(f"bring_up_{read.phases[-1]}", plan.enclave)
    try:
        proven = take_all(graph, steps)
        return run_while_claimed(graph, steps[-1], command) if proven and command else int(not proven)
    finally:
        graph.leave()


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit(130)
