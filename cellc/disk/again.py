"""Whether the disk still says what it said."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress

from cellc.disk.questions import ASK
from cellc.disk.record import Question, recorded


def still_says(marks: Mapping[Question, str]) -> bool:
    """Ask every question again, in the order in which it was asked; the first other answer ends it."""
    return all(_mark_of(question) == mark for question, mark in marks.items())


def _mark_of(question: Question) -> str | None:
    what, path, limit = question
    if what not in ASK:
        return None
    with recorded() as record, suppress(OSError, ValueError):  # the record has it
        ASK[what](path, limit)
    return record.marks[question]
