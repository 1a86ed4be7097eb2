"""Answer for the specs of one call, in their order."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.batch.answer import Answer
from cellc.batch.compute import Kind, compute
from cellc.batch.kept import keep_answer, recall_answer
from cellc.disk import Record


def answered(kind: Kind, files: Sequence[str], program: str | None) -> Iterator[Answer]:
    """Yield the answer for each spec: the kept one where it holds, else a computed one, which is kept.

    Args:
        files: specs as the user named them.
        program: mark of the program from before its code was loaded; None recalls and keeps nothing.
    """
    kept = [None if program is None else recall_answer(kind, file, program) for file in files]
    computed = _computed(kind, [file for file, answer in zip(files, kept, strict=True) if answer is None])
    for file, answer in zip(files, kept, strict=True):
        if answer is not None:
            yield answer
            continue
        fresh, asked = next(computed)
        if program is not None:
            keep_answer(kind, file, program, fresh, asked)
        yield fresh


def _computed(kind: Kind, files: Sequence[str]) -> Iterator[tuple[Answer, Record]]:
    from cellc.batch.workers import in_workers, number_of_workers

    number = number_of_workers(kind, len(files))
    if number > 1:
        yield from in_workers(kind, files, number)
    else:
        yield from (compute(kind, file) for file in files)
