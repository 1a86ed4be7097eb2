"""What commands share that report findings: their options, their output and their exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from cellc.diagnostics import Diagnostic, Severity
from cellc.diagnostics.findings import Findings
from cellc.report.colour import wants_colour
from cellc.report.summary import summary
from cellc.report.text_report import render_text

FORMAT = click.option(
    "--format",
    "output_format",
    type=click.Choice(["text", "json", "sarif", "github"]),
    default="text",
    show_default=True,
    help="How findings are written.",
)
FAIL_ON = click.option(
    "--fail-on",
    type=click.Choice([severity.value for severity in (Severity.ERROR, Severity.BLOCKER, Severity.WARNING)]),
    default=Severity.ERROR.value,
    show_default=True,
    help="Least severity that makes the exit code 1.",
)

_RANK = {Severity.ERROR: 0, Severity.BLOCKER: 1, Severity.WARNING: 2, Severity.AUDIT: 3}


def show_findings(found: Sequence[Findings], output_format: str, *, hidden: int = 0) -> None:
    """Write the findings of all cells to standard output.

    Args:
        found: one for each cell.
        hidden: findings that options left out; people are told how many.
    """
    if output_format != "text":
        click.echo(_renderer(output_format)([d for one in found for d in one.diagnostics]), nl=False)
        return
    colour = wants_colour(sys.stdout, os.environ)
    for one in found:
        if one.diagnostics:
            click.echo(render_text(one.diagnostics, one.texts, colour=colour), color=colour)
        click.echo(summary(one.diagnostics, [one.file], colour=colour), color=colour)
    if hidden:
        click.echo(f"{hidden} hidden by --select or --ignore")


def number_hidden(found: Sequence[Findings], shown: Sequence[Findings]) -> int:
    """Return how many findings options left out."""
    return sum(len(one.diagnostics) for one in found) - sum(len(one.diagnostics) for one in shown)


def finish(found: Sequence[Findings], fail_on: str) -> None:
    """Leave with 1 where a finding is as severe as ``fail_on``."""
    limit = _RANK[Severity(fail_on)]
    if any(_RANK[d.severity] <= limit for one in found for d in one.diagnostics):
        raise click.exceptions.Exit(1)


def _renderer(output_format: str) -> Callable[[Sequence[Diagnostic]], str]:
    """Return the renderer of a format for programs; each is imported only when it is asked for."""
    if output_format == "json":
        from cellc.report.json_report import render_json

        return render_json
    if output_format == "sarif":
        from cellc.report.sarif_report import render_sarif

        return lambda found: render_sarif(found, Path.cwd())
    from cellc.report.github_report import render_github

    return lambda found: render_github(found, Path.cwd())
