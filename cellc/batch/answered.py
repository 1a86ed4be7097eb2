"""Answer for the specs of one call, in their order, each with what the cells before it have against it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from cellc.batch.answer import Answer
from cellc.batch.compute import Kind, compute
from cellc.batch.cores import number_of_workers
from cellc.batch.kept import keep_answer, recall_answer
from cellc.disk import Record
from cellc.fleet.presence import Presence


def answered(kind: Kind, files: Sequence[str], program: str | None) -> Iterator[Answer]:
    """Yield the answer for each spec: the kept one where it holds, else a computed one, which is kept.

    Args:
        files: specs as the user named them.
        program: mark of the program from before its code was loaded; None recalls and keeps nothing.
    """
    kept = [None if program is None else recall_answer(kind, file, program) for file in files]
    computed = _computed(kind, [file for file, answer in zip(files, kept, strict=True) if answer is None])
    earlier: list[Presence] = []
    for file, answer in zip(files, kept, strict=True):
        if answer is None:
            answer, asked = next(computed)
            if program is not None:
                keep_answer(kind, file, program, answer, asked)
        yield _among(earlier, answer)


def _among(earlier: list[Presence], answer: Answer) -> Answer:
    """Add what the cells before this one have against it, and add it to them; an error stops its artifacts."""
    if answer.cell is None:
        return answer
    if not earlier:
        earlier.append(answer.cell)
        return answer
    from cellc.fleet.shared_domain import shared_domains

    against = tuple(shared_domains(answer.cell, earlier))
    earlier.append(answer.cell)
    if not against:
        return answer
    return replace(answer, findings=answer.findings.with_more(against), artifacts=None)


def _computed(kind: Kind, files: Sequence[str]) -> Iterator[tuple[Answer, Record]]:
    number = number_of_workers(kind, len(files))
    if number == 1:
        yield from (compute(kind, file) for file in files)
        return
    # Python's machinery of processes takes longer to load than a small cell to check.
    from cellc.batch.workers import in_workers

    yield from in_workers(kind, files, number)
