"""Check or compile the specs of one call, by several processes where that pays."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal

from cellc.artifact import Artifact
from cellc.description.packages import on_package_path, package_path
from cellc.diagnostics.diagnostic import Findings
from cellc.limits import Limits, in_force, limits
from cellc.rules.shared_domain import Presence, presence_of, shared_domains
from cellc.signals import deaf_children, start_deaf_tracker

Kind = Literal["check", "compile"]

MOST_WORKERS = 8

# A process loads the compiler first, which takes as long as checking so many cells or compiling so many.
_CELLS_THAT_PAY: Mapping[Kind, int] = {"check": 16, "compile": 3}


@dataclass(frozen=True, slots=True)
class CellResult:
    """What a command needs of a spec that was checked, or compiled too; without the graph, so that it can be sent.

    Args:
        cell: as the other cells of the call see it; None where an error hides it.
        artifacts: with the manifest over them; None where an error stops them, or where the kind is "check".
    """

    findings: Findings
    cell: Presence | None = None
    artifacts: tuple[Artifact, ...] | None = None


def cell_files(paths: Sequence[str]) -> tuple[str, ...]:
    """Return the specs that are meant: a folder stands for every ``cell.yaml`` below it, in alphabetical order.

    Folders that begin with a dot and virtual environments are left out, and no link to a folder is followed. A folder
    without a spec stays what it is, so that it is told like any other file that is none.
    """
    return tuple(spec for path in paths for spec in (_specs_below(path) if os.path.isdir(path) else ()) or (path,))


def _specs_below(folder: str) -> tuple[str, ...]:
    found: list[str] = []
    for place, folders, files in os.walk(folder):
        kept = (name for name in folders if not name.startswith("."))
        folders[:] = sorted(name for name in kept if not os.path.exists(os.path.join(place, name, "pyvenv.cfg")))
        if SPEC_FILE in files:
            found.append(os.path.normpath(os.path.join(place, SPEC_FILE)))
    return tuple(found)


SPEC_FILE = "cell.yaml"
"""What a spec is called where a folder is named instead of it."""


def results(kind: Kind, files: Sequence[str]) -> Iterator[CellResult]:
    """Yield the result of each spec in the order of the call, with what the cells before it have against it.

    Args:
        files: specs as the user named them.
    """
    number = number_of_workers(kind, len(files))
    computed = in_workers(kind, files, number) if number > 1 else (compute(kind, file) for file in files)
    earlier: list[Presence] = []
    for result in computed:
        if result.cell is None:
            yield result
            continue
        against = tuple(shared_domains(result.cell, earlier))
        earlier.append(result.cell)
        # An error stops the artifacts.
        yield replace(result, findings=result.findings.with_more(against), artifacts=None) if against else result


def compute(kind: Kind, file: str) -> CellResult:
    """Check a spec, or check and compile it."""
    # A process that has others compute does not load the compiler.
    from cellc.pipeline import check, compile_cell

    checked = check(file)
    if checked.graph is None:
        return CellResult(checked.findings)
    if kind == "check":
        return CellResult(checked.findings, presence_of(checked.graph))
    compiled = compile_cell(checked)
    artifacts = compiled.value if compiled.ok else None
    return CellResult(checked.findings.with_more(compiled.diagnostics), presence_of(checked.graph), artifacts)


def _compute_within(chosen: Limits, packages: Sequence[str], kind: Kind, file: str) -> CellResult:
    with in_force(chosen), on_package_path(packages):
        return compute(kind, file)


def number_of_workers(kind: Kind, cells: int, cores: int | None = None) -> int:
    """Return how many processes pay for so many cells; 1 is this process.

    Args:
        cores: as many as the system lets this process use, if None.
    """
    available = usable_cores() if cores is None else cores
    return max(1, min(available, cells // _CELLS_THAT_PAY[kind], MOST_WORKERS))


def usable_cores() -> int:
    """Return the number of cores that the system lets this process use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


def in_workers(kind: Kind, files: Sequence[str], number: int) -> Generator[CellResult, None, None]:
    """Yield results in the order of the specs, however many processes compute them; closing it ends them all.

    Raises:
        Stopped: what had not begun was dropped, and no process is left.
    """
    # Python's machinery of processes takes longer to load than a small cell to check.
    from concurrent.futures.process import BrokenProcessPool, ProcessPoolExecutor
    from multiprocessing import get_context

    start_deaf_tracker()
    # Spawned on every platform: nothing of this process, its locks and threads above all, is copied into them.
    pool = ProcessPoolExecutor(number, get_context("spawn"))
    done = 0
    try:
        with deaf_children():
            computed = pool.map(partial(_compute_within, limits(), package_path(), kind), files)
        for result in computed:
            done += 1
            yield result
    except BrokenProcessPool:  # the system ended one, for want of memory say
        yield from (compute(kind, file) for file in files[done:])
    finally:
        pool.shutdown(cancel_futures=True)
