"""``cellc build``: check cells and write their artifacts, or tell how a folder differs from what they would be."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from cellc.artifact import Artifact
from cellc.cli.batch import CellResult, cell_files, results
from cellc.cli.findings import (
    FAIL_ON,
    FORMAT,
    IGNORE,
    SELECT,
    finish,
    number_hidden,
    read_selection,
    selected_and_errors,
    show_findings,
)
from cellc.cli.limit_option import limit_option
from cellc.diagnostics import Span
from cellc.diagnostics.diagnostic import Findings
from cellc.output.codes import shared_output
from cellc.output.compare import Difference, compare
from cellc.output.write import WriteReport, write
from cellc.printing import Line, progress, show
from cellc.report.text_report import render_difference


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(path_type=str))
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path("generated"),
    show_default=True,
    help="Folder that holds a folder for each cell.",
)
@click.option(
    "--check", "only_compare", is_flag=True, help="Write nothing; fail where a folder is not what its cell makes."
)
@click.option("--force", is_flag=True, help="Discard edits that were made by hand in generated files.")
@SELECT
@IGNORE
@FORMAT
@FAIL_ON
@limit_option
def build(
    files: tuple[str, ...],
    output: Path,
    only_compare: bool,
    force: bool,
    select: tuple[str, ...],
    ignore: tuple[str, ...],
    output_format: str,
    fail_on: str,
) -> None:
    """Check each cell in FILES and write its ROS 2 package to OUTPUT/<cell>.

    A folder stands for every cell.yaml below it.

    Errors stop a cell from being written. Blockers do not: they refuse the real target, not the mock, and are summed
    here; `cellc check` shows each. Files that you put beside the generated ones stay. No option hides an error.

    \b
    cellc build cells/bench/cell.yaml          writes generated/bench
    cellc build --check .                      fails where one is not up to date
    """
    wanted = read_selection(select, ignore)
    files = cell_files(files)
    built: list[Findings] = []
    places: dict[str, Span] = {}
    told: list[Line] = []
    differs = False
    with progress("building") as update:
        computed = results("compile", files)
        for file in files:
            update(file)
            result = _unless_shared(next(computed), places)
            findings = result.findings
            if result.artifacts is not None and result.cell is not None:
                folder = output / result.cell.name
                if only_compare:
                    differences = compare(result.artifacts, folder)
                    differs = differs or bool(differences)
                    told += _differences(differences, folder)
                else:
                    findings, report = written(findings, result.artifacts, folder, force)
                    told += [] if report is None else [told_of(report, folder)]
            built.append(findings)
    shown = [selected_and_errors(one, wanted) for one in built]
    show_findings(shown, output_format, hidden=number_hidden(built, shown), sum_blockers=True)
    if output_format == "text" and told:
        show(*told)
    if differs:
        raise click.exceptions.Exit(1)
    finish(shown, fail_on)


def _unless_shared(result: CellResult, places: dict[str, Span]) -> CellResult:
    """Take the artifacts from a cell whose folder is made already; ``places`` holds where the cells are named."""
    if result.cell is None:
        return result
    here = result.cell.named_at
    shared = shared_output(result.cell.name, here, places.setdefault(result.cell.name, here))
    if shared is None:
        return result
    return replace(result, findings=result.findings.with_more((shared,)), artifacts=None)


def written(
    findings: Findings, artifacts: tuple[Artifact, ...], folder: Path, force: bool
) -> tuple[Findings, WriteReport | None]:
    """Write what a cell makes; return its findings with those of writing, and what was written where anything was."""
    outcome = write(artifacts, folder, force=force)
    return findings.with_more(outcome.diagnostics), outcome.value


def told_of(report: WriteReport, folder: Path) -> str:
    """Say how many files of a folder were written, removed and left."""
    parts = [(len(report.written), "written"), (len(report.removed), "removed"), (len(report.unchanged), "unchanged")]
    shown = ", ".join(f"{number} {word}" for number, word in parts if number)
    return f"{folder.as_posix()}: {shown}"


def _differences(differences: tuple[Difference, ...], folder: Path) -> list[Line]:
    if not differences:
        return [f"{folder.as_posix()}: as the cell makes it"]
    if not folder.is_dir():
        return [f"{folder.as_posix()}: there is no such folder; `cellc build` without `--check` writes it"]
    return [line for difference in differences for line in render_difference(difference, folder)]
