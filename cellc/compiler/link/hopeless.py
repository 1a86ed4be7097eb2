"""Where binding stops: after so many wrong references a spec is not one with mistakes, and each costs a search."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from typing import TypeVar

from cellc.compiler.source.document import MAX_FINDINGS
from cellc.contract.diagnostics import Diagnostic

_Entry = TypeVar("_Entry")


def until_hopeless(entries: Collection[_Entry], problems: list[Diagnostic]) -> Iterator[_Entry]:
    """Yield entry after entry of a section while there are few problems; the last one says how many were left out."""
    for number, entry in enumerate(entries):
        if len(problems) >= MAX_FINDINGS:
            left = f"not checked after so many findings: {len(entries) - number} more"
            problems[-1] = replace(problems[-1], help="; ".join(filter(None, (problems[-1].help, left))))
            return
        yield entry


def to_first_hopeless(parts: Iterable[tuple[Diagnostic, ...]]) -> Iterator[Diagnostic]:
    """Yield problems of part after part up to one that was left early: what refers to the rest of it is no mistake."""
    for problems in parts:
        yield from problems
        if len(problems) >= MAX_FINDINGS:
            return
