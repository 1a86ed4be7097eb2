"""What a shell completes beside commands and options: codes, models and rehearsals.

Nothing is printed and nothing raised here: a folder that cannot be read has nothing to complete.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path

import click
from click.shell_completion import CompletionItem

Complete = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def _complete(known: Callable[[click.Context], Iterable[tuple[str, str]]], apart: str = "") -> Complete:
    """Return a completion of words with a help for each; what stands before the last ``apart`` is kept as it is."""

    def complete(context: click.Context, _parameter: click.Parameter, incomplete: str) -> list[CompletionItem]:
        before, mark, begun = incomplete.rpartition(apart) if apart else ("", "", incomplete)
        words = (one for one in known(context) if one[0].startswith(begun))
        return [CompletionItem(f"{before}{mark}{word}", help=said) for word, said in words]

    return complete


def _codes(_context: click.Context) -> Iterable[tuple[str, str]]:
    from cellc.report.pages import all_pages

    return ((code, page.title) for code, page in all_pages().items())


def _models(_context: click.Context) -> Iterable[tuple[str, str]]:
    from cellc.browse.search import entries

    return ((entry.model.model, entry.model.summary) for entry in entries())


def _rehearsals(context: click.Context) -> Iterable[tuple[str, str]]:
    # Behind an option without its value click has not told arguments from each other yet.
    folder = context.params.get("folder") or next(iter(context.args), "")
    try:
        told = json.loads((Path(str(folder)) / "rehearsals.json").read_text(encoding="utf-8"))
        return [(str(one["name"]), f"expects {one['expect']}") for one in told["rehearsals"]]
    except (KeyError, TypeError, OSError, ValueError):
        return ()


complete_code = _complete(_codes)
complete_codes = _complete(_codes, ",")
complete_model = _complete(_models)
complete_named_model = _complete(_models, "=")
complete_rehearsal = _complete(_rehearsals)
