"""``cellc mock`` and ``cellc sweep`` over many folders or cells: one table of what is found, rehearsed or swept."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.tools.cli.fleet import FleetOptions, folder_of

if TYPE_CHECKING:
    from cellc.contract.fleet import FleetRow
    from cellc.mock.command.fleet import Member, Rehearsed
    from cellc.tools.cli.batch import CellResult

Execute = Callable[[Sequence["Member"]], Iterator["Rehearsed"]]
"""Yields what became of each folder, in their order."""


@dataclass(frozen=True, slots=True)
class Named:
    """What the arguments of a call name.

    Attributes:
        paths: generated folders; specs, or folders of them, where there is a matrix.
        table: whether a table of several is printed, and not the results of one folder.
    """

    paths: tuple[str, ...]
    table: bool


def named_by(arguments: tuple[str, ...], matrix: tuple[str, ...]) -> Named:
    """Return what is named; a pattern represents what it matches, and a folder of several all of them."""
    if matrix:
        return Named(arguments, table=True)
    if len(arguments) == 1 and os.path.exists(os.path.join(arguments[0], "contract.json")):
        return Named(arguments, table=False)  # what looks for others loads for longer than a folder is read
    from cellc.tools.cli.batch import matched, several_folders

    several = several_folders(arguments)
    return Named((next(matched(arguments)),), table=False) if several is None else Named(several, table=True)


def refuse_for_many(given: Mapping[str, bool]) -> None:
    """Raise UsageError for the first option that was given, each of which is about one folder."""
    for option, asked in given.items():
        if asked:
            raise click.UsageError(f"{option} is about one folder.")


def tell_table(paths: Sequence[str], fleet: FleetOptions, execute: Execute, *, edited: bool) -> None:
    """Execute generated folders, or cells with every tuple where there are some; leave with 1 where one fails."""
    if fleet.moves:
        _tell_cells(paths, fleet, execute)
        return
    from cellc.mock.command.fleet import member_of
    from cellc.tools.cli.rows import finish_rows

    members = [member_of(folder, Path(folder), edited=edited) for folder in paths]
    rows = [_row(member, ended, None) for member, ended in zip(members, _executed(members, execute), strict=True)]
    finish_rows(fleet, rows, code=1 if all(member.read for member in members) else 2, alone=True)


def _tell_cells(paths: Sequence[str], fleet: FleetOptions, execute: Execute) -> None:
    """Build cells with every tuple, execute them, and leave nothing of it."""
    from cellc.compiler.output.write import write
    from cellc.contract.diagnostics import Severity
    from cellc.contract.store.swap import temporary_folder
    from cellc.mock.command.fleet import Member, member_of
    from cellc.tools.cli.batch import cell_files, results
    from cellc.tools.cli.rows import finish_rows, row_of

    tasks = fleet.tasks(cell_files(paths))
    with temporary_folder("cellc-") as scratch:
        members, rows = list[Member](), list["FleetRow"]()
        for number, (task, result) in enumerate(zip(tasks, results("compile", tasks, fleet.fan), strict=True)):
            rows.append(row_of(task, result, result.findings, Severity.ERROR.value))
            name = " ".join(filter(None, (task.file, folder_of(task.versions))))
            if result.artifacts is None:
                members.append(Member(name, None, _stopped(result)))
                continue
            folder = scratch / str(number)
            write(result.artifacts, folder)
            members.append(member_of(name, folder, edited=False, spec=Path(task.file).absolute().parent))
        ended = _executed(members, execute)
        rows = [_row(member, rehearsed, row) for member, rehearsed, row in zip(members, ended, rows, strict=True)]
    finish_rows(fleet, rows, alone=True)


def _executed(members: Sequence[Member], execute: Execute) -> Iterator[Rehearsed]:
    from cellc.contract.compute.work import ComputeError

    try:
        yield from execute(members)
    except ComputeError as problem:
        raise click.ClickException(str(problem)) from None


def _stopped(result: CellResult) -> str:
    """Say what stops a cell from being built: its first error."""
    from cellc.contract.diagnostics import Severity

    errors = [diagnostic for diagnostic in result.findings.diagnostics if diagnostic.severity is Severity.ERROR]
    if result.problem or not errors:
        return result.problem
    more = f"; {len(errors) - 1} more" if len(errors) > 1 else ""
    return f"{errors[0].span}: {errors[0].message}{more}"


def _row(member: Member, ended: Rehearsed, built: FleetRow | None) -> FleetRow:
    """Return the row of a folder; that of its spec with more in it, where there is one."""
    from cellc.contract.fleet import FleetRow

    contract = None if member.read is None else member.read.contract
    if built is None:
        versions = {} if contract is None else {"ros": contract.distro.value}
        built = FleetRow(
            cell="" if contract is None else contract.cell, source=member.name, versions=versions, passed=True
        )
    update = {
        "passed": built.passed and ended.passed,
        "problem": built.problem or ended.problem,
        "rehearsals": None if contract is None else ended.rehearsals,
        "sweeps": ended.sweeps,
    }
    return built.model_copy(update=update)
