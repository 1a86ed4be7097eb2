"""``cellc diagnose``: what a symptom, or logs, may mean in this cell, and what to look at."""

from __future__ import annotations

import os
from pathlib import Path

import click

from cellc.compiler.cell.cell import Cell
from cellc.contract.printing import refuse, show
from cellc.tools.cli.findings import linked
from cellc.tools.cli.limit_option import limit_option

_SPEC = "cell.yaml"


@click.command(context_settings={"ignore_unknown_options": True})  # a pasted line has `--ros-args`, a sentence `-5 mm`
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
    """Say which layer SYMPTOM, a sentence or pasted log lines, points to, and what rules out each cause.

    No quotes are needed. Up to three symptoms are proposed, each with its causes and the read-only observation that
    rules each one out. Unless a line names the cause, the answer begins with `not sure` and the one question that
    decides, and ends with how that part of a cell is narrowed down; where no symptom fits well, the part comes first.
    Without SYMPTOM, list all known symptoms. With FILE, a cell spec or the folder of its cell.yaml, the
    commands use the controllers, topics and frames of that cell. Nothing is executed, and no command bypasses a
    protection. Exit code 1 if no known symptom fits; the nearest are listed, with the question that narrows most.

    With --log, read folders such as `~/.ros/log` and journals (`journalctl -o short` or `-o json`), and name the layer
    that spoke first, in the order of time over all files; its first errors are answered as if they had been pasted.
    Exit code 0 if nothing was found, 1 if something was.

    \b
    cellc diagnose robot drops when brakes release
    cellc diagnose two PCs see no topics of each other, one runs docker
    cellc diagnose "the arm floats up in freedrive" cells/bench/cell.yaml
    cellc diagnose "[ERROR] [controller_manager]: ..."
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
    from cellc.tools.diagnose.diagnose import diagnose as answer_to
    from cellc.tools.diagnose.symptoms import knowledge
    from cellc.tools.report.diagnosis_text import render_answer, render_symptoms

    if not symptom:
        show(*render_symptoms(knowledge()))
        return
    answer = answer_to(symptom, _cell(file))
    show(*render_answer(answer))
    if not answer.fits:
        raise click.exceptions.Exit(1)


def _search(path: Path, file: str | None) -> None:
    from cellc.tools.diagnose.diagnose import diagnose as answer_to
    from cellc.tools.diagnose.diagnose import routes_in
    from cellc.tools.diagnose.logs import LogError, search
    from cellc.tools.report.diagnosis_text import render_answer, render_routes
    from cellc.tools.report.log_text import render_searched

    cell = _cell(file)
    try:
        searched = search(path)
    except LogError as problem:
        refuse(str(problem))
        raise click.exceptions.Exit(2) from None
    answer = answer_to(searched.answered, cell) if searched.answered else None
    if searched.pasted or answer is None:
        show(*render_searched(searched, is_certain=answer is not None and not answer.ask))
    if answer is None:
        show(*render_routes(routes_in(searched.short, cell), "if something is wrong nevertheless: "))
    if answer is not None:
        show(*([""] if searched.pasted else []), *render_answer(answer))
        raise click.exceptions.Exit(1)


def _read(words: tuple[str, ...], *, is_alone: bool) -> tuple[str, str | None]:
    """Return the symptom, and the spec where the last word names a file, or a folder with one."""
    *symptom, last = words or ("",)
    if words and words[0].startswith("-"):
        raise click.NoSuchOption(words[0])
    if os.path.isdir(last) and os.path.isfile(os.path.join(last, _SPEC)):
        last = os.path.join(last, _SPEC)
    elif os.path.isdir(last) and os.sep in last:
        raise click.UsageError(f"`{last}` must be a cell spec, got a folder without {_SPEC}; `--log` takes logs.")
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
