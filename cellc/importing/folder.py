"""The device folder on disk: description, the meshes that its collision shapes use, and a lock over both."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from cellc.feasibility import MotionAnswer, motion_answer
from cellc.importing.cell_text import GROUP, FirstCell, cell_text
from cellc.importing.chain import Chain, home_of
from cellc.importing.device_text import DESCRIPTION, Judged, Pairs, device_facts, device_text
from cellc.importing.first_motion import first_goal
from cellc.importing.merge import Facts, facts_in, merged, rewritten
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
_PASSES = 4
"""A finding may hide others: of geometry, where the limits of a joint are not known."""


@dataclass(frozen=True, slots=True)
class Written:
    """What a run wrote: files and their size in bytes, whether a device.yaml of a person stayed, and what is found.

    Attributes:
        changed: keys of a person's device.yaml whose values the vendor changed.
        away: where the joints of the chain may go first, rad or m.
    """

    files: int
    size: int
    kept: bool
    changed: tuple[str, ...]
    checked: Checked
    away: tuple[float, ...]


def write_folder(folder: Path, robot: Robot, chain: Chain, disabled: Pairs, day: str) -> Written:
    """Write the folder; what a person wrote into a ``device.yaml`` that is there stays."""
    files = {DESCRIPTION: robot.text.encode()}
    files |= {_inside(name): path.read_bytes() for name, path in robot.meshes.items()}
    for name, content in files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
    device = _Device(folder, robot, _imported_before(folder), day)
    checked, away = _settled(device, chain, disabled)
    lock = {
        "source": robot.file.name,
        "files": {name: _hash(content) for name, content in sorted(files.items())},
        "device": device.imported,
    }
    write_whole(folder / LOCK, json.dumps(lock, indent=2) + "\n")
    size = sum(map(len, files.values()))
    return Written(len(files) + 2, size, device.kept, device.changed, checked, away)


def _settled(device: _Device, chain: Chain, disabled: Pairs) -> tuple[Checked, tuple[float, ...]]:
    """Write the ``device.yaml`` until a check finds nothing new in it, first at home, then where the robot goes."""
    judged, away = Judged(disabled), tuple(home_of(joint) for joint in chain.joints)
    for at_home in (True, False):
        for _ in range(_PASSES):
            device.write(chain, judged)
            before, (judged, checked) = judged, _judged(device.folder, chain, away, judged)
            if judged == before:
                break
        if at_home:
            away = first_goal(checked.graph, GROUP, chain)
    return checked, away


class _Device:
    """The ``device.yaml`` of a folder, which a person may have written into since the last import.

    Attributes:
        kept: whether there was one.
        changed: keys whose values the vendor changed since.
        imported: what this import would have written by itself.
    """

    def __init__(self, folder: Path, robot: Robot, before: Facts, day: str) -> None:
        self.folder, self._file = folder, folder / "device.yaml"
        self._robot, self._before, self._day = robot, before, day
        self._text = self._file.read_text(encoding="utf-8") if self._file.exists() else ""
        self._person = facts_in(self._text) if self._text else None
        self.kept = self._file.exists()
        self.changed: tuple[str, ...] = ()
        self.imported: Facts = {}

    def write(self, chain: Chain, judged: Judged) -> None:
        """Write what the files say, and what a person says otherwise."""
        day = self._before.get("as_of", self._day) if self.kept else self._day
        self.imported = facts = device_facts(self._robot, chain, judged, day)
        if not self.kept:
            write_whole(self._file, device_text(self._robot, judged, facts))
        elif self._person is not None and self._before:  # of one that was not imported nobody knows what is whose
            found = merged(self._before, facts, self._person)
            keys = dict.fromkeys((*self._person, *found))
            self.changed = tuple(key for key in keys if self._person.get(key) != found.get(key))
            write_whole(self._file, rewritten(self._text, self._person, found))


def _imported_before(folder: Path) -> Facts:
    """Return what the last import into a folder found; nothing where there was none, or an older one."""
    if not (folder / LOCK).is_file():
        return {}
    found: Facts = json.loads((folder / LOCK).read_text(encoding="utf-8")).get("device", {})
    return found


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
        spec.write_text(cell_text("imported", "./", FirstCell(chain, away)), encoding="utf-8")
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
