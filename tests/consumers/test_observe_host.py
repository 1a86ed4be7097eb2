"""The part of the observer that compares the computer: versions, cards, routes, environment, kernel and clock.

Outputs are in the format of iproute2 6.1 (``ip -j``) and of chrony 4 (``chronyc -c tracking``: the fields of
https://chrony-project.org/doc/4.6/chronyc.html#_tracking in their order).
"""

from __future__ import annotations

import json
import os
import platform
import resource
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.emit.launch import observe_host
from cellc.compiler.emit.launch.observe_checks import FAILED, PASSED, UNKNOWN, Line
from cellc.compiler.emit.launch.observe_host import comparisons_of_host
from tests.consumers.matrix import build

_ADDRESSES = [
    {"ifname": "lo", "addr_info": [{"family": "inet", "local": "127.0.0.1", "prefixlen": 8}]},
    {"ifname": "enp3s0", "addr_info": [{"family": "inet", "local": "192.168.56.10", "prefixlen": 24}]},
    {"ifname": "enp4s0", "addr_info": [{"family": "inet", "local": "10.10.0.10", "prefixlen": 24}]},
]
_STATED: Mapping[str, Any] = {
    "versions": [],
    "cards": {
        "robot": {"address": "192.168.56.10/24"},
        "bulk": {"address": "10.10.0.10/24", "interface": "enp4s0", "speed_bps": 1e9},
    },
    "routes": {"arm": {"address": "192.168.56.101", "card": "robot"}},
    "environment": {"ROS_DOMAIN_ID": "42", "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"},
    "scheduling": "preempt_rt",
    "controls": True,
    "max_offset_s": 0.001,
    "synchronized_by": "chrony",
}
_TRACKING = "C0A83801,192.168.56.1,3,1764319200.1,{offset},0.0000021,0.00002,-3.5,0.01,0.09,0.0004,0.0001,64.2,{leap}\n"


class Computer:
    """A computer whose commands, cards and kernel answer as a test says."""

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self.folder, self._patch = folder, patch
        (folder / "bin").mkdir()
        patch.setenv("PATH", str(folder / "bin"))
        patch.setattr(observe_host, "CARDS", folder / "net")
        self.prints("ip", json.dumps(_ADDRESSES), **{"route get": json.dumps([{"dst": "x", "dev": "enp3s0"}])})
        for card in ("enp3s0", "enp4s0"):
            self.card(card, "up", "1000")
        self.kernel("6.8.1-1015-realtime", "#16-Ubuntu SMP PREEMPT_RT")
        self.priority(99)
        for name, value in _STATED["environment"].items():
            patch.setenv(name, value)

    def prints(self, command: str, text: str, **of_arguments: str) -> None:
        """Let a command print a text, or another where its arguments hold some words."""
        file = self.folder / "bin" / command
        cases = "".join(f"  *'{words}'*) echo '{said}' ;;\n" for words, said in of_arguments.items())
        file.write_text(f"#!/bin/sh\ncase \"$*\" in\n{cases}  *) echo '{text}' ;;\nesac\n", encoding="latin-1")
        file.chmod(0o755)
        observe_host.answer.cache_clear()

    def card(self, name: str, state: str, speed: str) -> None:
        (self.folder / "net" / name).mkdir(parents=True, exist_ok=True)
        (self.folder / "net" / name / "operstate").write_text(f"{state}\n", encoding="ascii")
        (self.folder / "net" / name / "speed").write_text(f"{speed}\n", encoding="ascii")

    def kernel(self, release: str, version: str) -> None:
        self._patch.setattr(platform, "release", lambda: release)
        self._patch.setattr(platform, "version", lambda: version)

    def priority(self, soft: int) -> None:
        self._patch.setattr(resource, "getrlimit", lambda _: (soft, soft))
        self._patch.setattr(os, "geteuid", lambda: 1000)

    def lines(self, part: str = "host", **stated: Any) -> dict[str, Line]:
        lines = comparisons_of_host({**_STATED, **stated}, {}, part)
        return {line.subject: line for line in lines}


@pytest.fixture
def computer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Computer:
    return Computer(tmp_path, monkeypatch)


def test_computer_as_the_package_states_it_passes(computer: Computer) -> None:
    computer.prints("chronyc", _TRACKING.format(offset="-0.000006523", leap="Normal"))
    lines = computer.lines() | computer.lines("clock")
    assert {line.verdict for line in lines.values()} == {PASSED}
    assert {*lines} == {
        *("network card robot", "network card bulk", "route to arm", "environment", "kernel", "rtprio", "offset")
    }
    # Root dispersion and half of the root delay are part of the error: 0.0065 + 0.1 + 0.2 ms.
    assert lines["offset"].seen == "0.006523 ms, error of the estimate at most 0.3065 ms"


def _no_address(computer: Computer) -> None:
    computer.prints("ip", json.dumps(_ADDRESSES[:2]), **{"route get": json.dumps([{"dev": "enp3s0"}])})


def _other_card(computer: Computer) -> None:
    swapped = [{**_ADDRESSES[1], "ifname": "enp4s0"}, {**_ADDRESSES[2], "ifname": "enp3s0"}]
    computer.prints("ip", json.dumps(swapped), **{"route get": json.dumps([{"dev": "enp4s0"}])})


def _other_route(computer: Computer) -> None:
    computer.prints("ip", json.dumps(_ADDRESSES), **{"route get": json.dumps([{"dev": "enp4s0"}])})


def _by_gateway(computer: Computer) -> None:
    found = [{"dev": "enp3s0", "gateway": "192.168.56.1"}]
    computer.prints("ip", json.dumps(_ADDRESSES), **{"route get": json.dumps(found)})


@pytest.mark.parametrize(
    ("wrong", "subject", "seen"),
    [
        (_no_address, "network card bulk", "no network card has this address"),
        (_other_card, "network card bulk", "enp3s0 has the address"),
        (lambda computer: computer.card("enp3s0", "down", ""), "network card robot", "the link of enp3s0 is down"),
        (lambda computer: computer.card("enp4s0", "up", "100"), "network card bulk", "100 Mbit/s"),
        (_other_route, "route to arm", "over enp4s0"),
        (_by_gateway, "route to arm", "over enp3s0 by 192.168.56.1"),
        (lambda computer: computer.kernel("6.8.0-45-generic", "#45-Ubuntu SMP PREEMPT_DYNAMIC"), "kernel", "6.8.0-45"),
        (lambda computer: computer.priority(0), "rtprio", "0"),
    ],
)
def test_each_wrong_fails_in_its_line_alone(computer: Computer, wrong: Any, subject: str, seen: str) -> None:
    wrong(computer)
    failed = {line.subject: line.seen for line in computer.lines().values() if line.verdict == FAILED}
    assert list(failed) == [subject]
    assert seen in failed[subject]


@pytest.mark.parametrize("variable", ["ROS_DOMAIN_ID", "RMW_IMPLEMENTATION"])
def test_shell_of_another_domain_or_middleware_fails(
    computer: Computer, variable: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(variable)
    line = computer.lines()["environment"]
    assert line.verdict == FAILED
    assert line.seen == f"{variable} is not set"


@pytest.mark.parametrize(
    ("offset", "leap", "seen"), [("0.0021", "Normal", "2.1 ms"), ("0.0", "Not synchronised", "not synchronized")]
)
def test_clock_beyond_its_bound_or_without_a_reference_fails(
    computer: Computer, offset: str, leap: str, seen: str
) -> None:
    computer.prints("chronyc", _TRACKING.format(offset=offset, leap=leap))
    line = computer.lines("clock")["offset"]
    assert line.verdict == FAILED
    assert seen in line.seen


@pytest.mark.parametrize("said", ["", "506 Cannot talk to daemon", "[1, 2]", "{}", '[{"ifname": "lo"}]', "\xff"])
def test_command_that_is_absent_or_answers_otherwise_is_unknown(computer: Computer, said: str) -> None:
    for command in ("ip", "chronyc"):
        computer.prints(command, said) if said else (computer.folder / "bin" / command).unlink(missing_ok=True)
    lines = computer.lines() | computer.lines("clock")
    unknown = {line.subject for line in lines.values() if line.verdict == UNKNOWN}
    assert unknown == {"network card robot", "network card bulk", "route to arm", "offset"}


def test_speed_that_a_card_does_not_show_is_unknown(computer: Computer) -> None:
    computer.card("enp4s0", "up", "-1")
    assert computer.lines()["network card bulk"].verdict == UNKNOWN


def test_what_the_package_does_not_state_has_no_line(computer: Computer) -> None:
    bare = {"versions": (), "environment": {}, "controls": False}
    parts = [line for part in ("versions", "host", "clock") for line in comparisons_of_host(bare, {}, part)]
    assert [line.subject for line in parts] == ["environment"]


def test_emitted_program_compares_this_computer_without_a_graph(tmp_path: Path) -> None:
    for path, text in build("ur5e_pick", "jazzy").texts.items():
        if path.startswith(("scripts/", "config/", "urdf/")) or path == "contract.json":
            (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path).write_text(text, encoding="utf-8")
    for gate, subjects in (
        ("G0", {"os", "kernel", "arm.driver"}),
        ("L1", {"network card robot", "route to arm", "environment"}),
    ):
        command = [sys.executable, str(tmp_path / "scripts/observe"), "--package", str(tmp_path), "--gate", gate]
        env = {"PATH": "/nowhere", "ROS_DOMAIN_ID": "41"}
        ended = subprocess.run([*command, "--evidence", str(tmp_path)], env=env, capture_output=True, text=True)
        assert (ended.returncode, ended.stderr) == (1, "")
        (report,) = tmp_path.glob(f"observe-{gate}-*.json")
        lines = {line["subject"]: line for line in json.loads(report.read_text(encoding="utf-8"))["lines"]}
        assert lines.keys() >= subjects
    assert lines["environment"]["seen"] == "ROS_DOMAIN_ID is 41; RMW_IMPLEMENTATION is not set"
    assert lines["network card robot"]["verdict"] == UNKNOWN


@pytest.mark.skipif(shutil.which("ip") is None, reason="iproute2 is not installed")
def test_what_this_computer_prints_is_understood(monkeypatch: pytest.MonkeyPatch) -> None:
    observe_host.answer.cache_clear()
    cards = observe_host.addresses()
    shown = subprocess.run(["ip", "-o", "addr"], capture_output=True, text=True, check=True).stdout
    assert cards is not None
    assert cards["127.0.0.1/8"] == "lo"
    assert all(address in shown for address in cards)
    stated = {"here": {"address": "127.0.0.1/8"}}
    line = observe_host.route_line("itself", {"address": "127.0.0.1", "card": "here"}, stated, cards)
    assert (line.verdict, line.seen) == (PASSED, "over lo")
