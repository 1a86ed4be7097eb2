"""A diagnosis as text for the person who stands before the cell."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnose.diagnosis import Cause, Suspicion
from cellc.report.colour import BLUE, BOLD, GREEN, paint
from cellc.report.escape import escape


def render_suspicions(suspicions: tuple[Suspicion, ...], *, colour: bool) -> str:
    """Return every suspicion with its hypotheses, the best first, ending in a line break."""
    blocks = ["\n".join(_suspicion(one, colour)) for one in suspicions]
    return "\n\n".join(blocks) + "\n"


def _suspicion(suspicion: Suspicion, colour: bool) -> Iterator[str]:
    yield paint(f"{suspicion.layer}: {suspicion.symptom}", BOLD, colour)
    if suspicion.evidence:
        yield f"  the line names: {escape(', '.join(suspicion.evidence))}"
    for name in suspicion.unknown:
        yield f"  {escape(name)} is not part of this cell"
    for number, cause in enumerate(suspicion.causes, 1):
        yield from _cause(number, cause, colour)
    yield f"  do not: {suspicion.never}"
    yield f"  who decides: {escape(suspicion.owner)}"
    yield f"  source: {suspicion.source}"


def _cause(number: int, cause: Cause, colour: bool) -> Iterator[str]:
    yield f"  {number}. {cause.text}?"
    for step in cause.steps:
        mark = "$" if step.is_command else "look at"
        yield f"     {paint(mark, BLUE, colour)} {escape(step.action)}"
        yield f"       {paint('ruled out if', GREEN, colour)} {escape(step.refuted)}"
    if cause.omitted:
        yield f"     and the same for {cause.omitted} more; name one in the symptom to see it alone"
