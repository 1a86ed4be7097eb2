"""``cellc diagnose``: what a symptom may mean in this cell, and what to look at."""

from __future__ import annotations

import click

from cellc.cell.cell import Cell
from cellc.cli.findings import show_findings
from cellc.cli.limit_option import limit_option
from cellc.printing import show


@click.command()
@click.argument("symptom")
@click.argument("file", required=False, type=click.Path(path_type=str))
@limit_option
def diagnose(symptom: str, file: str | None) -> None:
    """Classify SYMPTOM, words or a log line, and tell which read-only observation rules each cause out.

    With FILE, a cell spec, the commands name its own controllers, topics and frames. Nothing is executed, and nothing
    that is told bypasses a protection. Exit code 1 where no known symptom fits.
    """
    from cellc.diagnose.diagnose import diagnose as suspicions_of
    from cellc.diagnose.symptoms import knowledge
    from cellc.report.text_report import render_suspicions

    suspicions = suspicions_of(symptom, _cell(file))
    if not suspicions:
        layers = ", ".join(layer.title for layer in knowledge())
        show(f"UNKNOWN: no known symptom fits; rule out in this order: {layers}")
        raise click.exceptions.Exit(1)
    show(*render_suspicions(suspicions))


def _cell(file: str | None) -> Cell | None:
    if file is None:
        return None
    from cellc.pipeline import check

    checked = check(file)
    if checked.graph is None:
        show_findings([checked.findings], "text")
        raise click.exceptions.Exit(1)
    return checked.graph.cell
