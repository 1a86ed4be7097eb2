"""Opens what nodes of a cell open, with the real client library, and lists it as the graph of ROS shows it.

Run as a program, because the middleware belongs into a process of its own: one job as JSON on standard input, the ends
of every node as JSON on standard output, each a right and a name. Types are stood in for: names alone are permitted.
"""

from __future__ import annotations

import json
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import rclpy
from lifecycle_msgs.srv import GetState
from rcl_interfaces.msg import Log
from rclpy.lifecycle import LifecycleNode
from rclpy.node import Node


def ends(seen: Any) -> list[tuple[str, str]]:
    """Return every end of a node by the right that it needs."""
    listed = {
        "publish": seen.get_publisher_names_and_types_by_node,
        "subscribe": seen.get_subscriber_names_and_types_by_node,
        "reply": seen.get_service_names_and_types_by_node,
        "request": seen.get_client_names_and_types_by_node,
    }
    own = (seen.get_name(), seen.get_namespace())
    return [(right, name) for right, names in listed.items() for name, _ in names(*own)]


def opened(wanted: dict[str, Any]) -> list[tuple[str, str]]:
    """Open a node with the ends that a cell declares for it."""
    kind: Any = LifecycleNode if wanted["lifecycle"] else Node
    node = kind(wanted["name"], namespace=wanted["namespace"] or "/")
    make = {
        "publish": lambda name: node.create_publisher(Log, name, 1),
        "subscribe": lambda name: node.create_subscription(Log, name, lambda _: None, 1),
        "reply": lambda name: node.create_service(GetState, name, lambda _, answer: answer),
        "request": lambda name: node.create_client(GetState, name),
    }
    for right, name in wanted["ends"]:
        make[right](name)
    found = ends(node)
    node.destroy_node()
    return found


def asked(program: str, plan: dict[str, Any], phase: str) -> list[tuple[str, str]]:
    """Let the generated program look at every proof of a phase and ask for every step, and list what it opened."""
    module: Any = ModuleType("bring_up_of_a_test")
    module.__file__ = "scripts/bring_up"  # beside which no other program lies: none is started
    exec(compile(program, "scripts/bring_up", "exec"), module.__dict__)
    real = module._loaded
    module._loaded = lambda kind: real(kind) if kind.startswith("lifecycle_msgs/") else _stand_in(kind)
    ask = module.listed_controllers

    def listed(graph: Any, manager: str) -> list[Any]:
        _tried(module, lambda: ask(graph, manager))
        return []

    module.listed_controllers = listed
    read = json.loads(json.dumps(plan), object_hook=lambda entry: SimpleNamespace(**entry))
    steps = [step for target in (read.mock, read.real) for step in target if step.phase == phase]
    proofs = [one for step in steps for one in (*step.proof, *getattr(step, "effect", ()))]
    graph = module.Graph(f"bring_up_{phase}", plan["enclave"])
    said = rclpy.create_node("world", context=graph._context)
    kept = [said.create_publisher(Log, proof.topic, 1) for proof in proofs if proof.kind == "topic"]
    graph.spin(0.2)
    for one in proofs:
        module.unmet_reason(graph, [one])
    for step in steps:
        _tried(module, lambda step=step: module.request(graph, step.request, 0.0) if hasattr(step, "request") else "")
    found = ends(graph._node)
    assert len(kept) == sum(proof.kind == "topic" for proof in proofs)
    graph.leave()
    return found


def watched(program: str, plan: dict[str, Any]) -> list[tuple[str, str]]:
    """Let the generated watch subscribe to what is published, serve and prepare its requests; list what it opened."""
    module: Any = ModuleType("claim_watch_of_a_test")
    exec(compile(program, "scripts/claim_watch", "exec"), module.__dict__)
    module.loaded = _stand_in
    read = json.loads(json.dumps(plan), object_hook=lambda entry: SimpleNamespace(**entry))
    ros = module.Ros(plan["enclave"])
    said = rclpy.create_node("world")
    topics = {proof.topic for entry in read.watches for proof in vars(entry.while_hold).values()}
    kept = [said.create_publisher(Log, topic, 1) for topic in topics]
    rclpy.spin_once(ros._node, timeout_sec=0.2)
    for entry in read.watches:
        module.Watch(ros, entry).look()
    found = ends(ros._node)
    assert len(kept) == len(topics)
    rclpy.shutdown()
    return found


def _stand_in(kind: str) -> Any:
    return GetState if "/srv/" in kind else Log


def _tried(module: Any, call: Any) -> None:
    try:
        call()
    except module.UnansweredError:
        return


def main() -> None:
    """Answer the job of standard input."""
    job = json.load(sys.stdin)
    found = {}
    for phase in job["phases"]:
        found[f"bring_up_{phase}"] = asked(job["program"], job["plan"], phase)
    if job["watch"]:
        found["claim_watch"] = watched(job["watch"], job["plan"])
    rclpy.init(args=[])
    for wanted in job["nodes"]:
        found[f"{wanted['namespace']}/{wanted['name']}"] = opened(wanted)
    rclpy.shutdown()
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()
