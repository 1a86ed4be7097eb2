"""``cellc build``: check cells and write their artifacts, or tell how a folder differs from what they would be."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import click

from cellc.compiler.artifact import Artifact
from cellc.compiler.output.compare import Difference, compare
from cellc.compiler.output.findings import shared_output
from cellc.compiler.output.plan import check_places
from cellc.compiler.output.write import WriteReport, write
from cellc.contract.diagnostics import Span
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.printing import Line, show
from cellc.tools.cli.batch import CellResult, cell_files, results
from cellc.tools.cli.findings import FAIL_ON, FORMAT, IGNORE, SELECT, read_selection, selected_and_errors
from cellc.tools.cli.fleet import FleetOptions, Task, fleet_options, folder_of
from cellc.tools.cli.limit_option import limit_option
from cellc.tools.cli.rows import finish_rows, row_of, show_checked
from cellc.tools.report.text_report import render_difference

OUTPUT = click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path("generated"),
    show_default=True,
    help="Parent folder of the folders of the cells.",
)


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@OUTPUT
@click.option("--check", "only_compare", is_flag=True, help="Write nothing; fail if a folder is not up to date.")
@click.option("--full", is_flag=True, help="Also compile unchanged cells instead of using the cache, as CI does.")
@click.option("--force", is_flag=True, help="Discard manual edits of generated files.")
@SELECT
@IGNORE
@FORMAT
@FAIL_ON
@fleet_options
@limit_option
def build(
    files: tuple[str, ...],
    output: Path,
    only_compare: bool,
    full: bool,
    force: bool,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    output_format: str,
    fail_on: str,
    fleet: FleetOptions,
) -> None:
    """Check each cell in FILES and write its ROS 2 package to OUTPUT/<cell>.

    A folder means every cell.yaml below it. With --matrix each version tuple has its own folder in OUTPUT.

    A cell with errors is not written. Blockers refuse the real target only; they are summed up here, and `cellc check`
    lists them. Your own files beside the generated ones are kept. No option hides an error.

    \b
    cellc build cells/bench/cell.yaml          writes generated/bench
    cellc build --check .                      fails where one is not up to date
    cellc build . --matrix ros=humble,jazzy    in generated/ros-humble, and so on
    """
    wanted = read_selection(select, ignore)
    files = cell_files(files)
    tasks, done = fleet.tasks(files), list[Built]()
    places: dict[tuple[str, str], Span] = {}
    for task, result in zip(tasks, results("compile", tasks, fleet.fan, full=full), strict=True):
        folder = folder_of(task.versions)
        done.append(built(task, unless_shared(result, folder, places), output / folder, only_compare, force))
    shown = [selected_and_errors(item.result.findings, wanted) for item in done]
    by_task = [(task, outcome.result.findings) for task, outcome in zip(tasks, done, strict=True)]
    show_checked(fleet, by_task, shown, output_format, sum_blockers=True)
    messages = [line for item in done for line in item.messages]
    if output_format == "text" and messages and not fleet.as_json:
        show(*messages)
    rows = [
        row_of(task, outcome.result, findings, fail_on, outcome.problem)
        for task, outcome, findings in zip(tasks, done, shown, strict=True)
    ]
    finish_rows(fleet, rows, output_format)


@dataclass(frozen=True, slots=True)
class Built:
    """What became of a cell, without its artifacts.

    Attributes:
        problem: that its folder is not what it makes.
        wrote: whether a file of the folder was written or removed.
    """

    result: CellResult
    messages: tuple[Line, ...] = ()
    problem: str = ""
    wrote: bool = False


def built(task: Task, result: CellResult, output: Path, only_compare: bool, force: bool) -> Built:
    """Write what a cell makes below a folder, or compare it with what is there.

    Args:
        output: the parent folder, that of the versions of the task included.
    """
    if result.artifacts is None or result.cell is None:
        return Built(result)
    folder = output / result.cell.name
    if only_compare:
        if in_the_way := tuple(check_places(result.artifacts, folder)):  # nothing is shown of what a link leads to
            return Built(replace(result, findings=result.findings.with_more(in_the_way), artifacts=None))
        differences = compare(result.artifacts, folder)
        command = build_command(task.file, output)
        problem = f"`{folder.as_posix()}` is out of date; run `{command}`" if differences else ""
        return Built(replace(result, artifacts=None), tuple(_differences(differences, folder, command)), problem)
    findings, report = written(result.findings, result.artifacts, folder, force)
    messages = () if report is None else (summary_of(report, folder),)
    wrote = report is not None and bool(report.written or report.removed)
    return Built(replace(result, findings=findings, artifacts=None), messages, wrote=wrote)


def unless_shared(result: CellResult, folder: str, places: dict[tuple[str, str], Span]) -> CellResult:
    """Take the artifacts from a cell whose folder is made already; ``places`` holds where the cells are named."""
    if result.cell is None:
        return result
    here = result.cell.named_at
    shared = shared_output(result.cell.name, here, places.setdefault((folder, result.cell.name), here))
    if shared is None:
        return result
    return replace(result, findings=result.findings.with_more((shared,)), artifacts=None)


def written(
    findings: Findings, artifacts: tuple[Artifact, ...], folder: Path, force: bool
) -> tuple[Findings, WriteReport | None]:
    """Write what a cell makes; return its findings with those of writing, and what was written where anything was."""
    outcome = write(artifacts, folder, force=force)
    return findings.with_more(outcome.diagnostics), outcome.value


def build_command(file: str, output: Path) -> str:
    """Return the command that makes the folder of a cell again."""
    return f"cellc build {file}" if output == Path("generated") else f"cellc build {file} -o {output.as_posix()}"


def summary_of(report: WriteReport, folder: Path) -> str:
    """Say how many files of a folder were written, removed and left."""
    parts = [(len(report.written), "written"), (len(report.removed), "removed"), (len(report.unchanged), "unchanged")]
    shown = ", ".join(f"{number} {word}" for number, word in parts if number)
    return f"{folder.as_posix()}: {shown}"


def _differences(differences: tuple[Difference, ...], folder: Path, command: str) -> list[Line]:
    if not differences:
        return [f"{folder.as_posix()}: up to date"]
    if not folder.is_dir():
        return [f"{folder.as_posix()}: no such folder; run `{command}`"]
    return [line for difference in differences for line in render_difference(difference, folder)]
