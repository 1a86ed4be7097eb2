"""Answers with a count of those that were computed, not recalled."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from cellc.batch import answered as module
from cellc.batch.answer import Answer
from cellc.batch.answered import answered
from cellc.batch.compute import Kind, compute
from cellc.disk import Record


@dataclass
class Counting:
    """Computes as usual, and notes for what."""

    files: list[str] = field(default_factory=list)

    def __call__(self, kind: Kind, file: str) -> tuple[Answer, Record]:
        self.files.append(file)
        return compute(kind, file)


def counting(patch: pytest.MonkeyPatch) -> Counting:
    """Count from here on what this process computes."""
    count = Counting()
    patch.setattr(module, "compute", count)
    return count


def answer(file: str, program: str | None = "this program", kind: Kind = "check") -> Answer:
    """Answer for one spec."""
    (only,) = answered(kind, [file], program)
    return only
