"""The device folder on disk: description, the meshes that its collision shapes use, and a lock over both."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

from cellc.compiler.catalog.device_model import device_kinds
from cellc.compiler.feasibility import MotionAnswer, motion_answer
from cellc.compiler.output.manifest import hashes_in, sha256
from cellc.compiler.output.plan import check_paths, check_places, content_of, is_inside
from cellc.compiler.output.write import write
from cellc.compiler.pipeline import Checked, check
from cellc.contract.diagnostics import Diagnostic, Outcome, Related, Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.limits import limits
from cellc.contract.store.staging import discard, make_staging, others
from cellc.contract.store.swap import make_folder, replace_whole, write_new, write_whole
from cellc.robot.description.meshes import read_pieces
from cellc.tools.importing.cell_text import FirstCell, cell_text
from cellc.tools.importing.chain import home_of
from cellc.tools.importing.device_text import DESCRIPTION, Judged, Pairs, device_facts, device_text
from cellc.tools.importing.first_motion import first_goal
from cellc.tools.importing.merge import Facts, facts_in, merged, rewritten
from cellc.tools.importing.meshes import path_in_folder
from cellc.tools.importing.role import Role
from cellc.tools.importing.source import Robot

LOCK = "import.lock.json"
_DEVICE = "device.yaml"
_TOUCHING = "UNKNOWN: they touch where every joint is at its home, and nothing states that they may"
_NOT_DRIVEN = "UNKNOWN: its description states none for some joints, and no controller commands those"
_EXCUSES = {
    "impossible-inertia": "as in its description; no motion is planned with it, and the links were not weighed",
    "mimic-of-nothing": "UNKNOWN: the joint to follow is not in its description; it stays at its home by itself",
    "missing-joint-limits": _NOT_DRIVEN,
    "missing-velocity-limit": _NOT_DRIVEN,
}
_ASKED = {
    "broken-flange-convention": "`tool0` is turned or shifted against `flange`: which way do tools point? "
    "REP 199 has z of `tool0` along x of `flange`, and the same origin"
}
_PASSES = 4
"""A finding may hide others: of geometry, where the limits of a joint are not known."""


@dataclass(frozen=True, slots=True)
class Written:
    """What a run made: files and their size in bytes, whether a device.yaml of a person stayed, and what is found.

    Attributes:
        changed: keys of a person's device.yaml whose values the vendor changed.
        lost: whether the lock of the last import was damaged.
        away: where the joints of the chain may go first, rad or m.
    """

    files: int
    size: int
    kept: bool
    changed: tuple[str, ...]
    lost: bool
    checked: Findings
    away: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class _File:
    """A file of the folder before it is written."""

    path: str
    content: bytes
    executable: bool = False


def write_folder(
    folder: Path, robot: Robot, role: Role, disabled: Pairs, day: str, *, force: bool = False
) -> Outcome[Written]:
    """Write the folder as a whole; what a person wrote into a ``device.yaml`` that is there stays.

    Args:
        force: discard edits of what an earlier import wrote.

    Raises:
        MeshError: a mesh has become too large meanwhile.
        OSError: it cannot be read, or the folder cannot be written.
    """
    copied = (_File(path_in_folder(name), b"".join(read_pieces(path))) for name, path in robot.meshes.items())
    files = (_File(DESCRIPTION, robot.text.encode()), *copied)
    named = (*files, _File(_DEVICE, b""), _File(LOCK, b""))
    refused = tuple(check_paths(named, folder)) or tuple(check_places(named, folder))
    if refused:
        return Outcome(None, refused)
    device = _Device(folder, robot, day)
    checked, away = _tried(folder, files, device, role, disabled)
    lock = {
        "format": 1,
        "source": robot.file.name,
        "files": {file.path: f"sha256:{sha256(file.content)}" for file in sorted(files, key=lambda one: one.path)},
        "device": device.imported,
    }
    text = json.dumps(lock, indent=2) + "\n"
    whole = (*files, _File(_DEVICE, device.content), _File(LOCK, text.encode()))
    report = write(whole, folder, force=force, index=LOCK, known=device.known)
    if report.value is None:
        return Outcome(None, report.diagnostics)
    size = sum(len(file.content) for file in files)
    return Outcome(Written(len(whole), size, device.kept, device.changed, device.lost, checked, away))


def _tried(
    folder: Path, files: tuple[_File, ...], device: _Device, role: Role, disabled: Pairs
) -> tuple[Findings, tuple[float, ...]]:
    """Settle the ``device.yaml`` in a folder beside the place, which is removed afterwards."""
    place = folder.parent / f"{folder.name}.import"
    for left in others(place):
        discard(left)
    make_folder(folder.parent)
    staging = make_staging(place)
    try:
        for file in files:
            write_new(staging / file.path, file.content)
        checked, away = _settled(staging, device, role, disabled)
        return _named(checked.findings, staging.as_posix(), folder.as_posix()), away
    finally:
        discard(staging)


def _named(findings: Findings, before: str, after: str) -> Findings:
    """Return findings with one folder in the place of another."""

    def at(span: Span) -> Span:
        return replace(span, file=span.file.replace(before, after))

    def moved(one: Diagnostic) -> Diagnostic:
        related = tuple(Related(other.message.replace(before, after), at(other.span)) for other in one.related)
        message, advice = one.message.replace(before, after), one.help.replace(before, after)
        return replace(one, span=at(one.span), related=related, message=message, help=advice)

    texts = {name.replace(before, after): text for name, text in findings.texts.items()}
    return Findings(findings.file.replace(before, after), texts, tuple(map(moved, findings.diagnostics)))


def _settled(staging: Path, device: _Device, role: Role, disabled: Pairs) -> tuple[Checked, tuple[float, ...]]:
    """Write the ``device.yaml`` until a check finds nothing new in it, first at home, then where the robot goes."""
    judged, away = Judged(disabled), tuple(home_of(joint) for joint in role.chain.joints)
    for at_home in (True, False):
        for _ in range(_PASSES):
            device.settle(role, judged)
            replace_whole(staging / _DEVICE, device.content)
            before, (judged, checked) = judged, _judged(staging, role, away, judged)
            if judged == before:
                break
        if at_home:
            away = first_goal(checked.graph, role.group, role.chain)
    return checked, away


class _Device:
    """The ``device.yaml`` of a folder, which a person may have written into since the last import.

    Attributes:
        text: of the file, as it shall be.
        known: the hash of the file that it is made from, by its name; nothing without one.
        kept: whether there was one.
        changed: keys whose values the vendor changed since.
        lost: whether the lock of the last import is damaged: which values are of a person is not known.
        imported: what this import would have written by itself.
    """

    def __init__(self, folder: Path, robot: Robot, day: str) -> None:
        held = content_of(folder / _DEVICE)
        self.kept, self.known = held is not None, {} if held is None else {_DEVICE: sha256(held)}
        self._former = "" if held is None else held.decode("utf-8", "surrogateescape")
        self._person = facts_in(self._former) if self.kept and len(self._former) <= limits().spec_bytes else None
        before = _imported_before(folder)
        self._before, self.lost = before or {}, before is None and self.kept
        self._robot, self._day = robot, day
        self.text = self._former
        self.changed: tuple[str, ...] = ()
        self.imported: Facts = {}

    @property
    def content(self) -> bytes:
        """What the file shall hold."""
        return self.text.encode("utf-8", "surrogateescape")

    def settle(self, role: Role, judged: Judged) -> None:
        """Say what the files say, and what a person says otherwise."""
        day = self._before.get("as_of", self._day) if self.kept else self._day
        self.imported = facts = device_facts(self._robot, role, judged, day)
        if not self.kept:
            self.text = device_text(self._robot, role, judged, facts)
        elif self._person is not None and self._before:  # without an import record, no line has a known author
            merged_facts = merged(self._before, facts, self._person)
            keys = dict.fromkeys((*self._person, *merged_facts))
            self.changed = tuple(key for key in keys if self._person.get(key) != merged_facts.get(key))
            self.text = rewritten(self._former, self._person, merged_facts)


def _imported_before(folder: Path) -> Facts | None:
    """Return what the last import into a folder found; nothing where there was none, None of a damaged lock."""
    held = content_of(folder / LOCK)
    if held is None:
        return {}
    try:
        lock = json.loads(held)
    except (ValueError, RecursionError):
        return None
    digests = lock.get("device", {}) if isinstance(lock, dict) else None  # an older one has none
    return digests if isinstance(digests, dict) else None


def kept_kind(folder: Path) -> str | None:
    """Return the kind in the ``device.yaml`` of an imported folder; None if it has no such file."""
    held = content_of(folder / _DEVICE) if _imported_before(folder) else None
    facts = facts_in(held.decode("utf-8", "surrogateescape")) if held and len(held) <= limits().spec_bytes else None
    kind = (facts or {}).get("kind")
    return kind if kind in device_kinds() else None


def changed_files(folder: Path) -> tuple[str, ...] | None:
    """Return the files that are not as they were imported; None where the folder has no lock of an import."""
    held = content_of(folder / LOCK)
    hashes = hashes_in(held)
    if not hashes or not all(is_inside(path, folder) for path in hashes):
        return None
    contents = {path: content_of(folder / path, limits().mesh_bytes) for path in hashes}
    return tuple(path for path, content in contents.items() if content is None or sha256(content) != hashes[path])


def _judged(folder: Path, role: Role, away: tuple[float, ...], before: Judged) -> tuple[Judged, Checked]:
    """Check the folder in a cell of its own, and return what of the description has to be taken on trust."""
    spec = folder / ".import.yaml"  # in the folder, so that findings name its files
    write_whole(spec, cell_text("imported", "./", FirstCell(role, away)))
    checked = check(spec)
    graph = checked.graph
    excused = {
        diagnostic.code: _EXCUSES[diagnostic.code] for diagnostic in checked.diagnostics if diagnostic.code in _EXCUSES
    }
    asked = tuple(_ASKED[code] for code in sorted({finding.code for finding in checked.diagnostics} & set(_ASKED)))
    touching = dict(before.allowed)
    answer = MotionAnswer() if graph is None else motion_answer(graph)
    for contact in (*answer.start, *(contact for pose in answer.poses for contact in pose.contacts)):
        first, second = sorted(link.removeprefix(f"{role.device}_") for link in (contact.first, contact.second))
        touching.setdefault((first, second), _TOUCHING)
    return Judged(touching, {**before.excused, **excused}, asked), checked
