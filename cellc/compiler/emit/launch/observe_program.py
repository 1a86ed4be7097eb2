#!/usr/bin/env python3
"""Compares computer and running graph with this package, read-only: it publishes, sets, commands and starts nothing.

    observe --package FOLDER [--gate G0|L1|L3|L4|L5|G3|G4|G7] [--target real|mock] [--for SECONDS] [--evidence FOLDER]
            [--host NAME]

It reads the ends of every interface, listens to every topic with a rate and to the transforms, and asks controller
managers, managed nodes, parameters and devices, by services that change nothing. Each line is PASSED, FAILED or
UNKNOWN, with what is expected and what is seen. On a cell of several computers each runs it: `cellc evidence` joins the
reports. Nodes that a later gate starts need not run. Layers L3 to L5 have one part each: graph, flow, tf. At G0 and L1
it needs no graph, and compares versions, network cards, routes, environment and kernel of this computer; at L5 its
clock. Ctrl-C ends the listening; what was seen until then is compared. Exit status: 0 all passed, 1 a line failed or is
unknown, 2 usage.
"""

from __future__ import annotations

import argparse
import json
import platform
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from cellc.compiler.emit.launch.observe_checks import (
    FAILED,
    PASSED,
    SEEN,
    UNKNOWN,
    End,
    Ends,
    Line,
    Package,
    Reading,
    Seen,
)
from cellc.compiler.emit.launch.observe_host import comparisons_of_host
from cellc.compiler.emit.launch.observe_listener import loaded, said, subscribe
from cellc.compiler.emit.launch.observe_reports import comparisons, space

# The only services that are asked, beside those without an argument by which the catalog says that a device tells its
# version or state: none changes anything.
READS = {
    "list_controllers": "controller_manager_msgs/srv/ListControllers",
    "list_hardware_components": "controller_manager_msgs/srv/ListHardwareComponents",
    "get_state": "lifecycle_msgs/srv/GetState",
    "get_parameters": "rcl_interfaces/srv/GetParameters",
}
DISCOVERY_S, ANSWER_S = 3.0, 3.0
POLL_S = 0.01  # at 1 kHz a tenth of the queue fills in it
PARTS = {"G0": "", "L1": "", "L3": "graph", "L4": "flow", "L5": "tf"}  # of the graph; other gates ask for all
HOST_PARTS = {"G0": "versions", "L1": "host", "L3": "environment", "L5": "clock"}  # of this computer
DAY_S = 86400.0
ORDER = (PASSED, SEEN, UNKNOWN, FAILED)  # in which lines are printed: what stops a gate is last
TRIES = 10  # to write a report under the second in which it is written
NO_HASH = "INVALID"  # what rclpy shows where the other end carries none


class Graph:
    """One node that looks."""

    def __init__(self, enclave: str) -> None:
        import rclpy

        rclpy.init(args=["--ros-args", "--enclave", enclave])
        self._rclpy = rclpy
        self._node = rclpy.create_node("observe", start_parameter_services=False, enable_rosout=False)
        self._subscriptions: list[tuple[Any, Callable[[bytes, float], None]]] = []

    def close(self) -> None:
        self._node.destroy_node()
        self._rclpy.try_shutdown()

    def wait(self, until_s: float) -> None:
        """Take messages until an instant of the monotonic clock; an executor would take five times as long for each."""
        while time.monotonic() < until_s:
            for subscription, take in self._subscriptions:
                with subscription.handle:
                    while (taken := subscription.handle.take_message(subscription.msg_type, True)) is not None:
                        received_ns = taken[1].get("received_timestamp") if isinstance(taken[1], dict) else 0
                        take(taken[0], received_ns / 1e9 if received_ns else time.time())
            time.sleep(POLL_S)

    def stop_listening(self) -> None:
        """End all subscriptions."""
        for subscription, _ in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions.clear()

    def nodes(self) -> list[str]:
        """Return the full name of every node, as often as it runs."""
        return [f"{home.rstrip('/')}/{name}" for name, home in self._node.get_node_names_and_namespaces()]

    def ends(self, name: str, kind: str) -> Ends:
        """Return who publishes or serves an interface, and who subscribes or calls."""
        if kind == "topic":
            return self._publishers(name), self._subscribers(name)
        if kind == "action":  # its types are those of hidden services
            servers, clients = self._publishers(f"{name}/_action/status"), self._subscribers(f"{name}/_action/status")
            return [End(end.node) for end in servers], [End(end.node) for end in clients]
        serving, calling = [], []
        for bare, home in set(self._node.get_node_names_and_namespaces()):
            full = f"{home.rstrip('/')}/{bare}"
            served = self._node.get_service_names_and_types_by_node(bare, home)
            called = self._node.get_client_names_and_types_by_node(bare, home)
            serving += [End(full, types[0]) for each, types in served if each == name]
            calling += [End(full, types[0]) for each, types in called if each == name]
        return serving, calling

    def _publishers(self, topic: str) -> list[End]:
        return [_end(info) for info in self._node.get_publishers_info_by_topic(topic)]

    def _subscribers(self, topic: str) -> list[End]:
        return [_end(info) for info in self._node.get_subscriptions_info_by_topic(topic)]

    def listen(self, topic: str, kind: Any, take: Callable[[bytes, float], None], *, latched: bool = False) -> None:
        """Subscribe to serialized messages with the least QoS, or to the last message of a latched topic."""
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        qos = QoSProfile(
            depth=100,
            reliability=ReliabilityPolicy.RELIABLE if latched else ReliabilityPolicy.BEST_EFFORT,
            durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )
        subscription = self._node.create_subscription(kind, topic, take, qos, raw=True)
        self._subscriptions.append((subscription, take))

    def serves(self, node: str, service: str) -> bool:
        """Return whether a node answers a service."""
        home, _, bare = node.rpartition("/")
        return any(name == service for name, _ in self._node.get_service_names_and_types_by_node(bare, home or "/"))

    def ask(self, service: str, stated: str = "", **fields: Any) -> Any:
        """Return the answer of a service that changes nothing; None where it gives none.

        Args:
            stated: its type, where it is one of the services by which devices say something of themselves.
        """
        kind = loaded(stated or READS[service.rpartition("/")[2]])
        if kind is None:
            return None
        client = self._node.create_client(kind, service)
        try:
            if not client.wait_for_service(ANSWER_S):
                return None
            future = client.call_async(kind.Request(**fields))
            self._rclpy.spin_until_future_complete(self._node, future, timeout_sec=ANSWER_S)
            return future.result() if future.done() else None
        finally:
            self._node.destroy_client(client)


def _end(info: Any) -> End:
    qos, home = info.qos_profile, info.node_namespace.rstrip("/")
    policies = qos.reliability.name.lower(), qos.durability.name.lower()
    type_hash = str(getattr(info, "topic_type_hash", NO_HASH))  # since Iron
    return End(f"{home}/{info.node_name}", info.topic_type, *policies, "" if type_hash == NO_HASH else type_hash)


def look(graph: Any, package: Package, for_s: float) -> Seen:
    """Listen, then read the graph and ask."""
    seen = Seen()
    listener = subscribe(graph, package, seen)
    begin_s = time.monotonic() + DISCOVERY_S
    try:
        graph.wait(begin_s)
        seen.streams.clear()
        seen.cycles.clear()
        for left_s in range(int(for_s), 0, -10):
            print(f"listening, {left_s} s left", flush=True)
            graph.wait(min(begin_s + for_s, begin_s + for_s - left_s + 10))
        graph.wait(begin_s + for_s)
    except KeyboardInterrupt:
        print("listening was ended", flush=True)
    seen.listened_s = max(0.0, time.monotonic() - begin_s)
    graph.stop_listening()
    listener.finish()
    ask(graph, package, seen)
    return seen


def ask(graph: Any, package: Package, seen: Seen) -> None:
    """Read the graph, and ask all that is asked."""
    seen.nodes = graph.nodes()
    for name in package.plan["ends"]:
        seen.ends[name] = graph.ends(name, package.contract["interfaces"][name]["kind"])
    for node in package.plan["states"]:
        for service in ("list_controllers", "list_hardware_components"):
            seen.answers[f"{node}/{service}"] = graph.ask(f"{node}/{service}")
    for node in package.plan["lifecycle"]:
        seen.answers[f"{node}/get_state"] = graph.ask(f"{node}/get_state")
    for node in sorted(package.parameters.keys() & set(seen.nodes)):
        seen.answers[f"{node}/get_parameters"] = graph.ask(
            f"{node}/get_parameters", names=list(package.parameters[node])
        )
    for node in sorted({*package.plan["nodes"]} & {*seen.nodes}):
        if graph.serves(node, f"{node}/get_parameters"):
            seen.answers[f"{node}/use_sim_time"] = graph.ask(f"{node}/get_parameters", names=["use_sim_time"])
    for reading in package.plan["readings"]:
        interface = package.contract["interfaces"][reading["interface"]]
        if interface["kind"] == "service" and (answer := graph.ask(reading["interface"], interface["type"])):
            seen.readings.setdefault(reading["interface"], Reading()).take(said(answer, reading["fields"]))


def read_package(folder: Path, target: str) -> Package:
    """Read what the package states for a target."""
    contract = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    plan = json.loads((folder / "config/observe.json").read_text(encoding="utf-8"))
    description = ElementTree.parse(folder / contract["files"][f"urdf_{target}"]).getroot()
    written: dict[str, dict[str, Any]] = {}
    for file in sorted((folder / "config").rglob("*.yaml")):
        of = Path(file.stem).suffix
        for node, values in read_parameters(file) if of not in {".mock", ".sim", ".real"} - {f".{target}"} else ():
            written.setdefault(node, {}).update(values)
    shared = {name: plan[name] for name in ("enclave", "recorded", "computers")}
    return Package(contract, {**shared, "readings": (), **plan[target]}, description, written)


def read_parameters(file: Path) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the parameters of each node that a file names; a pattern of names is left out."""
    import yaml

    def sections(name: str, part: Any) -> Iterator[tuple[str, Mapping[str, Any]]]:
        for key, inner in part.items() if isinstance(part, dict) else ():
            if key == "ros__parameters":
                yield name, dict(values("", inner))
            else:
                yield from sections(f"{name}/{key.strip('/')}", inner)

    def values(above: str, part: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
        for key, inner in part.items():
            if isinstance(inner, dict):
                yield from values(f"{above}{key}.", inner)
            else:
                yield f"{above}{key}", inner

    found = sections("", yaml.safe_load(file.read_text(encoding="utf-8")))
    return ((node, read) for node, read in found if "*" not in node)


def write(lines: Sequence[Line], folder: Path, attempt: Mapping[str, Any]) -> None:
    """Write the report, for programs and for people, beside those of other attempts."""
    place = folder / f"observe-{attempt['gate']}-{attempt['attempt_id']}"
    content = {**attempt, "lines": [asdict(line) for line in lines]}
    with place.with_suffix(".json").open("x", encoding="utf-8") as file:
        json.dump(content, file, indent=1)
    head = [f"# {attempt['cell']} at {attempt['gate']}, {attempt['target']}, {attempt['configuration_id']}", ""]
    rows = ["| verdict | part | subject | expected | seen |", "|---|---|---|---|---|"]
    for line in lines:
        cells = (line.verdict, line.part, line.subject, line.expected, line.seen)
        rows.append("| " + " | ".join(escaped(text) for text in cells) + " |")
    with place.with_suffix(".md").open("x", encoding="utf-8") as file:
        file.write("\n".join([*head, *rows, ""]))
    print(f"wrote {place}.json and .md", flush=True)


def leave(lines: Sequence[Line], folder: Path, package: Package, asked: Mapping[str, Any]) -> None:
    """Write the report under an attempt id of its own: observers of two computers may end in the same second."""
    of_cell = {name: package.contract[name] for name in ("cell", "configuration_id")}
    attempt = {"attempt_id": "", **of_cell, **asked}
    for left in reversed(range(TRIES)):
        attempt["attempt_id"] = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
        try:
            write(lines, folder, attempt)
            break
        except FileExistsError:
            if not left:
                raise
            time.sleep(1.0)


def escaped(text: str) -> str:
    """Return text of a node as one line without control characters, and without marks of Markdown."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in text)
    return "".join(f"\\{letter}" if letter in "|<>`[]*_\\" else letter for letter in plain)


def seconds(text: str) -> float:
    """Return a time to listen, s.

    Raises:
        ValueError: it is no number from 0 to a day.
    """
    value = float(text)
    if not 0.0 <= value <= DAY_S:
        raise ValueError
    return value


def folder(text: str) -> Path:
    """Return a folder that is there.

    Raises:
        argparse.ArgumentTypeError: it is not, or no name is given, as where ``$E`` is not set in a shell.
    """
    if not text or not Path(text).is_dir():
        raise argparse.ArgumentTypeError(
            f"must be a folder that is there, got '{escaped(text)}'; is E set in this shell?"
        )
    return Path(text)


def host_of(hosts: Mapping[str, Any], named: str | None, refuse: Callable[[str], object]) -> str:
    """Return the host of the cell that this computer is; its own name where the cell runs in one place."""
    own = platform.node()
    if hosts and (named or own) not in hosts:
        refuse(f"--host must be one of {', '.join(hosts)}, got {escaped(named or own)}")
    return named or own


def of_computer(package: Package, host: str, gate: str) -> Iterator[Line]:
    """Yield what is compared at a gate of the computer on which this runs."""
    computers = package.plan["computers"]
    stated = computers[host] if len(computers) > 1 else next(iter(computers.values()))
    if gate in HOST_PARTS:
        yield from comparisons_of_host(stated, package.contract["version_tuple"], HOST_PARTS[gate])


def looked(package: Package, for_s: float) -> Seen:
    """Return what one node saw of the graph."""
    graph = Graph(package.plan["enclave"])
    try:
        return look(graph, package, for_s)
    finally:
        graph.close()


def main(arguments: Sequence[str]) -> int:
    """Look, compare, print and write; return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--package", type=Path, required=True, metavar="FOLDER", help="share folder of this package")
    parser.add_argument("--gate", choices=(*PARTS, "G3", "G4", "G7"), default="G4", help="default: G4")
    parser.add_argument("--target", choices=("real", "mock"), default="real", help="hardware (default: real)")
    parser.add_argument("--for", type=seconds, default=30.0, dest="for_s", metavar="SECONDS", help="default: 30")
    parser.add_argument("--evidence", type=folder, metavar="FOLDER", help="folder of this attempt's evidence")
    parser.add_argument("--host", metavar="NAME", help="this computer, as the spec names it (default: its own name)")
    read = parser.parse_args(arguments)
    try:
        package = read_package(read.package, read.target)
    except (OSError, ValueError, KeyError, ElementTree.ParseError) as error:
        parser.error(f"--package must be the share folder of this package: {escaped(str(error))}")
    host = host_of(package.plan.get("hosts", {}), read.host, parser.error)
    lines, listened_s = list(of_computer(package, host, read.gate)), 0.0
    if PARTS.get(read.gate, read.gate):
        seen = looked(package, read.for_s)
        whole = comparisons(package, seen, "G3" if read.gate in PARTS else read.gate)
        lines += [line for line in whole if line.part == PARTS.get(read.gate, line.part)]
        if read.evidence is not None and read.gate not in PARTS:
            lines.append(space(package, seen, read.evidence, read.gate))
        listened_s = seen.listened_s
    for line in sorted(lines, key=lambda line: ORDER.index(line.verdict)):
        expected = "" if line.verdict in (PASSED, SEEN) else f" (expected: {line.expected})"
        text = f"{line.verdict:8}{line.part:12}{line.subject}: {line.seen}{expected}"
        print(text.replace("\n", " "), flush=True)
    if read.evidence is not None:
        asked = {"gate": read.gate, "target": read.target, "host": host, "seconds": listened_s}
        leave(lines, read.evidence, package, asked)
    failed = sum(line.verdict == FAILED for line in lines)
    unknown, read_off = (sum(line.verdict == each for line in lines) for each in (UNKNOWN, SEEN))
    shown = f", {read_off} to be read" if read_off else ""
    print(f"{len(lines) - read_off} compared: {failed} failed, {unknown} unknown{shown}", flush=True)
    return 1 if failed or unknown else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
