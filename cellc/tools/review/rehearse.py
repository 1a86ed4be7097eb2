"""How the rehearsals of two packages end on the mock, each package in a process of its own, as `cellc mock` runs it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TypeAlias

from cellc.compiler.artifact import Artifact
from cellc.compiler.output.write import write
from cellc.contract.limits import as_options, limits
from cellc.contract.printing import stage
from cellc.contract.review import ReviewRehearsal
from cellc.contract.store.swap import temporary_folder
from cellc.tools.review.sides import Package, SideError

_Ended: TypeAlias = "dict[str, tuple[str, bool]]"


def outcomes_of(before: Package, after: Package) -> tuple[ReviewRehearsal, ...]:
    """Return how each rehearsal of either package ended on both.

    Raises:
        SideError: a side has errors, or the mock cannot load its package.
    """
    for side in (before, after):
        if side.errors:
            raise SideError(f"{side.name}: a cell with errors is not rehearsed; see `cellc check`")
    stage("rehearsals of both")
    with temporary_folder("cellc-diff-") as folder:
        was, now = _run((before, after), folder)
    return tuple(_rehearsal(name, was, now) for name in dict.fromkeys((*was, *now)))


def _rehearsal(name: str, was: _Ended, now: _Ended) -> ReviewRehearsal:
    before, after = was.get(name), now.get(name)
    return ReviewRehearsal(
        name=name,
        before=None if before is None else before[0],
        after=None if after is None else after[0],
        passed_before=None if before is None else before[1],
        passed_after=None if after is None else after[1],
    )


def _run(packages: Sequence[Package], folder: Path) -> list[_Ended]:
    with ExitStack() as stack:
        running = []
        for number, package in enumerate(packages):
            place = folder / f"{number}" / package.facts.contract.cell
            write([Artifact(path, text) for path, text in package.files.items()], place)
            running.append(stack.enter_context(_started(place)))
            stack.callback(running[-1].kill)
        return [_ended(package, child) for package, child in zip(packages, running, strict=True)]


def _started(place: Path) -> subprocess.Popen[str]:
    # What was edited gets as a note; here no gate is signed by it.
    raised = [word for option in as_options(limits()) for word in ("--limit", option)]
    command = [sys.executable, "-m", "cellc", "mock", place.as_posix(), "--json", "--edited", *raised]
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        # `-m` puts the current folder first on the import path: it must not be one that untrusted files filled.
        cwd=Path(__file__).resolve().parents[3],
    )


def _ended(package: Package, child: subprocess.Popen[str]) -> _Ended:
    out, err = child.communicate()
    if child.returncode not in (0, 1) or not out:
        raise SideError(f"{package.name}: the mock refuses it: {err.strip().removeprefix('error: ') or 'no answer'}")
    return {load["name"]: (load["outcome"], load["passed"]) for load in json.loads(out)["rehearsals"]}
