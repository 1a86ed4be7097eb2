"""The device folder on disk: description, the meshes that its collision shapes use, and a lock over both."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from cellc.feasibility import MotionAnswer, motion_answer
from cellc.importing.cell_text import GROUP, cell_text
from cellc.importing.chain import Chain, home_of
from cellc.importing.device_text import DESCRIPTION, Judged, Pairs, device_text
from cellc.importing.first_motion import first_goal
from cellc.importing.source import Robot
from cellc.pipeline import Checked, check
from cellc.store.swap import write_whole

LOCK = "import.lock.json"
_TOUCHING = "UNKNOWN: they touch where every joint is at its home, and nobody has said that they may"
_NOT_DRIVEN = "UNKNOWN: its description states none for some joints, and no controller commands those"
_EXCUSES = {
    "impossible-inertia": "as its description has it; no motion is planned with it, and nobody weighed the links",
    "mimic-of-nothing": "UNKNOWN: the joint to follow is not in its description; it stands at its home by itself",
    "missing-joint-limits": _NOT_DRIVEN,
    "missing-velocity-limit": _NOT_DRIVEN,
}
_PASSES = 3
"""A finding may hide others: of geometry, where the limits of a joint are not known."""


@dataclass(frozen=True, slots=True)
class Written:
    """What a run wrote: files and their size in bytes, whether a device.yaml of a person stayed, and what is found.

    Attributes:
        away: where the joints of the chain may go first, rad or m.
    """

    files: int
    size: int
    kept: bool
    checked: Checked
    away: tuple[float, ...]


def write_folder(folder: Path, robot: Robot, chain: Chain, disabled: Pairs, day: str) -> Written:
    """Write the folder; a ``device.yaml`` that is there stays as a person left it."""
    files = {DESCRIPTION: robot.text.encode()}
    files |= {_inside(name): path.read_bytes() for name, path in robot.meshes.items()}
    for name, content in files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
    lock = {"source": robot.file.name, "files": {name: _hash(content) for name, content in sorted(files.items())}}
    write_whole(folder / LOCK, json.dumps(lock, indent=2) + "\n")
    kept = (folder / "device.yaml").exists()
    if not kept:
        write_whole(folder / "device.yaml", device_text(robot, chain, Judged(disabled), day))
    home = tuple(home_of(joint) for joint in chain.joints)
    judged, checked = _judged(folder, chain, home, Judged(disabled))
    for _ in range(0 if kept else _PASSES):
        write_whole(folder / "device.yaml", device_text(robot, chain, judged, day))
        before, (judged, checked) = judged, _judged(folder, chain, home, judged)
        if judged == before:
            break
    away = first_goal(checked.graph, GROUP, chain)
    judged, checked = _judged(folder, chain, away, judged)
    return Written(len(files) + 2, sum(map(len, files.values())), kept, checked, away)


def changed_files(folder: Path) -> Iterator[str]:
    """Yield the files that are not as they were imported."""
    lock = json.loads((folder / LOCK).read_text(encoding="utf-8"))
    files: Mapping[str, str] = lock["files"]
    for name, digest in files.items():
        if not (folder / name).is_file() or _hash((folder / name).read_bytes()) != digest:
            yield name


def _inside(name: str) -> str:
    return name.removeprefix("package://")


def _hash(content: bytes) -> str:
    return f"sha256:{hashlib.sha256(content).hexdigest()}"


def _judged(folder: Path, chain: Chain, away: tuple[float, ...], before: Judged) -> tuple[Judged, Checked]:
    """Check the folder in a cell of its own, and return what of the description has to be taken on trust."""
    spec = folder / ".import.yaml"  # in the folder, so that findings name its files
    try:
        spec.write_text(cell_text("imported", "./", chain, away, "jazzy"), encoding="utf-8")
        checked = check(spec)
        graph = checked.graph
        excused = {one.code: _EXCUSES[one.code] for one in checked.diagnostics if one.code in _EXCUSES}
        touching = dict(before.allowed)
        answer = MotionAnswer() if graph is None else motion_answer(graph)
    finally:
        spec.unlink()
    for contact in (*answer.start, *(one for pose in answer.poses for one in pose.contacts)):
        first, second = sorted(link.removeprefix("arm_") for link in (contact.first, contact.second))
        touching.setdefault((first, second), _TOUCHING)
    return Judged(touching, {**before.excused, **excused}), checked
