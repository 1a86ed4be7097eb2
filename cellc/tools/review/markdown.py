"""A review as a comment of a pull request: GitHub's Markdown, no longer than GitHub takes.

Source: GitHub refuses a comment of more than 65536 characters ("body is too long (maximum is 65536 characters)").
Of what comes from a file, plain words are prose, and everything else is code, so that it mentions no user and links
nowhere.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from cellc.compiler.formats.escape import code
from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.unsafe_text import harmless_line
from cellc.contract.diagnostics.wording import count
from cellc.contract.review import Review, ReviewChange, ReviewFinding
from cellc.contract.vocabulary import Grade
from cellc.tools.review.counts import grades_of
from cellc.tools.review.groups import Group, broken_by, groups_of
from cellc.tools.review.text import gate_line, outcomes, subjects_of, summed_up

LONGEST = 65_000
_LONGEST_CELL = 300
_OPEN_GROUPS = 6
"""Groups that have a line of their own; the others fold up under one, so that 25 lines show the comment."""
_OPEN_FINDINGS = _NAMED = 4
_PLAIN = re.compile(r"[-+]?[0-9]{1,6}(?:[.-][0-9]{1,6})*%?|[A-Za-z]{1,30}|->|[-+%]|")
"""Words that no reader of Markdown takes for anything else."""
_CODE = re.compile(r"(?<![^\s(])`([^`\s][^`]*)`(?![^\s.,;:)])")
_WORD = re.compile(r"(\(*)(.*?)([.,;:?)]*)")


def render_markdown(review: Review, longest: int = LONGEST) -> str:
    """Return the comment.

    Args:
        longest: characters; what does not fit is counted at the end.
    """
    head, tail = [*_head(review)], [*_tail(review)]
    room = longest - _length(head) - _length(tail) - 300
    groups = groups_of(review)
    shown, left = list[str](), 0
    for number, group in enumerate(groups):
        if number == _OPEN_GROUPS:
            shown += _dangers(groups[number:])
            shown += [f"<details><summary>{_more(groups[number:])}</summary>", ""]
        section, over = _of_group(group, room - _length(shown))
        shown += section
        left += over
    shown += ["</details>", ""] if len(groups) > _OPEN_GROUPS else []
    note = [f"**{left} more changes do not fit into a comment; `cellc diff --all` prints them.**", ""] if left else []
    text = "\n".join([*head, *shown, *note, *tail]).rstrip("\n") + "\n"
    # A line is whole or not there: what is cut off in the middle of code is no code any more.
    return text if len(text) <= longest else text[: text.rfind("\n", 0, longest) + 1]


def _dangers(groups: Sequence[Group]) -> Iterator[str]:
    """Yield why groups are dangerous that fold up: that is always seen."""
    told = [
        f"{as_code(group.name)}: {'; '.join(map(as_prose, (*group.unmeasured, *group.whys)))}"
        for group in groups
        if group.grade is Grade.DANGEROUS
    ]
    if told:
        yield f"**{Grade.DANGEROUS}** also {'; '.join(told)}"
        yield ""


def _more(groups: Sequence[Group]) -> str:
    """Return how many groups fold up, with the names of some: first of those by which nodes find each other."""
    changes = count(sum(len(group.changes) for group in groups), "change")
    names = [group.name for group in sorted(groups, key=lambda group: not group.finds)]
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return f"{count(len(groups), 'cause')} more with {changes}: {', '.join(map(as_code, names[:_NAMED]))}{more}"


def _length(lines: Iterable[str]) -> int:
    return sum(len(line) + 1 for line in lines)


def _head(review: Review) -> Iterator[str]:
    yield f"### {as_prose(summed_up(review))}"
    yield ""
    yield f"{as_code(review.before.name)} ({as_code(review.before.configuration_id)}) → "
    yield f"{as_code(review.after.name)} ({as_code(review.after.configuration_id)})"
    yield ""
    if broken := broken_by(review.changes):
        yield f"may break consumers of {', '.join(map(as_prose, broken))}"
        yield ""
    yield from _found(
        "New findings that fail", [each for each in review.new_findings if each.severity == Severity.ERROR]
    )


def _found(title: str, found: Sequence[ReviewFinding]) -> Iterator[str]:
    if found:
        yield f"**{title}: {len(found)}**"
        yield from (f"- {_finding(each)}" for each in found[:_OPEN_FINDINGS])
        yield ""
        yield from folded(f"More: {title.lower()}", map(_finding, found[_OPEN_FINDINGS:]))


def _of_group(group: Group, room: int) -> tuple[list[str], int]:
    """Return the lines of a group, and how many of its changes have no room."""
    unmeasured = "".join(f"; **{as_prose(told)}**" for told in group.unmeasured)
    figures = f": {as_prose('; '.join(group.figures))}" if group.figures else ""
    why = f"; because {as_prose('; '.join(group.whys))}" if group.whys else ""
    asks = f"; asks {as_prose(group.asks)}" if group.asks else ""
    lines = [
        f"**{group.grade}** {as_prose(group.marked)}{unmeasured}{figures}{why}",
        f"<details><summary>{', '.join(grades_of(group.changes))}</summary>",
        "",
        *([asks[2:], ""] if asks else []),
        "| grade | area | what | change | approval |",
        "|---|---|---|---|---|",
    ]
    ends = ["", "</details>", ""]
    if _length(lines) + _length(ends) > room:
        return [], len(group.changes)
    rows = list[str]()
    for change in group.changes:
        row = _row(change)
        if _length(lines) + _length(rows) + _length(ends) + len(row) + 1 > room:
            break
        rows.append(row)
    return [*lines, *rows, *ends], len(group.changes) - len(rows)


def _row(change: ReviewChange) -> str:
    what = f"{as_code(subjects_of(change))} {as_prose(change.quantity)}"
    what += "<br>**may break consumers**" if change.breaking else ""
    what += f"<br>{as_prose(change.why)}" if change.why else ""
    asked = {} if change.grade is Grade.SAFE else {change.approval: change.owner, **change.beside}
    approval = "<br>".join(f"{area}: {as_prose(owner) if owner else 'no owner'}" for area, owner in asked.items())
    return f"| {' | '.join((change.grade, change.area, what, _values(change), approval))} |"


_SHORT = 48


def _values(change: ReviewChange) -> str:
    """Return both values with their difference; of lists what they lost and gained, where that is shorter."""
    before, after, delta = change.before or "not stated", change.after or "not stated", change.delta
    if delta.startswith(("lost ", "new ")):
        if len(delta) < len(before) + len(after):
            lost, _, new = delta.partition("; new ")
            return _value(lost) + (f"<br>{_value(f'new {new}')}" if new else "")
        delta = ""
    between = " -> " if len(before) + len(after) <= _SHORT else "<br>-> "
    return f"{_value(before)}{between}{_value(after)}" + (f"<br>{_value(delta)}" if delta else "")


def _tail(review: Review) -> Iterator[str]:
    yield from _found("New findings", [each for each in review.new_findings if each.severity != Severity.ERROR])
    yield from folded("Resolved findings", map(_finding, review.gone_findings))
    yield from folded("Rehearsals", (as_prose(outcomes(rehearsal)) for rehearsal in review.rehearsals))
    yield from folded("Gates to repeat", (as_prose(gate_line(gate)) for gate in review.gates))
    yield from folded("Notes", map(as_prose, review.notes))


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
    return f"{found.severity} {as_code(found.code)}: {as_prose(found.message)}"


def _value(text: str | None) -> str:
    """Return a value as one piece of code; one of plain words and figures stays as it is."""
    if not text:
        return ""
    return text if all(map(_PLAIN.fullmatch, text.split(" "))) else as_code(text)


def as_prose(text: str) -> str:
    """Return a text whose plain words stay words; all others, and what it has in backticks, are code."""
    short = text if len(text) <= _LONGEST_CELL else f"{text[: _LONGEST_CELL - 3]}..."
    pieces = _CODE.split(" ".join(harmless_line(short).split()))
    shown = (as_code(piece) if number % 2 else _words(piece) for number, piece in enumerate(pieces))
    return "".join(shown)


def _words(text: str) -> str:
    return " ".join(map(_word, text.split(" ")))


def _word(text: str) -> str:
    match = _WORD.fullmatch(text)
    before, word, after = ("", text, "") if match is None else match.groups()
    return f"{before}{word if _PLAIN.fullmatch(word) else as_code(word)}{after}"


def as_code(text: str) -> str:
    """Return a text as code in a cell of a table: a bar is its entity's look-alike there, for no escape is shown."""
    short = text if len(text) <= _LONGEST_CELL else f"{text[: _LONGEST_CELL - 3]}..."
    return code(harmless_line(re.sub(r"\|", "¦", short)))
