"""The options by which commands leave findings out of what they report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import click

from cellc.diagnostics import Severity
from cellc.diagnostics.findings import Findings
from cellc.report.selection import Selection

SELECT = click.option(
    "--select", multiple=True, metavar="CODES", help="Report only these codes or families, such as QOS."
)
IGNORE = click.option(
    "--ignore", multiple=True, metavar="CODES", help="Leave these codes or families out; wins over --select."
)


def read_selection(select: Sequence[str], ignore: Sequence[str]) -> Selection:
    """Return what the options ask for; each may be given several times, and hold several names with commas."""
    if not select and not ignore:
        return Selection()
    from cellc.report.selection_names import UnknownSelectionError, selection

    try:
        return selection(_names(select), _names(ignore))
    except UnknownSelectionError as problem:
        raise click.UsageError(str(problem)) from problem


def selected(findings: Findings, wanted: Selection) -> Findings:
    """Return the findings that were asked for."""
    return replace(findings, diagnostics=tuple(one for one in findings.diagnostics if wanted.shows(one)))


def selected_and_errors(findings: Findings, wanted: Selection) -> Findings:
    """Return the findings that were asked for and every error, for a command that errors stop."""
    shown = (one for one in findings.diagnostics if one.severity is Severity.ERROR or wanted.shows(one))
    return replace(findings, diagnostics=tuple(shown))


def _names(given: Sequence[str]) -> list[str]:
    return [name.strip() for text in given for name in text.split(",") if name.strip()]
