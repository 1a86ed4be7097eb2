#!/usr/bin/env python3
"""Compares what managers, nodes and devices say of themselves with the package: states, cycles, parameters, modes."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

from cellc.compiler.emit.launch.observe_checks import (
    CLAIMED_FROM,
    FAILED,
    PASSED,
    SEEN,
    SLOW,
    UNKNOWN,
    Cycles,
    Line,
    Package,
    Seen,
    Stream,
    endpoints,
    is_published,
    joints,
    judged,
    listed,
    nodes,
    streams,
    transforms,
)

VALUES = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value", 5: "byte_array_value"}
VALUES |= {6: "bool_array_value", 7: "integer_array_value", 8: "double_array_value", 9: "string_array_value"}
NOT_SET = 0  # rcl_interfaces/msg/ParameterType
OVERRUN = 1e-3  # share of the cycles that may take longer than their period
WARN = 1  # diagnostic_msgs/msg/DiagnosticStatus
RECORDED_S = 3600.0  # an attempt is seldom longer
RECORD_BYTES = 31 + 16  # of MCAP around each message: the record and its entry in the index, https://mcap.dev/spec


def comparisons(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Yield every comparison of the graph at a gate."""
    for part in (nodes, endpoints, streams, joints, transforms, control, cycles, lifecycle, clocks):
        yield from part(package, seen, gate)
    for part in (parameters, description, devices):
        yield from part(package, seen, gate)


def control(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare hardware components and controllers: states, types and claims."""
    for manager in package.contract["managers"].values():
        node = f"{manager['namespace'].rstrip('/')}/controller_manager"
        states, declared = package.plan["states"][node], manager["controllers"]
        hardware = seen.answers.get(f"{node}/list_hardware_components")
        expected = listed(f"{name} {state}" for name, state in states["hardware"].items())
        if hardware is None:
            yield Line("control", f"{node}, hardware", UNKNOWN, expected, "no answer")
        elif gate < CLAIMED_FROM:
            found = {each.name: each.state.label for each in hardware.component}
            yield judged("control", f"{node}, hardware", expected, differences(states["hardware"], found))
        answer = seen.answers.get(f"{node}/list_controllers")
        wanted = states["controllers"]
        if gate >= CLAIMED_FROM:
            wanted = {name: "active" if declared[name]["active"] else state for name, state in wanted.items()}
        expected = listed(f"{name} {state}" for name, state in wanted.items())
        if answer is None:
            yield Line("control", f"{node}, controllers", UNKNOWN, expected, "no answer")
            continue
        problems = differences(wanted, {each.name: each.state for each in answer.controller})
        for each in answer.controller:
            problems += _claims(each, declared[each.name]) if each.name in declared else []
        yield judged("control", f"{node}, controllers", expected, problems)


def _claims(found: Any, declared: Any) -> Iterator[str]:
    if found.type != declared["plugin"]:
        yield f"{found.name} is a {found.type}, expected {declared['plugin']}"
    claims = set(declared["command_interfaces"]) if found.state == "active" else set()
    if set(found.claimed_interfaces) != claims:
        yield f"{found.name} claims {listed(found.claimed_interfaces)}, expected {listed(claims)}"


def differences(wanted: Mapping[str, str], found: Mapping[str, str]) -> list[str]:
    """Return what is missing, not declared or in another state."""
    missing = [f"{name} is missing" for name in wanted if name not in found]
    more = [f"{name} is not declared" for name in found if name not in wanted]
    other = [
        f"{name} is {found[name]}, expected {state}"
        for name, state in wanted.items()
        if found.get(name, state) != state
    ]
    return missing + more + other


def cycles(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare the rate of each controller manager, and what its cycles took, as it says both itself.

    Sources: ros2_control@4.46.0 controller_manager/src/controller_manager.cpp:1227 (``total_time``, in us), :4693 (the
    diagnosis); @5.16.0 :1227, :4763; @6.8.0 :1226, :4763.
    """
    for manager in package.contract["managers"].values():
        node, rate = f"{manager['namespace'].rstrip('/')}/controller_manager", manager["update_rate_hz"]
        if package.plan["states"][node].get("reports", False):
            found = seen.cycles.get(node, Cycles())
            yield _rate(node, rate, found)
            yield _overruns(node, rate, found, seen)


def _rate(node: str, rate: float, found: Cycles) -> Line:
    subject, expected = f"{node}, update rate", f"{rate:g} Hz, and its own diagnosis is OK"
    if not found.statuses:
        return Line("control", subject, UNKNOWN, expected, "no diagnosis of it on /diagnostics")
    problems = list(dict.fromkeys(message for level, message, _ in found.statuses if level >= WARN))
    figures = found.statuses[-1][2]
    asked, average, slowest = (
        _number(figures.get(key)) for key in ("update_rate", "periodicity.average", "periodicity.min")
    )
    problems += [f"{asked:g} Hz is set"] if asked != rate else []
    problems += [f"{average:.4g} Hz on average"] if not average >= SLOW * rate else []
    return judged("control", subject, expected, problems, f"{average:.4g} Hz on average, {slowest:.4g} Hz at least")


def _number(text: str | None) -> float:
    """Return the number of a text; NaN where it has another form."""
    try:
        return float(text or "")
    except ValueError:
        return math.nan


def _overruns(node: str, rate: float, found: Cycles, seen: Seen) -> Line:
    subject = f"{node}, missed cycles"
    expected = f"at most {OVERRUN:.1%} of the cycles take longer than {1e3 / rate:g} ms"
    if missing := sorted(kind for kind in seen.uninstalled if kind.startswith("pal_statistics_msgs/")):
        return Line("control", subject, UNKNOWN, expected, f"{missing[0]} is not installed here")
    if not found.times_us:
        return Line("control", subject, UNKNOWN, expected, f"nothing on {node}/statistics/values")
    over = sum(time_us > 1e6 / rate for time_us in found.times_us)
    shown = f"{over} of {len(found.times_us)} cycles took longer, the longest {max(found.times_us) / 1e3:.4g} ms"
    return judged("control", subject, expected, [shown] if over > OVERRUN * len(found.times_us) else [], shown)


def clocks(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare which clock each node of the package lives by: on both targets that of its computer."""
    asked = {
        node: seen.answers[key] for node in package.plan["nodes"] if (key := f"{node}/use_sim_time") in seen.answers
    }
    simulated = [f"{node} takes its time from /clock" for node, answer in asked.items() if _is_simulated(answer)]
    silent = [node for node, answer in asked.items() if answer is None]
    line = judged("control", "use_sim_time", "false at every node", simulated, f"false at {len(asked)} nodes")
    if not simulated and (silent or not asked):
        line = Line("control", "use_sim_time", UNKNOWN, line.expected, f"no answer of {listed(silent or ['any node'])}")
    yield line


def _is_simulated(answer: Any) -> bool:
    return answer is not None and any(value.bool_value for value in answer.values)


def lifecycle(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare the states of managed nodes."""
    for node, state in package.plan["lifecycle" if gate < CLAIMED_FROM else "lifecycle_claimed"].items():
        answer = seen.answers.get(f"{node}/get_state")
        found = "no answer" if answer is None else answer.current_state.label
        verdict = UNKNOWN if answer is None else PASSED if found == state else FAILED
        yield Line("control", f"{node}, lifecycle", verdict, state, found)


def parameters(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare the parameters of each running node with its file."""
    for node, written in package.parameters.items():
        if node not in seen.nodes:
            continue
        answer, expected = seen.answers.get(f"{node}/get_parameters"), f"{len(written)} values of its file"
        if answer is None:
            yield Line("parameters", node, UNKNOWN, expected, "no answer")
            continue
        values = [getattr(each, VALUES[each.type]) if each.type != NOT_SET else None for each in answer.values]
        pairs = zip(written.items(), values, strict=False)
        # rclcpp answers with no value at all where one of the names is not declared.
        problems = [] if len(values) == len(written) else [f"{len(values)} of {len(written)} values answered"]
        problems += [
            f"{name} is {value}, expected {stated}" for (name, stated), value in pairs if not same(stated, value)
        ]
        yield judged("parameters", node, expected, problems)


def same(written: Any, found: Any) -> bool:
    """Return whether a value is the written one: numbers by their size, lists by their entries, no number unset."""
    if isinstance(written, (list, tuple)):
        return found is not None and len(written) == len(found) and all(map(same, written, found))
    if isinstance(written, (int, float)) and isinstance(found, (int, float)):
        return math.isclose(written, found, rel_tol=1e-9)
    return bool(written == found)


def description(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare the description that runs with that of the package, but for elements that a launch fills in."""
    running, written = seen.answers.get("robot_description"), Counter(_below(package.description, ""))
    if running is None:
        yield Line("parameters", "robot_description", UNKNOWN, "that of the package", "no description was published")
        return
    filled = {place for place, text in written if "$(" in text}
    differing = (written - (found := Counter(_below(running, ""))), "without"), (found - written, "with")
    problems = [f"{word} {place} {text}" for more, word in differing for place, text in more if place not in filled]
    yield judged("parameters", "robot_description", "that of the package", problems)


def _below(element: Element, above: str) -> Iterator[tuple[str, str]]:
    """Yield each element with its attributes and text, but for the file of a mesh, which a launch resolves."""
    place = f"{above}/{element.tag}" + (f"[{element.get('name')}]" if element.get("name") else "")
    attributes = [f"{name}={text}" for name, text in sorted(element.attrib.items()) if name != "filename"]
    yield place, " ".join([*attributes, (element.text or "").strip()])
    for child in element:
        yield from _below(child, place)


ANY = "any"
"""What a reading is expected to be of which nothing is stated at a gate: it is shown, and compared with nothing."""


def devices(package: Package, seen: Seen, gate: str) -> Iterator[Line]:
    """Compare what devices say of themselves with what the gate expects; what it does not expect is a figure."""
    for reading in package.plan["readings"]:
        name = reading["interface"]
        if not is_published(package, name, gate):
            continue
        names = _expected(reading, gate)
        pinned = package.contract["version_tuple"].get(reading.get("version"), UNKNOWN).rpartition(" ")[2]
        expected = " or ".join(names) or (pinned if pinned != UNKNOWN else ANY)
        subject, kind = f"{name}, {reading['name']}", package.contract["interfaces"][name]["type"]
        found = seen.readings[name].values if name in seen.readings else []
        if not found:
            absent = f"{kind} is not installed here" if kind in seen.uninstalled else "no answer"
            yield Line("vendor", subject, UNKNOWN, expected, absent)
            continue
        shown = list(dict.fromkeys(_named(value, reading.get("values", {})) for value in found))
        other = [text for text in shown if names and text not in names]
        if pinned != UNKNOWN and "version" in reading:
            other = [text for text in shown if f"{text}.".startswith(f"{pinned}.") is False]
        if expected == ANY:
            yield Line("vendor", subject, SEEN, expected, " to ".join(shown))
        else:
            yield judged("vendor", subject, expected, other, " to ".join(shown))


def _expected(reading: Any, gate: str) -> Sequence[str]:
    """Return the names of which one must show at a gate: those of the last gate up to it that states any."""
    stated = reading.get("expected", {})
    since = max((each for each in stated if each <= gate), default=None)
    return stated[since] if since is not None else ()


def _named(value: Any, values: Mapping[str, Any]) -> str:
    """Return a value by its name; as text where it has none."""
    named = (
        name for name, each in values.items() if each == value and isinstance(each, bool) == isinstance(value, bool)
    )
    return next(named, f"{value:.4g}" if isinstance(value, float) else str(value))


def space(package: Package, seen: Seen, folder: Path, gate: str) -> Line:
    """Compare the free space of the folder of the evidence with what an hour of recording takes there.

    What is recorded without a stated rate, such as states of goals, is not counted.
    """
    interfaces = package.contract["interfaces"]
    rated = [name for name in package.plan["recorded"] if interfaces.get(name, {}).get("rate_hz") is not None]
    other = len(package.plan["recorded"]) - len(rated)
    sizes = {name: _byte_rate(interfaces[name]["rate_hz"], seen.streams.get(name), seen.listened_s) for name in rated}
    unknown = [name for name, rate in sizes.items() if rate is None and is_published(package, name, gate)]
    disk = os.statvfs(folder)
    free = disk.f_bavail * disk.f_frsize
    needed = sum(rate for rate in sizes.values() if rate is not None) * RECORDED_S
    expected = (
        f"room for an hour of recording, {needed / 60e6:.4g} MB a minute without {other} topics of no stated rate"
    )
    if unknown:
        return Line("host", "space for the bag", UNKNOWN, expected, f"no message of {listed(unknown)}, so no size")
    seen_there = f"{free / 1e9:.4g} GB free"
    return judged("host", "space for the bag", expected, [seen_there] if free < needed else [], seen_there)


def _byte_rate(rate_hz: float, stream: Stream | None, listened_s: float) -> float | None:
    """Return what a topic adds to a bag, byte/s, at its stated rate or that of all its publishers; None if not seen."""
    if stream is None or not stream.arrivals:
        return None
    found_hz = len(stream.arrivals) / listened_s if listened_s else 0.0
    return max(rate_hz, found_hz) * (stream.size / len(stream.arrivals) + RECORD_BYTES)
