"""Whether a line below a heading says again, of the same thing, what the heading says."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from cellc.contract.review import ReviewCause, ReviewChange
from cellc.tools.review.change import PRESENT
from cellc.tools.review.compare import WHOLE
from cellc.tools.review.groups import NAME_OF, Group
from cellc.tools.review.headings import plain

_SAYS = {"true": "yes", "false": "no"}
"""How a change says what a spec does."""
_SIZE = re.compile(r"[-+][\d.]+ \S+")
"""A difference that the two values of a heading say, such as a share."""
_ADDED, _REMOVED = " added", " removed"


def restated(changes: Sequence[ReviewChange], group: Group, title: str) -> Sequence[ReviewChange]:
    """Return the changes that only say again what a heading, or a figure right below it, says.

    Args:
        title: the heading as it is printed.
    """
    if group.cause is None or group.cause.renamed:
        return ()
    cause, said = group.cause, _text(title)
    again = [
        change
        for change in changes
        if not change.breaking and not change.quantity.startswith(NAME_OF) and _is_in(change, said)
    ]
    is_only = len(again) == 1 and len(again[0].subjects) == 1
    return [
        change
        for change in changes
        if (change in again and (is_only or _is_of(change, cause))) or _is_figure(change, group)
    ]


def _is_in(change: ReviewChange, said: str) -> bool:
    """Tell whether a heading has both values of a change, or that of what comes or goes; a digest of lists is more."""
    if change.delta and _SIZE.fullmatch(change.delta) is None:
        return False
    before, after = change.before, change.after
    if before is None or after is None:
        is_whole = (_ADDED if before is None else _REMOVED) in said
        value = after or before or ""
        return is_whole and (value == PRESENT or _has(said, _text(value)))
    version = after.split()[-1]
    return any(_has(said, _text(f"{before} -> {now}")) for now in (after, version))


def _is_figure(change: ReviewChange, group: Group) -> bool:
    """Tell whether a figure below the heading says how far each of its subjects moved."""
    told = {f"{subject} {change.delta}" for subject in change.subjects}
    return bool(change.delta) and not change.breaking and told <= {*group.figures}


def _is_of(change: ReviewChange, cause: ReviewCause) -> bool:
    """Tell whether the path of a heading names each subject of a change, or the device that it is a part of."""
    names = [name for name in _names(cause) if name]
    return all(
        subject == WHOLE
        or any(f"{word.strip('/')}_".startswith(f"{name}_") for word in re.split("[ :,]", subject) for name in names)
        for subject in change.subjects
    )


def _names(cause: ReviewCause) -> Iterator[str]:
    for line in (cause.line, *(value.line for value in cause.values)):
        yield from re.split("[./]", line)


def _text(text: str) -> str:
    """Return a text with numbers, lists, words and names in one spelling."""
    (spelled,) = plain(re.sub(r"[\[\]{}`]", "", text))
    words = " ".join(str(spelled).split()).split(" ")
    return " ".join(_SAYS.get(word, word.replace("/", "_")) for word in words)


def _has(said: str, text: str) -> bool:
    return bool(text) and re.search(rf"(?<![\w.-]){re.escape(text)}(?![\w.])", said) is not None
