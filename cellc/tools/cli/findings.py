"""What commands share that report findings: their options, their output and their exit code."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from cellc.contract.diagnostics import Diagnostic, Severity
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.errors import reason_of
from cellc.contract.printing import show, show_document
from cellc.contract.store.swap import write_whole
from cellc.tools.cli.words import complete_codes
from cellc.tools.report.selection import Selection, UnknownSelectionError, selection
from cellc.tools.report.text_report import render_text, summary, summed_blockers

if TYPE_CHECKING:
    from cellc.compiler.graph.cell_graph import CellGraph
    from cellc.compiler.pipeline import Checked

FORMAT = click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "json", "sarif", "github"]),
    default="text",
    show_default=True,
    help="Output format of findings.",
)
SELECT = click.option(
    "--select",
    multiple=True,
    metavar="CODES",
    shell_complete=complete_codes,
    help="Report only these codes or families, such as QOS.",
)
IGNORE = click.option(
    "--ignore",
    multiple=True,
    metavar="CODES",
    shell_complete=complete_codes,
    help="Leave out these codes or families; overrides --select.",
)
FAIL_ON = click.option(
    "--fail-on",
    type=click.Choice([severity.value for severity in (Severity.ERROR, Severity.BLOCKER, Severity.WARNING)]),
    default=Severity.ERROR.value,
    show_default=True,
    help="Lowest severity for exit code 1.",
)


def show_findings(
    found: Sequence[Findings], output_format: str, *, hidden: int = 0, sum_blockers: bool = False
) -> None:
    """Write the findings of all cells to standard output.

    Args:
        found: one for each cell.
        hidden: findings that options left out; their number is printed.
        sum_blockers: print only the number of blockers, where nothing is worse.
    """
    if output_format != "text":
        _show_for_programs(_each_once(found), output_format)
        return
    for findings in found:
        summed = sum_blockers and all(each.severity is not Severity.ERROR for each in findings.diagnostics)
        listed = [each for each in findings.diagnostics if not summed or each.severity is not Severity.BLOCKER]
        if listed:
            show(*render_text(listed, findings.texts), "")
        show(summary(findings.diagnostics, [findings.file]))
        if summed:
            show(*summed_blockers(findings.diagnostics, findings.file))
    if hidden:
        show(f"{hidden} hidden by --select or --ignore")


def _each_once(found: Sequence[Findings]) -> tuple[Diagnostic, ...]:
    # A cell with several tuples has most of its findings with each.
    return tuple(dict.fromkeys(each for findings in found for each in findings.diagnostics))


def write_sarif(found: Sequence[Findings], file: Path) -> None:
    """Write the findings of all cells to a file, but through no link: in CI the checkout may hold one."""
    from cellc.tools.report.sarif_report import render_sarif

    try:
        write_whole(file, render_sarif(_each_once(found), Path.cwd()))
    except OSError as error:
        raise click.UsageError(f"`{error.filename or file}` cannot be written: {reason_of(error)}") from error


def linked(checked: Checked) -> CellGraph:
    """Return the graph of a cell; where it has none, show what is wrong with it and end the command."""
    if checked.graph is None:
        show_findings([checked.findings], "text")
        raise click.exceptions.Exit(1)
    return checked.graph


def number_hidden(found: Sequence[Findings], shown: Sequence[Findings]) -> int:
    """Return how many findings options left out."""
    return sum(len(findings.diagnostics) for findings in found) - sum(len(findings.diagnostics) for findings in shown)


def fails(found: Findings, fail_on: str) -> bool:
    """Tell whether a finding is as severe as ``fail_on``."""
    return any(diagnostic.severity.rank <= Severity(fail_on).rank for diagnostic in found.diagnostics)


def _show_for_programs(found: Sequence[Diagnostic], output_format: str) -> None:
    """Write findings in a format for programs; each renderer is imported only when it is asked for."""
    if output_format == "json":
        from cellc.tools.report.json_report import render_json

        show_document(render_json(found))
    elif output_format == "sarif":
        from cellc.tools.report.sarif_report import render_sarif

        show_document(render_sarif(found, Path.cwd()))
    else:
        from cellc.tools.report.github_report import render_github

        show(*render_github(found, Path.cwd()))


def read_selection(select: Sequence[str], ignore: Sequence[str]) -> Selection:
    """Return what the options ask for; each may be given several times, and hold several names with commas."""
    try:
        return selection(_names(select), _names(ignore))
    except UnknownSelectionError as problem:
        raise click.UsageError(str(problem)) from problem


def selected(findings: Findings, wanted: Selection) -> Findings:
    """Return the findings that were asked for."""
    return replace(
        findings, diagnostics=tuple(diagnostic for diagnostic in findings.diagnostics if wanted.shows(diagnostic))
    )


def selected_and_errors(findings: Findings, wanted: Selection) -> Findings:
    """Return the findings that were asked for and every error, for a command that errors stop."""
    shown = (
        diagnostic
        for diagnostic in findings.diagnostics
        if diagnostic.severity is Severity.ERROR or wanted.shows(diagnostic)
    )
    return replace(findings, diagnostics=tuple(shown))


def _names(given: Sequence[str]) -> list[str]:
    return [name.strip() for text in given for name in text.split(",") if name.strip()]
