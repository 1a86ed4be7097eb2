"""Folders of evidence as the programs of a package and people leave them: observers as generated, notes by hand."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cellc.compiler.emit.launch import observe_program
from cellc.compiler.emit.launch.observe_checks import PASSED, Line, Seen
from tests.attempt.hand_made import arrived
from tests.cells import build_into, generated, spec_text, written
from tests.cli.run import run
from tests.consumers.test_observe import right

SECONDS = {"G0": 0, "L1": 0, "L3": 5, "L4": 60, "L5": 30, "G3": 600, "G4": 10, "G7": 30}
"""As the checklists ask for; at G0 and L1 the computer alone is read."""
JOINTS = ("wrist_3", "wrist_2", "wrist_1", "elbow", "shoulder_lift", "shoulder_pan")
METADATA = """\
rosbag2_bagfile_information:
  version: 9
  storage_identifier: mcap
  duration:
    nanoseconds: 6000000000
  starting_time:
    nanoseconds_since_epoch: 1782900000000000000
  message_count: 1234
  topics_with_message_count:
    - topic_metadata:
        name: /joint_states
      message_count: 1234
"""
"""As `ros2 bag record` of Jazzy writes it, with one topic."""


_PINNED = {
    "{image: UNKNOWN, configuration: UNKNOWN}": f"{{image: 'registry/cell@sha256:{64 * '7'}', configuration: 5f0c2d1}}",
    "    revision: UNKNOWN\n    serial: UNKNOWN\n": "    revision: A\n    serial: '20265300123'\n",
    "    revision: UNKNOWN\n    firmware: UNKNOWN\n": (
        "    revision: B\n    serial: C-1\n    firmware: firmware 1.4\n    sdk: serial 1.2.1\n"
    ),
    "    firmware: UNKNOWN\n": "    revision: C\n    serial: '923322071234'\n    firmware: firmware 5.16.0.1\n",
}
"""What a person enters for what is UNKNOWN in the spec of ur5e_pick."""


@cache
def package(cell: str) -> Path:
    """Return the generated folder of a cell; that of ur5e_pick has no version that is UNKNOWN, which G0 stops on."""
    if cell != "ur5e_pick":
        return generated(cell)
    text = spec_text(cell)
    for unknown, pinned in _PINNED.items():
        assert text.count(unknown) == 1
        text = text.replace(unknown, pinned)
    folder = Path(_folders().name)
    return build_into(folder / cell, written(folder, text))


@cache
def _folders() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()


def manifest(cell: str) -> Mapping[str, Any]:
    """Return manifest.json."""
    read: Mapping[str, Any] = json.loads((package(cell) / "manifest.json").read_text(encoding="utf-8"))
    return read


def observe(
    folder: Path,
    cell: str,
    gate: str,
    *,
    host: str = "",
    seconds: float | None = None,
    at: str = "20261128T101500Z",
    wrong: Callable[[Seen], object] = lambda seen: None,
    target: str = "real",
) -> Path:
    """Run the observer of a package on a graph that is as the package states it, but for what is wrong."""
    folder_of_cell = package(cell)
    for_s = SECONDS[gate] if seconds is None else seconds
    seen = right(observe_program.read_package(folder_of_cell, target), gate if gate.startswith("G") else "G3")
    seen.listened_s = for_s
    for stream in seen.streams.values():  # arrivals of ten seconds, of which the rate is taken
        stream.arrivals = stream.arrivals * max(1, int(for_s / 10.0))
    wrong(seen)
    words = ["--package", str(folder_of_cell), "--gate", gate, "--for", str(for_s), "--evidence", str(folder)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(observe_program, "Graph", lambda _enclave: SimpleNamespace(close=lambda: None))
        patch.setattr(observe_program, "comparisons_of_host", lambda _stated, _tuple, part: [computer(part)])
        patch.setattr(observe_program, "look", lambda _graph, _package, _for: seen)
        clock = SimpleNamespace(strftime=lambda *_: at, gmtime=lambda: None)
        patch.setattr(observe_program, "time", clock)
        observe_program.main([*words, "--target", target, *(["--host", host] if host else [])])
    return folder / f"observe-{gate}-{at}.json"


def computer(part: str) -> Line:
    """Return the line of a computer that is as the package states it."""
    return Line(part, "computer", PASSED, "as stated", "as stated")


def first_goal(folder: Path, joint: str, then: str, verdict: str = "PASSED", **other: str) -> Path:
    """Write the record of a first goal."""
    at = "20261128T103000Z"
    record = {"attempt_id": at, "cell": "ur5e_pick", "configuration_id": manifest("ur5e_pick")["configuration_id"]}
    record |= {"gate": "G7", "joint": joint, "then": then, "verdict": verdict, "seen": "", **other}
    place = folder / f"G7-first-goal-{joint}-{then}-{at}.json"
    place.write_text(json.dumps(record), encoding="utf-8")
    return place


def notes(folder: Path, cell: str) -> None:
    """Write the notes of every gate, by the names that the checklists print."""
    for page in ("promotion", "network"):
        text = (package(cell) / f"gates/{page}.md").read_text(encoding="utf-8")
        for name in re.findall(r"^Evidence: `(.+?)`\\. ".replace("\\\\", "\\"), text, re.MULTILINE):
            (folder / name).write_text("done\n", encoding="utf-8")
    stated = (package(cell) / "manifest.json").read_text(encoding="utf-8")
    (folder / "G0-inventory.md").write_text(f"{stated}\n+ uname -r\n6.8.1-1015-realtime\n", encoding="utf-8")


def ticked(folder: Path, cell: str) -> None:
    """Leave copies of the checklists with every line ticked."""
    for page in ("promotion", "network"):
        text = (package(cell) / f"gates/{page}.md").read_text(encoding="utf-8")
        (folder / f"{page}.md").write_text(text.replace("- [ ]", "- [x]"), encoding="utf-8")


def complete(folder: Path) -> Path:
    """Leave in a folder all that the gates of ur5e_pick ask for."""
    folder.mkdir()
    notes(folder, "ur5e_pick")
    ticked(folder, "ur5e_pick")
    for gate in SECONDS:
        observe(folder, "ur5e_pick", gate)
    (folder / "G6-bag").mkdir()
    (folder / "G6-bag/metadata.yaml").write_text(METADATA, encoding="utf-8")
    for joint in JOINTS:
        first_goal(folder, f"arm_{joint}_joint", "end")
    first_goal(folder, "arm_wrist_3_joint", "cancel")
    bag = arrived().write(folder / "G7-bag").as_posix()
    assert run("attempt", bag, "--package", package("ur5e_pick").as_posix(), "-o", folder.as_posix()).code == 0
    return folder
