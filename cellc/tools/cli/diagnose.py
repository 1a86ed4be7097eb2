"""``cellc diagnose``: what a symptom, or logs, may mean in this cell, and what to look at."""

from __future__ import annotations

import os
from pathlib import Path

import click

from cellc.compiler.cell.cell import Cell
from cellc.contract.printing import refuse, show
from cellc.tools.cli.findings import linked
from cellc.tools.cli.limit_option import limit_option


@click.command()
@click.argument("words", nargs=-1, metavar="[SYMPTOM]... [FILE]", type=click.Path(path_type=str))
@click.option(
    "--log",
    "logs",
    metavar="FILE|FOLDER",
    type=click.Path(path_type=Path),
    help="Search this log, or every log below this folder; no SYMPTOM then.",
)
@limit_option
def diagnose(words: tuple[str, ...], logs: Path | None) -> None:
    """Classify SYMPTOM, words or log lines, and list the read-only observation that rules out each cause.

    Without SYMPTOM, list all known symptoms. With FILE, a cell spec, the commands use the controllers, topics and
    frames of that cell. Nothing is executed, and no command bypasses a protection. Exit code 1 if no known symptom
    fits; the nearest are listed.

    With --log, read folders such as `~/.ros/log` and journals (`journalctl -o short` or `-o json`), and name the layer
    that spoke first, in the order of time over all files. Exit code 0 if nothing was found, 1 if something was.

    \b
    cellc diagnose arm sags when it is enabled
    cellc diagnose "goal was rejected" cells/bench/cell.yaml
    cellc diagnose --log ~/.ros/log/latest cells/bench/cell.yaml
    """
    symptom, file = _read(words, is_alone=logs is not None)
    if logs is not None:
        if symptom:
            raise click.UsageError(f"--log takes no symptom beside it, got `{symptom}`.")
        _search(logs, file)
        return
    _classify(symptom, file)


def _classify(symptom: str, file: str | None) -> None:
    from cellc.tools.diagnose.diagnose import diagnose as suspicions_of
    from cellc.tools.diagnose.diagnose import near
    from cellc.tools.diagnose.symptoms import knowledge
    from cellc.tools.report.text_report import render_nearest, render_suspicions, render_symptoms

    if not symptom:
        show(*render_symptoms(knowledge()))
        return
    cell = _cell(file)
    suspicions = suspicions_of(symptom, cell)
    if not suspicions:
        show(*render_nearest(near(symptom, cell), [layer.title for layer in knowledge()]))
        raise click.exceptions.Exit(1)
    show(*render_suspicions(suspicions))


def _search(path: Path, file: str | None) -> None:
    from cellc.tools.diagnose.diagnose import suspicion_of
    from cellc.tools.diagnose.logs import LogError, search
    from cellc.tools.report.log_text import render_searched
    from cellc.tools.report.text_report import render_suspicions

    cell = _cell(file)
    try:
        searched = search(path)
    except LogError as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None
    show(*render_searched(searched))
    first = searched.first
    if first is not None:
        show("", *render_suspicions((suspicion_of(first.match, first.text, cell),)))
        raise click.exceptions.Exit(1)


def _read(words: tuple[str, ...], *, is_alone: bool) -> tuple[str, str | None]:
    """Return the symptom, and the spec where the last word names a file."""
    *symptom, last = words or ("",)
    if not last.endswith((".yaml", ".yml")) and not os.path.isfile(last):
        return " ".join(words), None
    if not symptom and not is_alone:
        raise click.UsageError(f"expected a symptom before `{last}`, such as `cellc diagnose arm sags {last}`.")
    return " ".join(symptom), last


def _cell(file: str | None) -> Cell | None:
    if file is None:
        return None
    from cellc.compiler.pipeline import check

    return linked(check(file)).cell
