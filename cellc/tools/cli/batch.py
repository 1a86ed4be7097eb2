"""Check or compile the specs of one call, by several processes where that pays."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from functools import partial
from glob import glob
from pathlib import Path
from time import monotonic, process_time, time_ns
from typing import TYPE_CHECKING, Literal

import click

from cellc.compiler.artifact import Artifact
from cellc.compiler.catalog.compiled import DEVICE_FILE
from cellc.compiler.rules.shared_domain import Presence, shared_domains
from cellc.contract.compute.fan import USUAL, Fan
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.wording import time_left
from cellc.contract.file_names import SPEC_FILE
from cellc.contract.limits import Limits, children_seconds, limits, use
from cellc.contract.printing import progress, remark
from cellc.contract.signals import within
from cellc.contract.store.cache import passing_answers
from cellc.contract.store.regular_file import open_regular
from cellc.robot.description.packages import package_path, use_packages
from cellc.tools.cli.fleet import Task

if TYPE_CHECKING:
    from cellc.contract.compute.work import ExecutorFactory

Kind = Literal["check", "compile"]

_READ_BYTES = 1 << 20

MOST_WORKERS = 8

# A process loads the compiler first, which takes as long as checking so many cells or compiling so many.
_CELLS_THAT_PAY: Mapping[Kind, int] = {"check": 16, "compile": 3}


@dataclass(frozen=True, slots=True)
class CellResult:
    """What a command needs of a spec that was checked, or compiled too; without the graph, so that it can be sent.

    Args:
        cell: as the other cells of the call see it; None where an error hides it.
        artifacts: with the manifest over them; None where an error stops them, or where the kind is "check".
        distro: that the cell is for; empty where an error hides it.
        seconds: processor time that it took, with the children that read descriptions.
        problem: why the spec cannot be taken with the versions of its task; empty where it can.
    """

    findings: Findings
    cell: Presence | None = None
    artifacts: tuple[Artifact, ...] | None = None
    distro: str = ""
    problem: str = ""
    seconds: float = field(default=0.0, compare=False)


def cell_files(paths: Sequence[str]) -> tuple[str, ...]:
    """Return the specs that are meant: a folder means every ``cell.yaml`` below it, in alphabetical order.

    A pattern such as ``cells/*/cell.yaml`` is expanded where the shell has not done so. Folders that begin with a dot
    and virtual environments are left out, and links to folders are not followed. A device folder without a spec means
    its ``device.yaml``. Any other folder is kept as it is, and reported like any file that is not a spec.
    """
    below = ((path, files_below(path, SPEC_FILE) if os.path.isdir(path) else ()) for path in matched(paths))
    return tuple(dict.fromkeys(spec for path, specs in below for spec in specs or (_device_in(path),)))


def _device_in(path: str) -> str:
    file = os.path.join(path, DEVICE_FILE)
    return file if os.path.isfile(file) else path


def several_folders(paths: Sequence[str]) -> tuple[str, ...] | None:
    """Return the generated folders that are meant where they are several, or lie below what is named; else None."""
    named = tuple(matched(paths))
    below = {path: files_below(path, "contract.json") for path in named if os.path.isdir(path)}
    inside = {path: tuple(map(os.path.dirname, files)) for path, files in below.items()}
    specs = tuple(dict.fromkeys(text for path in named for text in inside.get(path) or (path,)))
    return (
        None
        if len(specs) == 1 and len(named) == 1 and os.path.normpath(specs[0]) == os.path.normpath(named[0])
        else specs
    )


def matched(paths: Iterable[str]) -> Iterator[str]:
    """Yield paths, and in place of a pattern what it matches; one that matches nothing is a path that is not there."""
    for path in paths:
        yield from () if os.path.lexists(path) else sorted(glob(path, recursive=True))
        yield from (path,) if os.path.lexists(path) or not glob(path, recursive=True) else ()


def files_below(folder: str, *patterns: str) -> tuple[str, ...]:
    """Return the files below a folder with names of some patterns, in alphabetical order, as `cell_files` looks."""
    paths: list[str] = []
    for place, folders, files in os.walk(folder):
        visible = (name for name in folders if not name.startswith("."))
        folders[:] = sorted(name for name in visible if not os.path.exists(os.path.join(place, name, "pyvenv.cfg")))
        named = (file for file in sorted(files) if any(fnmatchcase(file, pattern) for pattern in patterns))
        paths += (os.path.normpath(os.path.join(place, file)) for file in named)
    return tuple(paths)


State = tuple[int, int, int]
"""When a file was changed in ns, its size and its inode."""


def states(places: Iterable[str], output: Path | None = None) -> dict[str, State]:
    """Return the state of every file below folders, but of what is hidden, generated, or a virtual environment."""
    states: dict[str, State] = {}
    left = list(places)
    generated = None if output is None else os.path.abspath(output)
    while left:
        try:
            entries = list(os.scandir(left.pop()))
        except OSError:
            continue  # removed meanwhile, or not readable
        if {"pyvenv.cfg", "manifest.json"} & {entry.name for entry in entries}:
            continue
        for entry in entries:
            if entry.name.startswith("."):
                continue
            if entry.is_dir(follow_symlinks=False):
                left += [] if entry.path == generated else [entry.path]
                continue
            try:
                state = entry.stat()
            except OSError:
                continue
            states[entry.path] = (state.st_mtime_ns, state.st_size, state.st_ino)
    return states


def results(kind: Kind, tasks: Sequence[Task], fan: Fan = USUAL, *, full: bool = False) -> Iterator[CellResult]:
    """Yield the result of each task in the order of the call, with what the cells before it have against it.

    Cells of different versions never run beside each other.

    Args:
        full: compute what the same files gave before, too.
    """
    # The workers of a cluster are asked even where this computer has the answer.
    known = {} if full or kind == "check" or fan.cluster is not None else _recalled(tasks)
    left = [task for number, task in enumerate(tasks) if number not in known]
    factory = fan.factory(number_of_workers(kind, len(left)), remark)
    shared = os.getcwd() if fan.cluster is not None else ""
    alone = (compute(kind, task) for task in left)
    computed = alone if factory is None else in_workers(kind, left, factory, shared)
    earlier: dict[str, list[Presence]] = {}
    label = {"check": "checking", "compile": "building"}[kind]
    start, spent_s = monotonic(), 0.0
    with progress(label) as update:
        for number, task in enumerate(tasks):
            update(f"{number + 1} of {len(tasks)}, {task.file}{time_left(number, len(tasks), monotonic() - start)}")
            if spent_s > limits().command_seconds:
                from cellc.compiler.pipeline import out_of_time

                computed.close()
                yield CellResult(out_of_time(task.file, alone=False))
                continue
            result = known[number] if number in known else next(computed)
            spent_s += result.seconds
            if result.cell is None:
                yield result
                continue
            beside = earlier.setdefault(repr(task.versions), [])
            against = tuple(shared_domains(result.cell, beside))
            beside.append(result.cell)
            # An error stops the artifacts.
            yield replace(result, findings=result.findings.with_more(against), artifacts=None) if against else result


def _recalled(tasks: Sequence[Task]) -> dict[int, CellResult]:
    """Return what tasks gave before that are not to be computed, by their number."""
    from cellc.tools.cli.kept_builds import recall_build

    recalled = ((number, recall_build(task)) for number, task in enumerate(tasks))
    return {number: result for number, result in recalled if result is not None}


def compute(kind: Kind, task: Task) -> CellResult:
    """Check a spec, or check and compile it, and tell how long that took."""
    start = _processor_seconds()
    result = within(limits().command_seconds, partial(_computed, kind, task))
    if result is None:
        from cellc.compiler.pipeline import out_of_time

        result = CellResult(out_of_time(task.file, alone=True))
    return replace(result, seconds=_processor_seconds() - start)


def _processor_seconds() -> float:
    return process_time() + children_seconds()


def _computed(kind: Kind, task: Task) -> CellResult:
    # A process that has others compute does not load the compiler.
    from cellc.compiler.pipeline import check_buildable, compile_cell, judge

    started_ns, passing = time_ns(), passing_answers()
    if task.versions:
        from cellc.tools.review.moved_spec import UpgradeError, check_with

        try:
            checked = check_with(task.file, task.versions)
        except UpgradeError as problem:
            return CellResult(Findings(task.file, {}, ()), problem=str(problem))
    else:
        checked = judge(task.file) if kind == "check" else check_buildable(task.file)
    if checked.presence is None:
        return CellResult(checked.findings)
    result = CellResult(checked.findings, checked.presence, distro=checked.distro)
    if kind == "check":
        return result
    compiled = compile_cell(checked)
    artifacts = compiled.value if compiled.ok else None
    complete = replace(result, findings=checked.findings.with_more(compiled.diagnostics), artifacts=artifacts)
    if artifacts is not None and checked.graph is not None:  # a plant is as new as all of its cells: it is built again
        from cellc.tools.cli.kept_builds import keep_build

        keep_build(task, complete, checked.graph.cell.packages, started_ns, passing)
    return complete


@dataclass(frozen=True, slots=True)
class _Asked:
    """What every process of a call gets.

    Attributes:
        folder: where specs are named from, for workers of other computers; empty where that is the current one.
    """

    kind: Kind
    limits: Limits
    packages: tuple[str, ...]
    folder: str = ""


@dataclass(frozen=True, slots=True)
class _Unit:
    """A task, with a digest of the files of its cell where a worker may have others; empty where it cannot."""

    task: Task
    digest: str = ""


def _compute_within(asked: _Asked) -> Callable[[_Unit], CellResult]:
    use(asked.limits)
    use_packages(asked.packages)
    return partial(_on_shared_disk, asked) if asked.folder else lambda unit: compute(asked.kind, unit.task)


def _on_shared_disk(asked: _Asked, unit: _Unit) -> CellResult:
    """Compute a task where the caller has its cell; a compiler reads devices and meshes beside a spec, and more."""
    from cellc.contract.compute.work import ComputeError

    before = os.getcwd()
    try:
        os.chdir(asked.folder)
        if unit.digest == digest_of(unit.task.file):
            return compute(asked.kind, unit.task)
    except OSError:
        pass  # there is no such folder
    finally:
        os.chdir(before)
    reason = "check and build need a disk that its workers share"
    raise ComputeError(f"a worker does not have `{unit.task.file}` in `{asked.folder}` as it is here; {reason}")


def digest_of(spec: str) -> str:
    """Return a digest of every file below the folder of a spec, but of what is generated; of large ones the size."""
    folder, digest = os.path.dirname(spec) or ".", hashlib.sha256()
    for file, (_, size, _) in sorted(states((folder,)).items()):
        digest.update(f"{os.path.relpath(file, folder)}\0{size}\0".encode("utf-8", "surrogateescape"))
        if size <= _READ_BYTES:
            with open_regular(Path(file)) as stream:
                digest.update(stream.read())
    return digest.hexdigest()


def number_of_workers(kind: Kind, cells: int, cores: int | None = None) -> int:
    """Return how many processes pay for so many cells; 1 is this process.

    Args:
        cores: as many as the system lets this process use, if None.
    """
    paying = min(cells // _CELLS_THAT_PAY[kind], MOST_WORKERS)
    if paying <= 1:
        return 1
    # One cell needs no processes: loading their factory takes a fiftieth of its check.
    from cellc.contract.compute.processes import usable_cores

    return max(1, min(usable_cores() if cores is None else cores, paying))


def in_workers(
    kind: Kind, tasks: Sequence[Task], factory: ExecutorFactory, shared: str = ""
) -> Generator[CellResult, None, None]:
    """Yield results in the order of the tasks, from this process or from workers; closing the generator ends them all.

    Args:
        shared: folder that workers of other computers find the specs from; empty for processes of this one.

    Raises:
        ClickException: a spec ends every process that computes it, or no worker is within reach.
        Stopped: what had not started was dropped, and no process is left.
    """
    from cellc.contract.compute.work import ComputeError, Work, in_order, stream

    work = Work(_compute_within, _Asked(kind, limits(), package_path(), shared), lambda unit: unit.task.file)
    units = [_Unit(task, digest_of(task.file) if shared else "") for task in tasks]
    try:
        with closing(stream(work, units, factory)) as computed:
            yield from in_order(computed)
    except ComputeError as problem:
        raise click.ClickException(str(problem)) from None
