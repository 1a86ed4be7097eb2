"""``cellc check``: read, link and check cells; nothing is written but what ``--fix`` corrects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.errors import reason_of
from cellc.contract.printing import Stream, progress, show
from cellc.tools.cli.batch import cell_files, results
from cellc.tools.cli.findings import FAIL_ON, FORMAT, IGNORE, SELECT, read_selection, selected, write_sarif
from cellc.tools.cli.fleet import FleetOptions, fleet_options
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.rows import finish_rows, row_of, show_checked

if TYPE_CHECKING:
    from cellc.tools.edit.rewrite import Edit

FIX = click.option(
    "--fix",
    is_flag=True,
    help="Correct the files where the fix is certain: misspelled keys and units, the modeline.",
)
# A corrected key can show a misspelled one below it; no spec is nested deeper.
_PASSES = 16


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@FIX
@SELECT
@IGNORE
@FORMAT
@FAIL_ON
@click.option(
    "--sarif", metavar="FILE", type=click.Path(path_type=Path), help="Also write the findings to FILE, as SARIF 2.1.0."
)
@click.option(
    "--against",
    metavar="REVISION",
    help="Annotate what fails and what this Git revision has not; for --format github.",
)
@fleet_options
@limit_option
def check(
    files: tuple[str, ...],
    fix: bool,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    output_format: str,
    fail_on: str,
    sarif: Path | None,
    against: str | None,
    fleet: FleetOptions,
) -> None:
    """Check each cell in FILES and report problems with file, line and fix.

    A folder means every cell.yaml below it. A device file or a robot description is checked by itself.

    \b
    cellc check cells/bench/cell.yaml          one cell
    cellc check .                              every cell of a repository
    cellc check my_robot                       a device: its folder or its file
    cellc check robot.urdf.xacro               a description alone
    cellc check . --format github              annotations of a pull request
    cellc check . --matrix ros=humble,jazzy    each cell with each distribution
    """
    if against is not None and output_format != "github":
        raise click.UsageError("--against needs --format github.")
    wanted = read_selection(select, ignore)
    files = cell_files(files)
    with progress("fixing") as update:
        for file in files if fix else ():
            update(file)
            fix_file(file)
    tasks = fleet.tasks(files)
    computed = list(results("check", tasks, fleet.fan))
    shown = [selected(result.findings, wanted) for result in computed]
    told = shown if against is None else [_new_or_failing(each, against, fail_on) for each in shown]
    show_checked(
        fleet, [(task, result.findings) for task, result in zip(tasks, computed, strict=True)], told, output_format
    )
    if sarif is not None:
        write_sarif(shown, sarif)
    rows = [
        row_of(task, result, findings, fail_on) for task, result, findings in zip(tasks, computed, shown, strict=True)
    ]
    finish_rows(fleet, rows, output_format)


def _new_or_failing(findings: Findings, revision: str, fail_on: str) -> Findings:
    """Return the findings that fail, and those that a file had not in a revision."""
    from cellc.tools.report.json_report import as_review_finding
    from cellc.tools.review.findings import new_among
    from cellc.tools.review.sides import SideError, findings_at

    try:
        before = findings_at(revision, findings.file)
    except SideError as problem:
        raise click.UsageError(str(problem)) from None
    new = new_among([as_review_finding(each) for each in findings.diagnostics], before)
    worst = Severity(fail_on).rank
    told = (each for number, each in enumerate(findings.diagnostics) if number in new or each.severity.rank <= worst)
    return replace(findings, diagnostics=tuple(told))


def fix_file(file: str) -> None:
    """Correct a spec and what it includes, and say on standard error what was done."""
    from cellc.compiler.catalog.read_model import is_device
    from cellc.compiler.pipeline import judge
    from cellc.compiler.source import read
    from cellc.tools.edit.fixes import missing_modeline, sure_edits

    for _ in range(_PASSES):
        document = read(file)
        if document.value is None or not document.ok:
            return
        diagnostics = judge(file).diagnostics
        edits: list[Edit] = [*sure_edits(diagnostics)]
        kind = "device" if is_device(document.value.data) else "cell"
        edits += missing_modeline(document.value.file, document.value.texts[document.value.file], kind)
        if not edits:
            return
        for name, group in groupby(sorted(edits, key=lambda one: (one.file, one.line)), key=lambda one: one.file):
            _rewrite(name, list(group), document.value.texts[name])


def _rewrite(file: str, edits: Sequence[Edit], text: str) -> None:
    from cellc.tools.edit.rewrite import rewrite

    try:
        done = rewrite(Path(file), edits, text)
    except OSError as error:
        raise click.UsageError(f"`{file}` cannot be written: {reason_of(error)}") from error
    for edit in edits if done else ():
        show(f"{edit.file}:{edit.line}: {edit.message}", to=Stream.ERR)
