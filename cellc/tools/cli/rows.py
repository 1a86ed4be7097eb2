"""The table of results of many cells: its rows, its findings, and the exit code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.diagnostics.unsafe_text import harmless_json
from cellc.contract.printing import show, show_document
from cellc.tools.cli.batch import CellResult
from cellc.tools.cli.findings import fails, number_hidden, show_findings
from cellc.tools.cli.fleet import FleetOptions, Task

if TYPE_CHECKING:
    from cellc.contract.fleet import FleetRow


def row_of(task: Task, result: CellResult, shown: Findings, fail_on: str, problem: str = "") -> FleetRow:
    """Return the row of one cell.

    Args:
        shown: the findings that were asked for.
        problem: what failed beyond findings.
    """
    # The models of the table load for as long as a small cell is checked.
    from cellc.contract.fleet import FleetRow
    from cellc.contract.review import ReviewFinding

    problem = problem or result.problem
    findings = (
        ReviewFinding(
            code=diagnostic.code,
            severity=diagnostic.severity.value,
            message=diagnostic.message,
            place=str(diagnostic.span),
        )
        for diagnostic in shown.diagnostics
    )
    return FleetRow(
        cell="" if result.cell is None else result.cell.name,
        source=task.file,
        versions={**({"ros": result.distro} if result.distro else {}), **task.versions},
        passed=not problem and not fails(shown, fail_on),
        problem=problem,
        findings=tuple(findings),
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
        from cellc.contract.fleet import Fleet

        document = Fleet(format=1, passed=passed, rows=tuple(rows))
        show_document(harmless_json(document.model_dump_json(indent=2)) + "\n")
    elif output_format == "text" and (len(rows) > 1 or fleet.moves or alone):
        from cellc.tools.report.fleet import fleet_lines

        show(*fleet_lines(rows))
    if not passed:
        raise click.exceptions.Exit(code)
