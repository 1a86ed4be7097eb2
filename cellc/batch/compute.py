"""Compute an answer, with what was asked of the disk on the way."""

from __future__ import annotations

from typing import Literal

from cellc.batch.answer import Answer
from cellc.disk import Record, recorded

Kind = Literal["check", "compile"]


def compute(kind: Kind, file: str) -> tuple[Answer, Record]:
    """Check a spec, or check and compile it."""
    with recorded() as record:
        answer = _checked(file) if kind == "check" else _compiled(file)
    return answer, record


def _checked(file: str) -> Answer:
    # The compiler is loaded by the first answer that has to be computed.
    from cellc.fleet.presence_of import presence_of
    from cellc.pipeline import check

    checked = check(file)
    return Answer(checked.findings, None if checked.graph is None else presence_of(checked.graph))


def _compiled(file: str) -> Answer:
    from cellc.fleet.presence_of import presence_of
    from cellc.pipeline import check, compile_cell

    checked = check(file)
    if checked.graph is None:
        return Answer(checked.findings)
    compiled = compile_cell(checked)
    artifacts = compiled.value if compiled.ok else None
    return Answer(checked.findings.with_more(compiled.diagnostics), presence_of(checked.graph), artifacts)
