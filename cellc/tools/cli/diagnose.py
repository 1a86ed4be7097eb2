"""``cellc diagnose``: what a symptom may mean in this cell, and what to look at."""

from __future__ import annotations

import os

import click

from cellc.compiler.cell.cell import Cell
from cellc.contract.printing import show
from cellc.tools.cli.findings import linked
from cellc.tools.cli.limit_option import limit_option


@click.command()
@click.argument("words", nargs=-1, metavar="[SYMPTOM]... [FILE]", type=click.Path(path_type=str))
@limit_option
def diagnose(words: tuple[str, ...]) -> None:
    """Classify SYMPTOM, words or log lines, and list the read-only observation that rules out each cause.

    Without SYMPTOM, list all known symptoms. With FILE, a cell spec, the commands use the controllers, topics and
    frames of that cell. Nothing is executed, and no command bypasses a protection. Exit code 1 if no known symptom
    fits; the nearest are listed.

    \b
    cellc diagnose arm sags when it is enabled
    cellc diagnose "goal was rejected" cells/bench/cell.yaml
    """
    from cellc.tools.diagnose.diagnose import diagnose as suspicions_of
    from cellc.tools.diagnose.diagnose import near
    from cellc.tools.diagnose.symptoms import knowledge
    from cellc.tools.report.text_report import render_nearest, render_suspicions, render_symptoms

    symptom, file = _read(words)
    if not symptom:
        show(*render_symptoms(knowledge()))
        return
    cell = _cell(file)
    suspicions = suspicions_of(symptom, cell)
    if not suspicions:
        show(*render_nearest(near(symptom, cell), [layer.title for layer in knowledge()]))
        raise click.exceptions.Exit(1)
    show(*render_suspicions(suspicions))


def _read(words: tuple[str, ...]) -> tuple[str, str | None]:
    """Return the symptom, and the spec where the last word names a file."""
    *symptom, last = words or ("",)
    if not last.endswith((".yaml", ".yml")) and not os.path.isfile(last):
        return " ".join(words), None
    if not symptom:
        raise click.UsageError(f"expected a symptom before `{last}`, such as `cellc diagnose arm sags {last}`.")
    return " ".join(symptom), last


def _cell(file: str | None) -> Cell | None:
    if file is None:
        return None
    from cellc.compiler.pipeline import check

    return linked(check(file)).cell
