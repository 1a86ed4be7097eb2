"""What was asked of the disk while an answer was computed, and what the disk said."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Any

Question = tuple[str, str, int]
"""What is asked, of which path as it was named, and a limit in bytes where the answer depends on one."""


@dataclass(slots=True)
class Record:
    """Questions in the order in which they were first asked, each with the mark of its answer.

    Attributes:
        holds: False where the answer in work cannot be kept: the disk said two things, or chance had a part in it.
    """

    marks: dict[Question, str] = field(default_factory=dict)
    holds: bool = True

    def note(self, question: Question, mark: str) -> None:
        """Write down an answer; the same question must have had the same answer before."""
        self.holds = self.holds and self.marks.setdefault(question, mark) == mark

    def to_plain(self) -> dict[str, object]:
        """Return the record as JSON values."""
        return {"holds": self.holds, "marks": [[*question, mark] for question, mark in self.marks.items()]}

    @staticmethod
    def from_plain(plain: Mapping[str, Any]) -> Record:
        """Read what `to_plain` wrote.

        Raises:
            KeyError, TypeError, ValueError: it is something else.
        """
        marks = {(str(what), str(path), int(limit)): str(mark) for what, path, limit, mark in plain["marks"]}
        return Record(marks, bool(plain["holds"]))


_RECORD: ContextVar[Record | None] = ContextVar("record", default=None)


@contextmanager
def recorded() -> Iterator[Record]:
    """Write down the questions that are asked inside the block, for this block alone."""
    record = Record()
    before = _RECORD.set(record)
    try:
        yield record
    finally:
        _RECORD.reset(before)


@contextmanager
def unrecorded() -> Iterator[None]:
    """Ask inside the block about files of the package: they belong to the program."""
    before = _RECORD.set(None)
    try:
        yield
    finally:
        _RECORD.reset(before)


def record_in_work() -> Record | None:
    """Return the record of the innermost block, None outside of all."""
    return _RECORD.get()


def include_in_work(other: Record) -> None:
    """Take over into the record in work what was asked elsewhere, such as in a child process."""
    record = _RECORD.get()
    if record is not None:
        record.holds = record.holds and other.holds
        for question, mark in other.marks.items():
            record.note(question, mark)


def not_to_be_kept() -> None:
    """Say that time, memory or chance had a part in the answer in work."""
    record = _RECORD.get()
    if record is not None:
        record.holds = False
