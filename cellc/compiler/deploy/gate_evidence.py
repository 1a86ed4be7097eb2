"""What each gate must leave behind: the files that the commands of its lines write, and the notes of people."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from itertools import pairwise

from cellc.compiler.deploy.gates import Gate
from cellc.contract.gates import GateEvidence, GateFile


def left_by(gate: Gate) -> GateEvidence:
    """Return what a gate leaves, and who signs it; a gate that must not be passed leaves nothing."""
    whole = (command.replace("\\\n", " ") for check in gate.checks for command in check.commands)
    commands = (line for command in whole for line in command.splitlines())
    files = (GateFile(name=gate.evidence), *(file for command in commands for file in _written(command)))
    return GateEvidence(
        gate=gate.code,
        title=gate.title,
        shows=gate.shows,
        signed_by=gate.owner,
        files=() if gate.closed else tuple(dict.fromkeys(files)),
        measured=gate.measured,
    )


def _written(command: str) -> Iterator[GateFile]:
    """Yield what a command writes into the folder of the attempt beside its output."""
    words = shlex.split(command)
    options = {name: value for name, value in pairwise(words) if name.startswith("-")}
    if words[:2] == ["ros2", "run"] and words[3:4] == ["observe"]:
        gate, host = options["--gate"], options.get("--host")
        yield GateFile(name=f"observe-{gate}-*.json", kind="observe", host=host, least_s=_seconds(options))
    elif words[:3] == ["ros2", "bag", "record"]:
        yield GateFile(name=_inside(options["--output"]), kind="bag")
    elif words[:2] == ["ros2", "launch"] and words[3:4] == ["goal.launch.xml"]:
        given: Mapping[str, str] = dict(word.split(":=", 1) for word in words if ":=" in word)
        yield GateFile(name=f"G7-first-goal-{given['joint']}-{given.get('then', 'end')}-*.json", kind="first_goal")
    elif words[:2] == ["cellc", "attempt"]:
        yield GateFile(name=f"{_inside(words[2])}.attempt.json", kind="attempt")


def _seconds(options: Mapping[str, str]) -> float | None:
    """Return how long a command listens; None where it reads the computer alone."""
    return float(options["--for"]) if "--for" in options else None


def _inside(path: str) -> str:
    return path.removeprefix("$E/")
