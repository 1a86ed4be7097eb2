"""``cellc diagnose``: what a symptom may mean in this cell, and what to look at."""

from __future__ import annotations

import click

from cellc.cell.cell import Cell
from cellc.cli.findings import show_findings
from cellc.cli.limit_option import limit_option
from cellc.printing import show


@click.command()
@click.argument("symptom", required=False)
@click.argument("file", required=False, type=click.Path(path_type=str))
@limit_option
def diagnose(symptom: str | None, file: str | None) -> None:
    """Classify SYMPTOM, words or log lines, and tell which read-only observation rules each cause out.

    Without it, every symptom that is known is listed. With FILE, a cell spec, the commands name its own controllers,
    topics and frames. Nothing is executed, and nothing that is told bypasses a protection. Exit code 1 where no known
    symptom fits; the nearest are named.

    \b
    cellc diagnose "arm sags when it is enabled"
    cellc diagnose "goal was rejected" cells/bench/cell.yaml
    """
    from cellc.diagnose.diagnose import diagnose as suspicions_of
    from cellc.diagnose.diagnose import near
    from cellc.diagnose.symptoms import knowledge
    from cellc.report.text_report import render_nearest, render_suspicions, render_symptoms

    if symptom is None:
        show(*render_symptoms(knowledge()))
        return
    cell = _cell(file)
    suspicions = suspicions_of(symptom, cell)
    if not suspicions:
        show(*render_nearest(near(symptom, cell), [layer.title for layer in knowledge()]))
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
