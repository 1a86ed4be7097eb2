"""Files that are text alone: which of their lines differ, and which of those no listed change explains."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from cellc.tools.review.tokens import holder, ordered, parts

_MOST_PAIRS = 250_000
"""Pairs of lines that are compared for the nearest; of a file with more, lines are taken in their order."""

_Words = tuple[str, ...]
"""A line by its words, with figures in their order behind the word before them."""


@dataclass(frozen=True, slots=True)
class Known:
    """What the reported changes explain in other files.

    Attributes:
        words: words and figures of values before and after.
        names: names of things that were added or removed: a line that holds one follows from it.
        differing: words of those values that one side alone has: a line that was added or removed with one follows,
            too.
    """

    words: frozenset[str]
    names: frozenset[str]
    differing: frozenset[str]

    def explains(self, before: Sequence[str], after: Sequence[str], common: frozenset[str] = frozenset()) -> bool:
        """Tell whether a text changed in nothing but what is known, or names what was added or removed.

        Args:
            common: words that both sides of a file have, which say nothing of a line without a counterpart.
        """
        differing = _differing(before, after)
        if before and after:
            return differing <= self.words or not self.names.isdisjoint(_with_parts(differing))
        named = self.names | self.differing
        return differing - common <= self.words or not named.isdisjoint(_with_parts(differing))


def _differing(before: Sequence[str], after: Sequence[str]) -> set[str]:
    """Return the words that one side alone has; where both have the same, those in another place."""
    gone, come = Counter(before), Counter(after)
    if gone == come:
        return {word for was, now in zip(before, after, strict=True) if was != now for word in (was, now)}
    return {*(gone - come), *(come - gone)}


def _with_parts(words: Iterable[str]) -> set[str]:
    """Return words with the names that they are made of, such as those of a path."""
    return {part for word in words for part in (word, *re.split("[/.]", word))}


_GOES_ON = " \\"
"""How a command ends that a shell reads on in the next line."""


@dataclass(frozen=True, slots=True)
class LinesLeft:
    """Lines of one file that differ and that nothing explains; ``whole`` where the file itself was added or removed."""

    file: str
    before: tuple[str, ...]
    after: tuple[str, ...]
    whole: Literal["", "added", "removed"] = ""


def lines_left(
    before: Mapping[str, Sequence[str]], after: Mapping[str, Sequence[str]], known: Known
) -> list[LinesLeft]:
    """Return what is left of each file; the order of lines and of words in them says nothing, that of figures does."""
    remaining = (_left(file, before.get(file, ()), after.get(file, ()), known) for file in sorted({*before, *after}))
    return [left for left in remaining if left.before or left.after]


def _left(file: str, before: Sequence[str], after: Sequence[str], known: Known) -> LinesLeft:
    if not before or not after:
        none = LinesLeft(file, (), ())
        return (
            none if before == after else LinesLeft(file, tuple(before), tuple(after), "removed" if before else "added")
        )
    if Counter(before) == Counter(after):
        return LinesLeft(file, (), ())
    old, new = _by_words(_whole(before)), _by_words(_whole(after))
    gone, come = _more(old, new), _more(new, old)
    left_before, left_after = [], []
    common = frozenset(_plain(word for line in old for word in line))
    common &= frozenset(_plain(word for line in new for word in line))
    for before_words, other in _paired(gone, come):
        is_explained = known.explains(_plain(before_words), _plain(other), common)
        if not is_explained or not _moved(before_words, other) <= known.words:
            left_before += [old[before_words][0]] if before_words else []
            left_after += [new[other][0]] if other else []
    return LinesLeft(file, tuple(left_before), tuple(left_after))


def _whole(lines: Sequence[str]) -> list[str]:
    """Return lines with commands that go on in the next line as one: where they break depends on lengths of names."""
    whole: list[str] = []
    goes_on = False
    for line in lines:
        if goes_on:
            whole[-1] = f"{whole[-1].removesuffix(_GOES_ON)} {line.strip()}"
        else:
            whole.append(line)
        goes_on = line.endswith(_GOES_ON)
    return whole


def _by_words(lines: Sequence[str]) -> dict[_Words, list[str]]:
    by_words: dict[_Words, list[str]] = {}
    for line in lines:
        by_words.setdefault(ordered(line), []).append(line)
    return by_words


def _more(one: Mapping[_Words, list[str]], other: Mapping[_Words, list[str]]) -> list[_Words]:
    return [key for key, lines in one.items() for _ in range(len(lines) - len(other.get(key, ())))]


def _plain(words: Iterable[str]) -> list[str]:
    return sorted(part for word in words for part in parts(word))


def _moved(before: _Words, after: _Words) -> set[str]:
    """Return the figures behind a word that are others on the two sides, place by place."""
    gone, come = _held(before, after), _held(after, before)
    return {word for name in gone.keys() & come.keys() for word in _differing(gone[name], come[name])}


def _held(words: _Words, other: _Words) -> dict[str, list[str]]:
    """Return the figures of one side alone, by the word before them."""
    held: dict[str, list[str]] = {}
    for word in words:
        name = holder(word)
        if name is not None and word not in other:
            held.setdefault(name, []).extend(parts(word))
    return held


def _paired(gone: list[_Words], come: list[_Words]) -> list[tuple[_Words, _Words]]:
    """Pair each removed line with the nearest added line; a line without a partner gets an empty one."""
    if len(gone) * len(come) > _MOST_PAIRS:
        return [*((pair, ()) for pair in gone), *(((), pair) for pair in come)]
    waiting = [Counter(_plain(pair)) for pair in come]
    rest = list(range(len(come)))
    pairs: list[tuple[_Words, _Words]] = []
    for pair in gone:
        counted = Counter(_plain(pair))
        nearest = max(rest, key=lambda at: sum((counted & waiting[at]).values()), default=None)
        if nearest is None or 4 * sum((counted & waiting[nearest]).values()) <= 3 * counted.total():
            pairs.append((pair, ()))
            continue
        rest.remove(nearest)
        pairs.append((pair, come[nearest]))
    return pairs + [((), come[at]) for at in rest]
