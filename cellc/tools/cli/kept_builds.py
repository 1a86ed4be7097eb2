"""What a cell made before, kept with the digest of all that it rests on: a build of what is unchanged hashes and ends.

An entry lies in the user's cache, signed: a digest in a committed file could be forged by the author of a change,
and would change with each commit to cellc. It holds for the same files, the same compiler and the same limits.
"""

from __future__ import annotations

import hashlib
import json
import os
import sys
from collections.abc import Iterable, Iterator
from dataclasses import asdict, astuple, dataclass
from functools import cache
from pathlib import Path
from typing import Any

from cellc.compiler.artifact import Artifact
from cellc.compiler.rules.shared_domain import Presence
from cellc.contract.diagnostics import Diagnostic, Fix, Related, Severity, Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.limits import limits
from cellc.contract.store.cache import passing_answers, read_entry, write_entry
from cellc.contract.store.regular_file import open_regular
from cellc.robot.description.packages import package_path
from cellc.tools.cli.batch import CellResult
from cellc.tools.cli.fleet import Task

_MOST_FILES = 5_000
_MOST_BYTES = 200_000_000
_SETTLED_NS = 50_000_000
"""A file that was changed so shortly before a build may have been changed in it: clocks of file systems are coarse."""
_MARKS = (".git", "package.xml")
"""What in a folder above a spec decides where a repository or a package starts."""


@dataclass(frozen=True, slots=True)
class _Inputs:
    """What a build rests on: whole folders, and single files, there or not; all paths are absolute."""

    folders: tuple[str, ...]
    files: tuple[str, ...]


class _NotKeptError(Exception):
    """Something is in the inputs that is not hashed: a link, or too much."""


def recall_build(task: Task) -> CellResult | None:
    """Return what a build of the same files gave, or None."""
    name = _entry_name(task)
    content = None if name is None else read_entry(name, Path(task.file))
    if content is None:
        return None
    try:
        data = json.loads(content)
        if data["digest"] == _digest(_Inputs(tuple(data["folders"]), tuple(data["files"])), task):
            return _result(data["result"])
    except (OSError, ValueError, KeyError, TypeError, _NotKeptError):
        pass
    return None


def keep_build(task: Task, result: CellResult, packages: tuple[str, ...], started_ns: int, passing: int) -> None:
    """Keep what a build gave, where it is what the same files give for ever.

    Args:
        packages: folders of packages that the cell names.
        started_ns: when the build started, ns since 1970.
        passing: answers that rest on what the machine had left, before the build started.
    """
    name = _entry_name(task)
    if name is None or not result.findings.ok or result.artifacts is None or passing != passing_answers():
        return
    try:
        inputs = _inputs_of(task.file, packages)
        digest = _digest(inputs, task, started_ns - _SETTLED_NS)
    except (OSError, _NotKeptError):
        return
    content = {**asdict(inputs), "digest": digest, "result": _as_data(result)}
    write_entry(name, json.dumps(content).encode(), Path(task.file))


def _entry_name(task: Task) -> str | None:
    if task.versions or package_path():
        return None
    asked = (task.file, os.path.abspath(task.file), os.getcwd(), repr(limits()), *_compiler())
    return f"build/{hashlib.sha256(chr(0).join(asked).encode('utf-8', 'surrogateescape')).hexdigest()}.json"


@cache
def _compiler() -> tuple[str, ...]:
    """Return what tells this compiler from others: its files as Python tells sources apart, and its libraries."""
    root = Path(__file__).resolve().parents[2]
    files = (
        f"{entry.path}\0{state.st_size}\0{state.st_mtime_ns}\0{state.st_ino}"
        for entry in _below(str(root), ("__pycache__",))
        if entry.is_file() and (state := entry.stat())
    )
    places = (place for place in sys.path if os.path.isdir(place))
    libraries = (name for place in places for name in sorted(os.listdir(place)) if name.endswith(".dist-info"))
    return (sys.version, *files, *libraries)


def _inputs_of(file: str, packages: Iterable[str]) -> _Inputs:
    from cellc.compiler.link.reads import is_below, reads_of

    reads = reads_of(file, packages)
    outside = [name for name in sorted(reads.files) if not is_below(name, reads.around)]
    if any(os.path.isdir(name) for name in outside if name not in reads.around):
        raise _NotKeptError
    return _Inputs(tuple(sorted(reads.around)), tuple(outside))


def _digest(inputs: _Inputs, task: Task, before_ns: int | None = None) -> str:
    """Return the digest of everything in the inputs.

    Args:
        before_ns: when the last change of them was over, if that counts.

    Raises:
        _NotKeptError: they hold a link, too much, or what was changed since.
        OSError: a file cannot be read.
    """
    digest, read, number = hashlib.sha256(), 0, 0
    for above in Path(os.path.abspath(task.file)).parents:
        digest.update(repr([os.path.exists(above / mark) for mark in _MARKS]).encode())
    for path in (*inputs.files, *(path for folder in inputs.folders for path in _paths(folder))):
        there = os.path.lexists(path)
        state = os.lstat(path) if there else None
        number += 1
        digest.update(f"{path}\0{'' if state is None else state.st_mode}\0".encode("utf-8", "surrogateescape"))
        if state is None or (os.path.isdir(path) and not os.path.islink(path)):
            _refuse_late(state, before_ns)
            continue
        read += state.st_size
        if os.path.islink(path) or number > _MOST_FILES or read > _MOST_BYTES:
            raise _NotKeptError
        _refuse_late(state, before_ns)
        with open_regular(Path(path), follow=False) as stream:
            digest.update(hashlib.sha256(stream.read(_MOST_BYTES)).digest())
    return digest.hexdigest()


def _refuse_late(state: os.stat_result | None, before_ns: int | None) -> None:
    if state is not None and before_ns is not None and state.st_ctime_ns >= before_ns:
        raise _NotKeptError


def _paths(folder: str) -> Iterator[str]:
    yield folder
    yield from (entry.path for entry in _below(folder, (".git",)))


def _below(folder: str, but: tuple[str, ...]) -> Iterator[os.DirEntry[str]]:
    """Yield what lies below a folder in an order that is always the same; no link is followed."""
    with os.scandir(folder) as inside:
        entries = sorted((entry for entry in inside if entry.name not in but), key=lambda entry: entry.name)
    for entry in entries:
        yield entry
        if entry.is_dir(follow_symlinks=False):
            yield from _below(entry.path, but)


def _as_data(result: CellResult) -> dict[str, Any]:
    findings, cell = result.findings, result.cell
    return {
        "file": findings.file,
        "texts": dict(findings.texts),
        "diagnostics": [astuple(each) for each in findings.diagnostics],
        "cell": None if cell is None else {**asdict(cell), "servers": sorted(cell.servers)},
        "artifacts": [astuple(each) for each in result.artifacts or ()],
        "distro": result.distro,
    }


def _result(data: dict[str, Any]) -> CellResult:
    cell = data["cell"]
    return CellResult(
        Findings(data["file"], data["texts"], tuple(map(_diagnostic, data["diagnostics"]))),
        None if cell is None else _presence(cell),
        tuple(Artifact(*each) for each in data["artifacts"]),
        data["distro"],
    )


def _diagnostic(data: list[Any]) -> Diagnostic:
    code, severity, message, span, path, advice, related, fix = data
    places = tuple(Related(text, Span(*place)) for text, place in related)
    edit = None if fix is None else Fix(Span(*fix[0]), *fix[1:])
    return Diagnostic(code, Severity(severity), message, Span(*span), tuple(path), advice, places, edit)


def _presence(data: dict[str, Any]) -> Presence:
    spans = {name: Span(**data[name]) for name in ("named_at", "domain_at")}
    lists = {name: tuple(data[name]) for name in ("cards", "peers")}
    return Presence(**{**data, **spans, **lists, "servers": frozenset(data["servers"])})
