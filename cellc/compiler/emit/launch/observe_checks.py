#!/usr/bin/env python3
"""Compares what ``observe`` saw of a running graph with what the package states; it imports nothing of ROS."""

from __future__ import annotations

import math
import re
from array import array
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from itertools import pairwise
from typing import Any
from xml.etree.ElementTree import Element

PASSED, FAILED, UNKNOWN = "PASSED", "FAILED", "UNKNOWN"
SEEN = "SEEN"
"""Of a figure that nothing is compared with: a person reads it."""
# Programs that people start beside a cell, and nodes that libraries add: they serve and command nothing of a cell.
BESIDE = re.compile(
    r".*/(_.*|observe|bring_up\w*|rosbag2_\w+|tf2_\w+|transform_listener_impl_\w+|launch_ros_\d+|rviz\w*)"
)
SLOW = 0.95  # a stream may have this share of its rate, and no less
FUTURE_S = 0.001  # a stamp may be this far in the future: clocks of two computers differ
STANDING = 0.002  # rad or m: noise of a joint at rest
FIXED_M, FIXED_RAD = 1e-4, math.radians(0.01)  # by this much a fixed transform may differ: both are rounded
CLAIMED_FROM = "G7"  # gates before it claim nothing and move nothing
SHOWN = 4  # problems that a line names; it counts the others
KEPT = 100  # values of one reading
SIDES = {"topic": ("publishers", "subscribers"), "service": ("server", "clients"), "action": ("server", "clients")}
OFFERED = {("best_effort", "reliable"), ("volatile", "transient_local")}  # offered, and requested without a match


@dataclass(frozen=True)
class Line:
    """One comparison."""

    part: str
    subject: str
    verdict: str
    expected: str
    seen: str


@dataclass(frozen=True)
class End:
    """A publisher, subscriber, server or client; the QoS of topics alone is seen."""

    node: str
    type: str = ""
    reliability: str = ""
    durability: str = ""
    type_hash: str = ""


Ends = tuple[Sequence[End], Sequence[End]]


@dataclass
class Stream:
    """What arrived on one topic.

    Attributes:
        arrivals: one entry a message, s since 1970 on this computer's clock.
        ages: at arrival, s, where messages have stamps.
        size: of all messages, byte.
        joints: lowest and highest position of each joint, rad or m.
    """

    arrivals: array[float] = field(default_factory=lambda: array("d"))
    ages: array[float] = field(default_factory=lambda: array("d"))
    frames: set[str] = field(default_factory=set)
    joints: dict[str, tuple[float, float]] = field(default_factory=dict)
    size: int = 0
    newest_s: float = 0.0
    backward: int = 0
    not_finite: int = 0

    def take(self, arrived_s: float, stamp: tuple[float, str] | None, size: int = 0) -> None:
        """Note a message of a size in byte; `stamp` has the seconds and the frame of its header."""
        self.arrivals.append(arrived_s)
        self.size += size
        if stamp is not None:
            self.ages.append(arrived_s - stamp[0])
            self.frames.add(stamp[1])
            self.backward += stamp[0] < self.newest_s
            self.newest_s = max(self.newest_s, stamp[0])

    def take_joints(self, names: Iterable[str], positions: Iterable[float]) -> None:
        """Note the positions of joints."""
        for name, position in zip(names, positions, strict=False):
            self.not_finite += not math.isfinite(position)
            low, high = self.joints.get(name, (position, position))
            self.joints[name] = min(low, position), max(high, position)


@dataclass
class Cycles:
    """What a controller manager says of its cycles.

    Attributes:
        times_us: what each took for reading, updating and writing.
        statuses: level, message and figures of each diagnosis of the manager itself.
    """

    times_us: array[float] = field(default_factory=lambda: array("d"))
    statuses: list[tuple[int, str, Mapping[str, str]]] = field(default_factory=list)


@dataclass
class Reading:
    """What a device said of itself: each value once, of numbers the lowest and the highest."""

    values: list[Any] = field(default_factory=list)

    def take(self, value: Any) -> None:
        """Note a value."""
        if isinstance(value, float):
            self.values = [min([*self.values[:1], value]), max([*self.values[-1:], value])]
        elif value not in self.values and len(self.values) < KEPT:
            self.values.append(value)


@dataclass
class Seen:
    """A graph as it was seen.

    Attributes:
        ends: of each interface, publishers or servers, and subscribers or clients.
        answers: of each service that was asked; None where it gave none.
        uninstalled: types of interfaces that are not installed here.
        moving: parents of each child on ``/tf``.
        fixed: parent, position and quaternion of each child on ``/tf_static``.
        cycles: of each controller manager.
        readings: of each interface by which a device says something of itself.
    """

    nodes: list[str] = field(default_factory=list)
    ends: dict[str, Ends] = field(default_factory=dict)
    answers: dict[str, Any] = field(default_factory=dict)
    uninstalled: set[str] = field(default_factory=set)
    streams: dict[str, Stream] = field(default_factory=dict)
    moving: dict[str, set[str]] = field(default_factory=dict)
    fixed: dict[str, set[tuple[str, tuple[float, ...], tuple[float, ...]]]] = field(default_factory=dict)
    cycles: dict[str, Cycles] = field(default_factory=dict)
    readings: dict[str, Reading] = field(default_factory=dict)
    listened_s: float = 0.0


@dataclass(frozen=True)
class Package:
    """What ``contract.json``, ``config/observe.json``, the URDF and parameter files state for one target."""

    contract: Any
    plan: Any
    description: Element
    parameters: Mapping[str, Mapping[str, Any]]


def judged(part: str, subject: str, expected: str, problems: Sequence[str], seen: str = "") -> Line:
    """Return a line that fails on any problem."""
    if not problems:
        return Line(part, subject, PASSED, expected, seen or expected)
    more = [f"and {len(problems) - SHOWN} more"] if len(problems) > SHOWN else []
    return Line(part, subject, FAILED, expected, "; ".join([*problems[:SHOWN], *more]))


def listed(names: Iterable[str]) -> str:
    return ", ".join(sorted(names)) or "none"


def nodes(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare which nodes run: one of a name, and none that the package does not start."""
    of_cell = Counter(node for node in seen.nodes if not BESIDE.fullmatch(node))  # each host has an observer
    several = [f"{node} runs {number} times" for node, number in of_cell.items() if number > 1]
    yield judged("graph", "node names", "each once", several)
    yield judged("graph", "nodes of later gates", "none runs", list(_early(package, of_cell, gate)))
    known = set(package.plan["nodes"])
    other = {node for node in seen.nodes if owner(node, package.plan) not in known and not BESIDE.fullmatch(node)}
    yield Line("graph", "nodes beside the package", UNKNOWN if other else PASSED, "none", listed(other))


def _early(package: Package, running: Collection[str], gate: str) -> Iterator[str]:
    """Yield the nodes that run before the gate in which they are started: motion clients above all."""
    since: dict[str, str] = {}
    for sides in package.plan["ends"].values():
        for node, start in (*sides["sources"].items(), *sides["sinks"].items()):
            since[node] = min(start, since.get(node, start))
    yield from (
        f"{node} runs, and {start} starts it" for node, start in since.items() if start > gate and node in running
    )


def owner(node: str, plan: Any) -> str:
    """Return the node in whose process a library made a node; else the node itself."""
    owners = (each for each, patterns in plan["inside"].items() if any(fnmatchcase(node, text) for text in patterns))
    return node if node in plan["nodes"] else next(owners, node)


def endpoints(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare who is at each interface: nodes, types, QoS, and whether both sides match."""
    for name, sides in package.plan["ends"].items():
        interface = package.contract["interfaces"][name]
        found = [
            [replace(end, node=owner(end.node, package.plan)) for end in ends] for ends in seen.ends.get(name, ((), ()))
        ]
        for side, words, ends in zip(("sources", "sinks"), SIDES[interface["kind"]], found, strict=True):
            wanted, there = sides[side], {end.node for end in ends if not BESIDE.fullmatch(end.node)}
            needed = {node for node, since in wanted.items() if since <= gate}
            problems = [f"{node} is missing" for node in sorted(needed - there)]
            noun = words.removesuffix("s")
            problems += [f"{node} is not a declared {noun}" for node in sorted(there - wanted.keys())]
            problems += [problem for end in ends if end.node in wanted for problem in _other_kind(interface, side, end)]
            yield judged("graph", f"{name}, {words}", listed(needed), problems, listed(there))
        unmatched = [problem for writer in found[0] for reader in found[1] for problem in _unmatched(writer, reader)]
        if unmatched:
            yield judged("graph", f"{name}, QoS", "publishers offer what subscribers request", unmatched)
    yield from hashes(seen)


def hashes(seen: Seen) -> Iterator[Line]:
    """Compare the definitions with which the ends of each topic were built, where the middleware carries their hash."""
    found = {name: [end for side in sides for end in side if end.type_hash] for name, sides in seen.ends.items()}
    several = {name: ends for name, ends in found.items() if len(ends) > 1}
    problems = [
        f"{name} has {listed(f'{end.type_hash[:15]} at {end.node}' for end in ends)}"
        for name, ends in several.items()
        if len({(end.type, end.type_hash) for end in ends}) > len({end.type for end in ends})
    ]
    if several:
        counted = f"{len(several)} topics whose ends carry one"
        yield judged("graph", "type hashes", "one at all ends of a topic", problems, counted)


def _other_kind(interface: Any, side: str, end: End) -> Iterator[str]:
    if end.type and end.type != interface["type"]:
        yield f"{end.node} has type {end.type}, expected {interface['type']}"
    stated = next((each["qos"] for each in interface.get(side, ()) if each["full_name"] == end.node), None)
    for policy, found in (("reliability", end.reliability), ("durability", end.durability)):
        if stated is not None and found and found != stated[policy]:
            yield f"{end.node} has {policy} {found}, expected {stated[policy]}"


def _unmatched(writer: End, reader: End) -> Iterator[str]:
    for offered, requested in ((writer.reliability, reader.reliability), (writer.durability, reader.durability)):
        if (offered, requested) in OFFERED:
            yield f"{writer.node} offers {offered}, {reader.node} requests {requested}"


def streams(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare rate, age, order and frame of each topic with a rate."""
    for name, interface in package.contract["interfaces"].items():
        if interface.get("rate_hz") is None or not is_published(package, name, gate):
            continue
        bound, wanted = interface.get("max_age_s"), interface["rate_hz"]
        expected = f"{wanted:g} Hz" + ("" if bound is None else f", at most {bound:g} s old")
        if interface["type"] in seen.uninstalled:
            yield Line("flow", name, UNKNOWN, expected, f"{interface['type']} is not installed here")
            continue
        stream = seen.streams.get(name, Stream())
        rate = len(stream.arrivals) / seen.listened_s if seen.listened_s else 0.0
        oldest, early = max(stream.ages, default=0.0), sum(age < -FUTURE_S for age in stream.ages)
        problems = [] if rate >= SLOW * wanted else [f"{rate:.4g} Hz"]
        problems += [f"{oldest:.4g} s old"] if bound is not None and oldest > bound else []
        problems += [f"{early} stamps in the future"] if early else []
        alone = len(package.plan["ends"][name]["sources"]) == 1  # stamps of several publishers interleave
        problems += [f"{stream.backward} stamps before an earlier one"] if stream.backward and alone else []
        frame = interface.get("frame") or ""
        problems += [f"frame {each}, expected {frame}" for each in sorted(stream.frames - {frame}) if frame]
        figures = f"{rate:.4g} Hz, {gaps(stream)}, at most {oldest:.4g} s old"
        line = judged("flow", name, expected, problems, figures)
        yield replace(line, seen=f"{line.seen}; in all {figures}") if problems else line


def is_published(package: Package, name: str, gate: str) -> bool:
    """Return whether something publishes a topic at a gate."""
    sources = package.plan["ends"].get(name, {"sources": {}})["sources"]
    return any(since <= gate for since in sources.values())


def gaps(stream: Stream) -> str:
    """Return the middle, the 99th percentile and the longest of the times between messages."""
    ordered = sorted(later - earlier for earlier, later in pairwise(stream.arrivals))
    if not ordered:
        return "no gap"
    places = ((len(ordered) // 2, "p50"), (min(len(ordered) - 1, len(ordered) * 99 // 100), "p99"), (-1, "longest"))
    return "gaps " + ", ".join(f"{ordered[place] * 1e3:.4g} ms {name}" for place, name in places)


def joints(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare joint states: complete, finite, within limits, and standing where nothing is claimed."""
    found = {name: ends for stream in seen.streams.values() for name, ends in stream.joints.items()}
    controllers = (
        each for manager in package.contract["managers"].values() for each in manager["controllers"].values()
    )
    states = [name for name, each in package.contract["interfaces"].items() if each["type"].endswith("/JointState")]
    due = all(is_published(package, name, gate) for name in states)  # else some joints are not read yet
    later = package.plan["late_joints"] if gate < CLAIMED_FROM else ()  # a person activates their hardware first
    wanted = {joint for each in controllers for joint in each["joints"] if due and joint not in later}
    problems = [f"{joint} is missing" for joint in sorted(wanted - found.keys())]
    problems += ["a position is not a number"] if any(stream.not_finite for stream in seen.streams.values()) else []
    for joint, limits in package.contract["joint_limits"].items():
        low, high = found.get(joint, (0.0, 0.0))
        if joint in found and (low < limits.get("lower", -math.inf) or high > limits.get("upper", math.inf)):
            problems.append(f"{joint} is beyond its limits, at {low:.4f} to {high:.4f}")
    yield judged("flow", "joint states", f"{len(wanted)} joints within their limits", problems, f"{len(found)} joints")
    if gate < CLAIMED_FROM:
        moved = [f"{joint} moved by {high - low:.4f}" for joint, (low, high) in found.items() if high - low > STANDING]
        unseen = Line("flow", "motion", UNKNOWN, "no joint moves", "no joint states")
        yield unseen if due and not found else judged("flow", "motion", "no joint moves", moved)


def transforms(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare transforms with the description: each child is published once, below its parent, at its place."""
    later = package.plan["late_joints"] if gate < CLAIMED_FROM else ()
    both = sorted(seen.moving.keys() & seen.fixed.keys())
    missing, other = [], [f"{child} is on /tf and on /tf_static" for child in both]
    for joint in package.description.iterfind("joint"):
        parent, child = (_attribute(joint.find(end), "link", "") for end in ("parent", "child"))
        fixed = joint.get("type") == "fixed"
        if child not in (seen.fixed if fixed else seen.moving) and joint.get("name") not in later:
            missing.append(f"{child} is missing")
        if not fixed:
            parents = seen.moving.get(child, set()) - {parent}
            other += [f"{child} is below {each}, expected {parent}" for each in sorted(parents)]
            continue
        found = seen.fixed.get(child, set())
        other += [f"{child} has {len(found)} different transforms"] if len(found) > 1 else []
        other += [problem for each in sorted(found) if (problem := _misplaced(joint, parent, child, each))]
    yield judged("tf", "frames of the description", "all are published", missing)
    yield judged("tf", "parents and fixed transforms", "as in the description", other)


def _misplaced(joint: Element, parent: str, child: str, found: tuple[str, Sequence[float], Sequence[float]]) -> str:
    if found[0] != parent:
        return f"{child} is below {found[0]}, expected {parent}"
    xyz, rpy = (
        [float(text) for text in _attribute(joint.find("origin"), name, "0 0 0").split()] for name in ("xyz", "rpy")
    )
    away = math.dist(xyz, found[1])
    turned = 2.0 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(quaternion(rpy), found[2], strict=True)))))
    off = f"{child} is {away * 1e3:.2f} mm and {math.degrees(turned):.2f} deg from its place"
    return off if away > FIXED_M or turned > FIXED_RAD else ""


def _attribute(element: Element | None, name: str, fallback: str) -> str:
    return fallback if element is None else element.get(name, fallback)


def quaternion(rpy: Sequence[float]) -> tuple[float, float, float, float]:
    """Return x, y, z, w of rotations about the fixed axes x, y and z, rad."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(angle / 2.0), math.cos(angle / 2.0)) for angle in rpy)
    x, y = sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy
    return x, y, cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy
