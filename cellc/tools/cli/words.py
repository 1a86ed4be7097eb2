"""What a shell completes beside commands and options: codes, models, rehearsals and runs.

Nothing is printed and nothing raised here: a folder that cannot be read has nothing to complete. A shell puts a word
into its line as it is, and shows its help on the terminal: a name that a shell evaluates, or that a terminal
obeys, is no word.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.shell_completion import CompletionItem

from cellc.contract.diagnostics.unsafe_text import escaped
from cellc.contract.limits import limits
from cellc.contract.store.regular_file import open_regular, read_regular

if TYPE_CHECKING:
    from cellc.contract.rehearsals import RehearsalEntry

_MOST_BYTES = 10_000_000
_PLAIN = re.compile(r"[\w./:@=,+-]+", re.ASCII)
"""No quote, blank or mark of a shell."""

Complete = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def _complete(known: Callable[[click.Context], Iterable[tuple[str, str]]], apart: str = "") -> Complete:
    """Return a completion of words with a help for each; what is before the last ``apart`` is kept as it is."""

    def complete(context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, mark, typed = incomplete.rpartition(apart) if apart else ("", "", incomplete)
        words = (pair for pair in known(context) if pair[0].startswith(typed))
        return _items((f"{before}{mark}{word}", said) for word, said in words)

    return complete


def _items(words: Iterable[tuple[str, str]]) -> list[CompletionItem]:
    return [CompletionItem(word, help=escaped(said)) for word, said in words if _PLAIN.fullmatch(word)]


def _codes(_context: click.Context) -> Iterable[tuple[str, str]]:
    from cellc.compiler.pages import all_codes
    from cellc.contract.code_page import page_of

    return ((code, page_of(code).title) for code in all_codes())


def _models(_context: click.Context) -> Iterable[tuple[str, str]]:
    from cellc.tools.browse.search import entries

    return ((entry.model.model, entry.model.summary) for entry in entries())


def _rehearsals(context: click.Context) -> Iterable[tuple[str, str]]:
    return ((entry.name, f"expects {entry.expect}") for entry in _entries(context))


def _entries(context: click.Context) -> Sequence[RehearsalEntry]:
    from cellc.contract.rehearsals import Rehearsals

    try:
        return Rehearsals.model_validate_json(
            read_regular(_folder(context) / "rehearsals.json", limits().folder_bytes)
        ).rehearsals
    except (OSError, ValueError):
        return ()


def _folder(context: click.Context) -> Path:
    several = context.params.get("folders") or (context.params.get("package") or context.params.get("folder"),)
    # Behind an option without its value click has not distinguished arguments from each other yet.
    return Path(str(next(filter(None, (*several, *context.args)), "")))


def complete_run(context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
    """Complete the runs that are made again: of the campaign, of one rehearsal at a time, and of a journal's sweep.

    Which steps a fault can meet is known by a run without it; only the rehearsal that is meant is run.
    """
    names = [f"{entry.name}/" for entry in _entries(context) if entry.is_plain]
    meant = [name for name in names if name.startswith(incomplete) or incomplete.startswith(name)]
    runs = meant if len(meant) > 1 else _campaign_runs(context, meant[0].rstrip("/")) if meant else ()
    known = (*runs, *_swept_runs(context.params.get("journal")))
    return _items((run, "") for run in known if run.startswith(incomplete))


def _campaign_runs(context: click.Context, rehearsal: str) -> Iterable[str]:
    from cellc.mock.campaign.campaign import make_plan
    from cellc.mock.cell import cell_of, load
    from cellc.mock.errors import MockError
    from cellc.mock.faults.registry import possible_faults

    try:
        cell = load(_folder(context), edited=True)
        alone = tuple(entry for entry in cell.folder.rehearsals if entry.name == rehearsal)
        plan, _ = make_plan(cell_of(replace(cell.folder, rehearsals=alone)), possible_faults(cell.contract), 0)
    except MockError:
        return ()
    return (run.identifier for run in plan.singles())


def _swept_runs(journal: str | None) -> Iterable[str]:
    """Return the runs of a journal, those that failed first: they are what one looks at again."""
    try:
        with open_regular(Path(journal or "")) as file:
            _, *lines = file.read(_MOST_BYTES).splitlines()
        runs = [(bool(run["passed"]), f"sweep:{int(run['number'])}") for run in map(json.loads, lines)]
    except (KeyError, TypeError, OSError, OverflowError, RecursionError, ValueError):
        return ()
    return (run for _, run in sorted(runs, key=lambda each: each[0]))


complete_code = _complete(_codes)
complete_codes = _complete(_codes, ",")
complete_model = _complete(_models)
complete_named_model = _complete(_models, "=")
complete_rehearsal = _complete(_rehearsals)
