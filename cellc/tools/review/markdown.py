"""A review as a comment of a pull request: GitHub's Markdown, no longer than GitHub takes.

Source: GitHub refuses a comment of more than 65536 characters ("body is too long (maximum is 65536 characters)").
Everything that comes from a file is written as code, so that it mentions no user and links nowhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import groupby

from cellc.compiler.formats.escape import code
from cellc.contract.diagnostics.unsafe_text import harmless_line
from cellc.contract.review import Review, ReviewChange, ReviewFinding
from cellc.contract.vocabulary import Grade
from cellc.tools.review.text import gate_line, outcomes, subjects_of, summed_up

LONGEST = 65_000
_LONGEST_CELL = 300


def render_markdown(review: Review, longest: int = LONGEST) -> str:
    """Return the comment.

    Args:
        longest: characters; what does not fit is counted at the end.
    """
    head, tail = [*_head(review)], [*_tail(review)]
    room = longest - _length(head) - _length(tail) - 200
    shown, left = list[str](), 0
    for grade, changes in groupby(review.changes, key=lambda change: change.grade):
        section, of_grade = [*_opening(grade)], list(changes)
        for number, change in enumerate(of_grade):
            row = _row(change)
            if _length(shown) + _length(section) + len(row) + 30 > room:
                left += len(of_grade) - number
                break
            section.append(row)
        shown += [*section, "", "</details>", ""] if len(section) > _OPENING else []
    note = [f"**{left} more changes do not fit into a comment; `cellc diff` prints them all.**", ""] if left else []
    text = "\n".join([*head, *shown, *note, *tail]).rstrip("\n") + "\n"
    # A line is whole or not there: what is cut off in the middle of code is no code any more.
    return text if len(text) <= longest else text[: text.rfind("\n", 0, longest) + 1]


_OPENING = 4


def _length(lines: Iterable[str]) -> int:
    return sum(len(line) + 1 for line in lines)


def _head(review: Review) -> Iterator[str]:
    yield f"### {as_code(summed_up(review))}"
    yield ""
    yield f"{as_code(review.before.name)} ({as_code(review.before.configuration_id)}) → "
    yield f"{as_code(review.after.name)} ({as_code(review.after.configuration_id)})"
    yield ""


def _opening(grade: Grade) -> Iterator[str]:
    yield f"<details{'' if grade is Grade.SAFE else ' open'}><summary>{grade}</summary>"
    yield ""
    yield "| area | what | before | after | difference | approval |"
    yield "|---|---|---|---|---|---|"


def _row(change: ReviewChange) -> str:
    what = f"{as_code(subjects_of(change))} {as_code(change.quantity)}"
    what += "<br>**breaks consumers**" if change.breaking else ""
    what += f"<br>{as_code(change.why)}" if change.why else ""
    approval = (
        ""
        if change.grade is Grade.SAFE
        else f"{change.approval}: {as_code(change.owner) if change.owner else 'no owner'}"
    )
    cells = (change.area, what, _value(change.before), _value(change.after), _value(change.delta), approval)
    return f"| {' | '.join(cells)} |"


def _tail(review: Review) -> Iterator[str]:
    yield from folded("New findings", map(_finding, review.new_findings))
    yield from folded("Resolved findings", map(_finding, review.gone_findings))
    yield from folded("Rehearsals", (as_code(outcomes(rehearsal)) for rehearsal in review.rehearsals))
    yield from folded("Gates to repeat", (as_code(gate_line(gate)) for gate in review.gates))
    yield from folded("Notes", map(as_code, review.notes))


_MOST = 40


def folded(title: str, items: Iterable[str], *, is_open: bool = False) -> Iterator[str]:
    """Yield a list that folds up under its title and its length; nothing where it is empty."""
    lines = list(items)
    if not lines:
        return
    yield f"<details{' open' if is_open else ''}><summary>{title}: {len(lines)}</summary>"
    yield ""
    yield from (f"- {item}" for item in lines[:_MOST])
    if len(lines) > _MOST:
        yield f"- and {len(lines) - _MOST} more"
    yield ""
    yield "</details>"
    yield ""


def _finding(found: ReviewFinding) -> str:
    return f"{found.severity} {as_code(found.code)}: {as_code(found.message)}"


def _value(text: str | None) -> str:
    return as_code(text) if text else ""


def as_code(text: str) -> str:
    """Return a text as code in a cell of a table: a bar is its entity's look-alike there, for no escape is shown."""
    short = text if len(text) <= _LONGEST_CELL else f"{text[: _LONGEST_CELL - 3]}..."
    return code(harmless_line(re.sub(r"\|", "¦", short)))
