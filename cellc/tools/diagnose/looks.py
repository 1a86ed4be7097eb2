"""What is looked at first, by the parts that a text names and the kind of trouble that it states.

The table is ``catalog/symptoms/looks.yaml``: not symptoms, but for each part of a cell how it fails, with the one
observation that tells. So it has a cause for what no person has reported yet.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Annotated

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Text, Token
from cellc.tools.diagnose.fields import Scope
from cellc.tools.diagnose.symptoms import Action, read_table, small_letters

_AT_MOST, _OF_ONE_PART = 4, 3
_OF_PART, _MOST_NAMED = 1.5, 3.0
_OF_KIND, _OF_WORD, _MOST_SPOKEN, _OF_GENERAL = 1.5, 2.5, 8.0, 4.0
"""Points of a word that one part alone has, of the kind of trouble, and of a word for one cause alone."""
_LEAST = 4.0
"""Points of a cause: less says nothing of it, as one word of a part and the kind alone."""

_Regex = Annotated[str, Field(min_length=2, max_length=900)]


class Look(Action):
    """A cause, and the observation that tells whether it is there.

    Args:
        kinds: kinds of trouble that it leads to; every kind where empty.
        when: patterns of words that speak for it.
    """

    of: Scope = "cell"
    cause: Text
    kinds: tuple[Token, ...] = ()
    when: tuple[_Regex, ...] = ()


class Part(CatalogModel):
    """A part of a cell, the words that name it, and how it fails."""

    part: Text
    says: tuple[_Regex, ...] = Field(min_length=1)
    source: Text
    looks: tuple[Look, ...] = Field(min_length=2)


class Looks(CatalogModel):
    """Kinds of trouble with the words of each, all parts, and causes of no part."""

    kinds: dict[Token, tuple[_Regex, ...]]
    parts: tuple[Part, ...]
    general: tuple[Look, ...]


@dataclass(frozen=True, slots=True)
class Chosen:
    """A cause that comes first, with its part; ``part`` is None for a cause of no part."""

    look: Look
    part: Part | None
    points: float


@cache
def looks() -> Looks:
    """Return the table.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return read_table("symptoms/looks.yaml", Looks)


def kinds_of(text: str) -> frozenset[str]:
    """Return the kinds of trouble that a text states."""
    small = small_letters(text)
    return frozenset(kind for kind, patterns in looks().kinds.items() if _words(patterns, small))


def first_looks(text: str) -> tuple[Chosen, ...]:
    """Return up to four causes, the likeliest first: by what the text names, not by what it is like."""
    small, kinds = small_letters(text), kinds_of(text)
    found = sorted(_weighed(small, kinds), key=lambda each: -each.points)
    chosen: list[Chosen] = []
    for each in found:
        same = [other for other in chosen if other.part == each.part]
        seen = each.look.action in {other.look.action for other in chosen}
        if len(same) < _OF_ONE_PART and not seen and len(chosen) < _AT_MOST:
            chosen.append(each)
    return tuple(chosen)


def _weighed(small: str, kinds: Collection[str]) -> Iterator[Chosen]:
    for part in looks().parts:
        named = min(_MOST_NAMED, sum(_OF_PART * _rarity(word, True) for word in _words(part.says, small)))
        for look in part.looks if named else ():
            is_kind = not kinds or not look.kinds or bool(set(kinds) & set(look.kinds))
            spoken = _spoken(look, small)
            points = named + _OF_KIND * is_kind + spoken
            if points >= _LEAST and (spoken >= _OF_WORD or (is_kind and (spoken or kinds))):
                yield Chosen(look, part, points)
    for look in looks().general:
        if spoken := _spoken(look, small):
            yield Chosen(look, None, _OF_GENERAL + spoken)


def _spoken(look: Look, small: str) -> float:
    return min(_MOST_SPOKEN, sum(_OF_WORD * _rarity(word, False) for word in _words(look.when, small)))


def _words(patterns: Collection[str], small: str) -> frozenset[str]:
    """Return the different words of a text that patterns find."""
    return frozenset(match[0].strip() for pattern in patterns for match in _compiled(pattern).finditer(small))


@lru_cache(maxsize=4096)
def _rarity(word: str, of_parts: bool) -> float:
    """Return how much a word says: 1 where it speaks for one part or cause alone, less where it does for many."""
    table = looks()
    if of_parts:
        of = [part.says for part in table.parts]
    else:
        of = [look.when for look in (*(look for part in table.parts for look in part.looks), *table.general)]
    number = sum(1 for patterns in of if any(_compiled(pattern).search(word) for pattern in patterns))
    return 1.0 / (1.0 + math.log2(max(1, number)))


@cache
def _compiled(pattern: str) -> re.Pattern[str]:
    """Return a pattern on whole words, their plurals too; an underscore ends a word."""
    return re.compile(rf"(?:(?<![^\W_])|(?!\w))(?:{pattern})(?:e?s)?(?:(?![^\W_])|(?<!\w))")
