"""The heading of a cause: the line of the spec with its values before and after, of several lines those of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from cellc.contract.diagnostics.wording import count
from cellc.contract.review import ReviewCause, ReviewChange, ReviewValue
from cellc.contract.vocabulary import Grade
from cellc.tools.review.headings import Deltas, Quote, is_act, parts_of, plain
from cellc.tools.review.leaves import Prose
from cellc.tools.review.units import difference

_MOST = 6
"""Values of one cause that a heading names."""
_PAIR = 2
_INTERFACES, _SUMMARY = "interfaces.", "summary"


def title_of(
    cause: ReviewCause, line: str, quote: Quote, deltas: Deltas, moves: Mapping[str, str] = MappingProxyType({})
) -> str:
    """Return the heading of a cause.

    Args:
        line: its path, or what there is room for.
        deltas: how much of several values each changed.
        moves: how far things moved, by their name.
    """
    if len(cause.values) > 1 and is_act(cause):
        first, *others = parts_of(cause, quote, moves, deltas)
        return ", ".join((f"{first} ({_places(cause.values)})", *others))
    if len(cause.values) > 1:
        return _of_several(cause, line, quote, deltas)
    where = where_of(cause.place)
    if cause.before is None or cause.after is None:
        value = cause.before or cause.after or ""
        told = f": {quote(value)}" if value and not value.endswith("...") else ""
        return f"{line} {'added' if cause.before is None else 'removed'} ({where}){told}"
    if line == _SUMMARY:
        return f"{line}: other words ({where})"
    delta = deltas.get(plain(cause.before, cause.after))
    return f"{line}: {quote(cause.before)} -> {quote(cause.after)}{f' ({delta})' if delta else ''} ({where})"


WHOLE_SPEC = "spec"
"""Line of a cause whose lines have nothing in common."""


def leading_first(cause: ReviewCause, changes: Sequence[ReviewChange]) -> ReviewCause:
    """Return a cause with the values first that dangerous changes have, in the order of those."""
    if len(cause.values) < _PAIR or cause.line == WHOLE_SPEC or is_act(cause):
        return cause
    worst = [plain(change.before, change.after) for change in changes if change.grade is Grade.DANGEROUS]

    def place(value: ReviewValue) -> int:
        pair = plain(value.before, value.after)
        return worst.index(pair) if pair in worst else len(worst)

    return cause.model_copy(update={"values": tuple(sorted(cause.values, key=place))})


def shortest_of(cause: ReviewCause, width: int, deltas: Deltas, moves: Mapping[str, str]) -> str:
    """Return the first of several values, whole, with how many more there are; empty where there is no room for it.

    The path gives way before its values do.
    """
    if is_act(cause):
        return _first_parts(parts_of(cause, str, moves, deltas), width)
    first, others = cause.values[0], len(cause.values) - 1
    sized = _sized(first, deltas)
    parts = [*([] if cause.line == WHOLE_SPEC else cause.line.split(".")), *first.line.split(".")]
    paths = [".".join(parts), *("..." + ".".join(parts[at:]) for at in range(1, len(parts)))]
    lines = (f"{path}{_change(first, str)}{size} and {others} more" for size in (sized, "") for path in paths)
    return next((line for line in lines if len(line) <= width), "")


def _first_parts(parts: Sequence[str], width: int) -> str:
    """Return as many parts of an act as there is room for, with how many more there are."""
    path, _, rest = parts[0].removeprefix("frames.").partition(" ")
    for kept in range(len(parts), 0, -1):
        more = f" and {len(parts) - kept} more" if kept < len(parts) else ""
        for head in (path, *(f"...{path[at:]}" for at, letter in enumerate(path) if letter == "." and at)):
            line = ", ".join((f"{head} {rest}", *parts[1:kept])) + more
            if len(line) <= width:
                return line
    return ""


def _sized(value: ReviewValue, deltas: Deltas) -> str:
    delta = deltas.get(plain(value.before, value.after)) or _share(value)
    return f" ({delta})" if delta else ""


def _share(value: ReviewValue) -> str:
    """Return the share by which a quantity changed, where no change under the heading has its two values."""
    if value.before is None or value.after is None:
        return ""
    share = difference(Prose(value.before), Prose(value.after), "")
    return share if share.endswith("%") else ""


def _of_several(cause: ReviewCause, line: str, quote: Quote, deltas: Deltas) -> str:
    values, where = cause.values, _places(cause.values)
    if line == WHOLE_SPEC and len({(value.before, value.after) for value in values}) == 1 and len(values) <= _MOST:
        sized = _sized(values[0], deltas)
        return f"{', '.join(value.line for value in values)}{_change(values[0], quote)}{sized} ({where})"
    if line == WHOLE_SPEC:
        leading = f"{values[0].line}{_change(values[0], quote)} ({where_of(values[0].place)})"
        return f"{leading} and {count(len(values) - 1, 'line')} ({_places(values[1:])})"
    paths = [value.line.split(".") for value in values]
    names = [path[0] for path in paths]
    ends = {tuple(path[1:]) for path in paths}
    same = len({(value.before, value.after) for value in values}) == 1
    if line.startswith(_INTERFACES) and same and len({path[-1] for path in paths}) == 1:
        return f"{line}.{paths[0][-1]} of both ends{_change(values[0], quote)} ({where})"
    if len(ends) == 1 and len(values) <= _MOST and all(len(path) > 1 for path in paths):
        whole = ".".join((line, "{" + ",".join(names) + "}", *paths[0][1:]))
        first = values[0]
        if all((value.before, value.after) == (first.before, first.after) for value in values):
            return f"{whole}{_change(first, quote, shortened=True)}{_sized(first, deltas)} ({where})"
        if _are_exchanged(values):
            told = ", ".join(f"{name}{_change(value, quote)}" for name, value in zip(names, values, strict=True))
            return f"{whole} exchanged: {told.replace(':', '')} ({where})"
    told = ", ".join(
        value.line + _change(value, quote).removeprefix(":") + _sized(value, deltas) for value in values[:_MOST]
    )
    more = f" and {len(values) - _MOST} more" if len(values) > _MOST else ""
    return f"{line} ({where}): {told}{more}"


def _are_exchanged(values: Sequence[ReviewValue]) -> bool:
    """Tell whether two lines have each what the other had."""
    if len(values) != _PAIR:
        return False
    one, other = values
    return None not in (one.before, one.after) and (one.before, one.after) == (other.after, other.before)


def _change(value: ReviewValue, quote: Quote, *, shortened: bool = False) -> str:
    before, after = value.before, value.after
    if before is None or after is None:
        return " added" if before is None else " removed"
    named, version = before.split(), after.split()
    if shortened and len(named) == len(version) == _PAIR and named[0] == version[0] and named[0].isidentifier():
        after = version[1]  # a version of the same package
    return f": {quote(before)} -> {quote(after)}"


def _places(values: Sequence[ReviewValue]) -> str:
    """Return the file and the lines of values; of those in several files, the first."""
    split = [where_of(value.place).rpartition(":") for value in values]
    lines = [line for file, _, line in split if file == split[0][0]]
    return f"{split[0][0]}:{', '.join(dict.fromkeys(lines[:_MOST]))}"


def where_of(place: str) -> str:
    """Return the name of a file and a line in it."""
    file, _, rest = place.replace("\\", "/").rpartition("/")[2].partition(":")
    return f"{file}:{rest.partition(':')[0]}" if rest else file
