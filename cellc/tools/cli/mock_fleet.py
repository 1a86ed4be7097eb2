"""``cellc mock`` over many cells: one table of what is found, rehearsed and swept."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from cellc.compiler.output.write import write
from cellc.contract.compute.work import ComputeError
from cellc.contract.diagnostics import Severity
from cellc.contract.fleet import FleetRow
from cellc.contract.store.swap import temporary_folder
from cellc.mock.command.fleet import Member, Rehearsed, member_of, rehearse_all
from cellc.mock.command.options import MockOptions
from cellc.tools.cli.batch import CellResult, cell_files, results
from cellc.tools.cli.fleet import FleetOptions, folder_of
from cellc.tools.cli.rows import finish_rows, row_of


def rehearse_folders(folders: Sequence[str], fleet: FleetOptions, options: MockOptions) -> None:
    """Execute the rehearsals of generated folders, and leave with 1 where one does not pass."""
    members = [member_of(folder, Path(folder), edited=options.edited) for folder in folders]
    rows = [_row(member, ended, None) for member, ended in zip(members, _rehearsed(members, options), strict=True)]
    finish_rows(fleet, rows, code=1 if all(member.read for member in members) else 2, alone=True)


def rehearse_cells(paths: Sequence[str], fleet: FleetOptions, options: MockOptions) -> None:
    """Build cells with every tuple, execute their rehearsals, and leave nothing of it."""
    tasks = fleet.tasks(cell_files(paths))
    with temporary_folder("cellc-") as scratch:
        members, rows = list[Member](), list[FleetRow]()
        for number, (task, result) in enumerate(zip(tasks, results("compile", tasks, fleet.fan), strict=True)):
            rows.append(row_of(task, result, result.findings, Severity.ERROR.value))
            name = " ".join(filter(None, (task.file, folder_of(task.versions))))
            if result.artifacts is None:
                members.append(Member(name, None, _stopped(result)))
                continue
            folder = scratch / str(number)
            write(result.artifacts, folder)
            members.append(member_of(name, folder, edited=False, spec=Path(task.file).absolute().parent))
        ended = _rehearsed(members, options)
        rows = [_row(member, one, row) for member, one, row in zip(members, ended, rows, strict=True)]
    finish_rows(fleet, rows, alone=True)


def _rehearsed(members: Sequence[Member], options: MockOptions) -> Iterator[Rehearsed]:
    try:
        yield from rehearse_all(members, options)
    except ComputeError as problem:
        raise click.ClickException(str(problem)) from None


def _stopped(result: CellResult) -> str:
    """Say what stops a cell from being built: its first error."""
    errors = [diagnostic for diagnostic in result.findings.diagnostics if diagnostic.severity is Severity.ERROR]
    if result.problem or not errors:
        return result.problem
    more = f"; {len(errors) - 1} more" if len(errors) > 1 else ""
    return f"{errors[0].span}: {errors[0].message}{more}"


def _row(member: Member, ended: Rehearsed, built: FleetRow | None) -> FleetRow:
    """Return the row of a folder; that of its spec with more in it, where there is one."""
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
