"""Check or compile the specs of one call, by several processes where that pays."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import partial
from typing import Literal

import click

from cellc.artifact import Artifact
from cellc.description.packages import package_path, use_packages
from cellc.diagnostics.diagnostic import Findings
from cellc.limits import Limits, limits, use
from cellc.rules.shared_domain import Presence, presence_of, shared_domains

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
    below = ((path, files_below(path, SPEC_FILE) if os.path.isdir(path) else ()) for path in paths)
    return tuple(spec for path, specs in below for spec in specs or (path,))


def files_below(folder: str, *patterns: str) -> tuple[str, ...]:
    """Return the files below a folder with names of some patterns, in alphabetical order, as `cell_files` looks."""
    found: list[str] = []
    for place, folders, files in os.walk(folder):
        kept = (name for name in folders if not name.startswith("."))
        folders[:] = sorted(name for name in kept if not os.path.exists(os.path.join(place, name, "pyvenv.cfg")))
        named = (file for file in sorted(files) if any(fnmatchcase(file, one) for one in patterns))
        found += (os.path.normpath(os.path.join(place, file)) for file in named)
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


@dataclass(frozen=True, slots=True)
class _Asked:
    """What every process of a call is told."""

    kind: Kind
    limits: Limits
    packages: tuple[str, ...]


def _compute_within(asked: _Asked) -> Callable[[str], CellResult]:
    use(asked.limits)
    use_packages(asked.packages)
    return partial(compute, asked.kind)


def number_of_workers(kind: Kind, cells: int, cores: int | None = None) -> int:
    """Return how many processes pay for so many cells; 1 is this process.

    Args:
        cores: as many as the system lets this process use, if None.
    """
    paying = min(cells // _CELLS_THAT_PAY[kind], MOST_WORKERS)
    if paying <= 1:
        return 1
    # One cell needs no processes: loading what hires them takes a fiftieth of its check.
    from cellc.compute.processes import usable_cores

    return max(1, min(usable_cores() if cores is None else cores, paying))


def in_workers(kind: Kind, files: Sequence[str], number: int) -> Generator[CellResult, None, None]:
    """Yield results in the order of the specs, however many processes compute them; closing it ends them all.

    Raises:
        ClickException: a spec ends every process that computes it.
        Stopped: what had not begun was dropped, and no process is left.
    """
    from cellc.compute.processes import processes
    from cellc.compute.work import ComputeError, Work, in_order, stream

    work = Work(_compute_within, _Asked(kind, limits(), package_path()))
    try:
        with closing(stream(work, files, processes(number))) as computed:
            yield from in_order(computed)
    except ComputeError as problem:
        raise click.ClickException(str(problem)) from None
