"""Where binding stops: after so many wrong references a spec is not one with mistakes, and each costs a search."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from typing import TypeVar

from cellc.compiler.source.document import MAX_FINDINGS
from cellc.contract.diagnostics import Diagnostic

_Entry = TypeVar("_Entry")


def until_hopeless(entries: Collection[_Entry], problems: list[Diagnostic]) -> Iterator[_Entry]:
    """Yield entry after entry of a section while there are few problems; the last one says how many were left out."""
    for number, entry in enumerate(entries):
        if is_hopeless(problems):
            left = f"not checked after so many findings: {len(entries) - number} more"
            problems[-1] = replace(problems[-1], help="; ".join(filter(None, (problems[-1].help, left))))
            return
        yield entry


def is_hopeless(problems: Collection[Diagnostic]) -> bool:
    """Tell whether a section was left before its end; what refers to the rest of it would be reported wrongly."""
    return len(problems) >= MAX_FINDINGS
