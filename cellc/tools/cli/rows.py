"""The table of many cells: what is found in them, and how their rehearsals or sweeps ended."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.unsafe_text import harmless_json
from cellc.contract.fleet import Fleet, FleetRow
from cellc.contract.printing import show, show_document
from cellc.contract.store.swap import temporary_folder
from cellc.tools.cli.batch import CellResult, cell_files, results
from cellc.tools.cli.findings import fails, number_hidden, show_findings
from cellc.tools.cli.fleet import FleetOptions, Task
from cellc.tools.report.json_report import as_review_finding

if TYPE_CHECKING:
    from cellc.mock.command.fleet import Member


def row_of(task: Task, result: CellResult, shown: Findings, fail_on: str, problem: str = "") -> FleetRow:
    """Return the row of one cell.

    Args:
        shown: the findings that were asked for.
        problem: what failed beyond findings.
    """
    problem = problem or result.problem
    return FleetRow(
        cell="" if result.cell is None else result.cell.name,
        source=task.file,
        versions={**({"ros": result.distro} if result.distro else {}), **task.versions},
        passed=not problem and not fails(shown, fail_on),
        problem=problem,
        findings=tuple(map(as_review_finding, shown.diagnostics)),
    )


def show_checked(
    fleet: FleetOptions,
    found: Sequence[tuple[Task, Findings]],
    shown: Sequence[Findings],
    output_format: str,
    *,
    sum_blockers: bool = False,
) -> None:
    """Write the findings of all tasks, but where the table alone is asked for."""
    hidden = number_hidden([findings for _, findings in found], shown)
    if fleet.as_json:
        return
    if not fleet.moves or output_format != "text":
        show_findings(shown, output_format, hidden=hidden, sum_blockers=sum_blockers)
        return
    from cellc.tools.report.fleet import render_combined

    by_file: dict[str, list[tuple[str, Findings]]] = {}
    for (task, _), findings in zip(found, shown, strict=True):
        name = ", ".join(f"{part}={text}" for part, text in task.versions.items())
        by_file.setdefault(task.file, []).append((name, findings))
    for combined in by_file.values():
        show(*render_combined(combined, sum_blockers=sum_blockers))
    if hidden:
        show(f"{hidden} hidden by --select or --ignore")


def finish_rows(
    fleet: FleetOptions, rows: Sequence[FleetRow], output_format: str = "text", code: int = 1, *, alone: bool = False
) -> None:
    """Write the table where there are several rows, and leave with a code where one did not pass.

    Args:
        alone: the table is the only output, so that a single row is shown too.
    """
    passed = all(row.passed for row in rows)
    if fleet.as_json:
        document = Fleet(format=1, passed=passed, rows=tuple(rows))
        show_document(harmless_json(document.model_dump_json(indent=2)) + "\n")
    elif output_format == "text" and (len(rows) > 1 or fleet.moves or alone):
        from cellc.tools.report.fleet import fleet_lines

        show(*fleet_lines(rows))
    if not passed:
        raise click.exceptions.Exit(code)


def tell_executed(
    paths: Sequence[str],
    fleet: FleetOptions,
    execute: Callable[[Sequence[Member]], Iterator[FleetRow]],
    *,
    edited: bool,
) -> None:
    """Execute generated folders, or cells with every tuple where there are some; leave with 1 where one fails.

    Args:
        execute: yields the row of each folder with what became of it, in their order.
    """
    from cellc.contract.compute.work import ComputeError
    from cellc.mock.command.fleet import member_of

    with temporary_folder("cellc-") as scratch:
        if fleet.moves:
            members = list(_built(paths, fleet, scratch))
        else:
            rows = (FleetRow(cell="", source=folder, versions={}, passed=True) for folder in paths)
            members = [member_of(row, Path(row.source), edited=edited) for row in rows]
        try:
            ended = list(execute(members))
        except ComputeError as problem:
            raise click.ClickException(str(problem)) from None
    unreadable = not fleet.moves and any(member.read is None for member in members)
    finish_rows(fleet, ended, code=2 if unreadable else 1, alone=True)


def _built(paths: Sequence[str], fleet: FleetOptions, scratch: Path) -> Iterator[Member]:
    """Build cells with every tuple into a folder that is removed afterwards."""
    from cellc.compiler.output.write import write
    from cellc.mock.command.fleet import Member, member_of

    tasks = fleet.tasks(cell_files(paths))
    for number, (task, result) in enumerate(zip(tasks, results("compile", tasks, fleet.fan), strict=True)):
        row = row_of(task, result, result.findings, Severity.ERROR.value)
        if result.artifacts is None:
            yield Member(replace(row, passed=False, problem=row.problem or _first_error(result.findings)), None)
            continue
        folder = scratch / str(number)
        write(result.artifacts, folder)
        yield member_of(row, folder, edited=False, spec=Path(task.file).absolute().parent)


def _first_error(found: Findings) -> str:
    """Say what stops a cell from being built."""
    errors = [diagnostic for diagnostic in found.diagnostics if diagnostic.severity is Severity.ERROR]
    more = f"; {len(errors) - 1} more" if len(errors) > 1 else ""
    return f"{errors[0].span}: {errors[0].message}{more}" if errors else ""
