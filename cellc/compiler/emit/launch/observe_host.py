#!/usr/bin/env python3
"""Compares the computer that runs it with what the package states of it; it reads, and imports nothing of ROS."""

from __future__ import annotations

import json
import os
import platform
import resource
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from cellc.compiler.emit.launch.installed_versions import is_as_pinned
from cellc.compiler.emit.launch.observe_checks import FAILED, PASSED, UNKNOWN, Line, judged, listed

ANSWER_S = 10.0
LOOP_PRIORITY = 50  # what controller_manager asks for (ros2_control_node.cpp, kSchedPriority; thread_priority later)
UNSET = {"ROS_DOMAIN_ID": "0"}  # what ROS takes where a variable is not set
CARDS = Path("/sys/class/net")


def comparisons_of_host(stated: Mapping[str, Any], tuple_: Mapping[str, str], part: str) -> Iterator[Line]:
    """Yield the lines of one part: ``versions``, ``host``, ``environment`` or ``clock``."""
    if part == "versions":
        yield from versions(stated["versions"], tuple_)
    elif part == "host":
        cards = addresses()
        for name, card in stated.get("cards", {}).items():
            yield card_line(name, card, cards)
        for device, route in stated.get("routes", {}).items():
            yield route_line(device, route, stated["cards"], cards)
        yield from kernel(stated)
    if part in ("host", "environment"):
        yield environment(stated["environment"])
    if part == "clock" and "max_offset_s" in stated:
        yield clock(stated["max_offset_s"])


def versions(asked: Sequence[str], tuple_: Mapping[str, str]) -> Iterator[Line]:
    """Compare what is installed with the version tuple."""
    for part, where in (each.split("=", 1) for each in asked):
        installed, same = is_as_pinned(part, tuple_[part], where)
        verdict = UNKNOWN if same is None else PASSED if same else FAILED
        yield Line("versions", part, verdict, tuple_[part], installed)


@cache
def answer(*command: str) -> Any:
    """Return what a command prints; None where it is not installed, fails or does not end."""
    try:
        ended = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace", timeout=ANSWER_S
        )
    except (OSError, subprocess.TimeoutExpired):
        return None
    return ended.stdout if ended.returncode == 0 else None


def addresses() -> Mapping[str, str] | None:
    """Return the card of each address with its prefix length; None where `ip` gives no answer."""
    try:
        cards = json.loads(answer("ip", "-j", "addr") or "")
        pairs = [(address, card["ifname"]) for card in cards for address in card["addr_info"]]
        found = {f"{address['local']}/{address['prefixlen']}": name for address, name in pairs if "local" in address}
    except (ValueError, KeyError, TypeError):
        return None
    return found or None  # a computer without any address is an answer that was not understood


def card_line(name: str, card: Mapping[str, Any], cards: Mapping[str, str] | None) -> Line:
    """Compare address, name, state and speed of one card."""
    speed, interface = card.get("speed_bps", 0.0) / 1e6, card.get("interface")
    expected = f"{card['address']}{f' on {interface}' if interface else ''}, link up"
    expected += f", {speed:g} Mbit/s" if speed else ""
    if cards is None:
        return Line("host", f"network card {name}", UNKNOWN, expected, "`ip -j addr` gives no answer")
    found = cards.get(card["address"])
    if found is None:
        return Line("host", f"network card {name}", FAILED, expected, "no network card has this address")
    state, rate = read(CARDS / found / "operstate"), read(CARDS / found / "speed")
    problems = [f"{found} has the address"] if interface not in (None, found) else []
    problems += [f"the link of {found} is {state or 'UNKNOWN'}"] if state != "up" else []
    slow = speed and rate.isdecimal() and int(rate) < speed
    problems += [f"{rate} Mbit/s"] if slow else []
    shown = f"{found}, link {state}, {rate + ' Mbit/s' if rate.isdecimal() else 'speed UNKNOWN'}"
    if not problems and speed and not rate.isdecimal():
        return Line("host", f"network card {name}", UNKNOWN, expected, shown)
    return judged("host", f"network card {name}", expected, problems, shown)


def read(file: Path) -> str:
    """Return the text of a file of the system; empty where it has none."""
    try:
        return file.read_text(encoding="ascii", errors="replace").strip()
    except OSError:
        return ""


def route_line(
    device: str, route: Mapping[str, str], stated: Mapping[str, Any], cards: Mapping[str, str] | None
) -> Line:
    """Compare the card over which a device is reached; nothing is sent to it."""
    expected, subject = f"{route['address']} over network card {route['card']}", f"route to {device}"
    wanted = None if cards is None else cards.get(stated[route["card"]]["address"])
    try:
        (found,) = json.loads(answer("ip", "-j", "route", "get", route["address"]) or "")
        taken = found["dev"]
    except (ValueError, KeyError, TypeError):
        return Line("host", subject, UNKNOWN, expected, "`ip -j route get` gives no answer")
    same = wanted == taken and "gateway" not in found
    gateway = f" by {found['gateway']}" if "gateway" in found else ""
    return Line("host", subject, PASSED if same else FAILED, expected, f"over {taken}{gateway}")


def environment(stated: Mapping[str, str]) -> Line:
    """Compare the variables of this shell by which nodes find each other."""
    wrong = [
        f"{name} is {os.environ.get(name, 'not set')}"
        for name, value in stated.items()
        if os.environ.get(name, UNSET.get(name)) != value
    ]
    return judged("host", "environment", listed(f"{name}={value}" for name, value in stated.items()), wrong)


def kernel(stated: Mapping[str, Any]) -> Iterator[Line]:
    """Compare the preemption model of the kernel, and the priority that this user may ask for."""
    version = f"{platform.release()} {platform.version()}"
    words = {"preempt_rt": "PREEMPT_RT", "lowlatency": "lowlatency"}
    if word := words.get(stated.get("scheduling", "")):
        suited = word in version or "PREEMPT_RT" in version
        yield Line("host", "kernel", PASSED if suited else FAILED, stated["scheduling"], version)
    if stated["controls"]:
        soft, _ = resource.getrlimit(resource.RLIMIT_RTPRIO)
        enough = soft == resource.RLIM_INFINITY or soft >= LOOP_PRIORITY or os.geteuid() == 0
        shown = "unlimited" if soft == resource.RLIM_INFINITY else f"{soft}{' as root' if os.geteuid() == 0 else ''}"
        yield Line("host", "rtprio", PASSED if enough else FAILED, f"at least {LOOP_PRIORITY}", shown)


def clock(max_offset_s: float) -> Line:
    """Compare the offset of the clock with its bound, as chrony estimates it.

    Its error is at most the offset, the root dispersion and half of the root delay:
    https://chrony-project.org/doc/4.6/chronyc.html#_tracking
    """
    expected = f"within {max_offset_s * 1e3:g} ms of its reference"
    fields = (answer("chronyc", "-c", "tracking") or "").strip().split(",")
    try:
        offset_s, delay_s, dispersion_s = (float(fields[place]) for place in (4, 10, 11))
        leap = fields[13]
    except (ValueError, IndexError):
        return Line("clock", "offset", UNKNOWN, expected, "`chronyc tracking` gives no answer")
    bound_s = abs(offset_s) + dispersion_s + delay_s / 2.0
    problems = ["the clock is not synchronized"] if leap.startswith("Not ") else []
    problems += [f"{abs(offset_s) * 1e3:.4g} ms"] if abs(offset_s) > max_offset_s else []
    shown = f"{abs(offset_s) * 1e3:.4g} ms, error of the estimate at most {bound_s * 1e3:.4g} ms"
    return judged("clock", "offset", expected, problems, shown)
