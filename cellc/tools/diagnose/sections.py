"""Parts of a cell in which a fault may be, and how each is narrowed down where no known symptom fits well.

The table is ``catalog/symptoms/sections.yaml``. What a log names (program, logger, error) says more of the part than
the words around it; where neither says anything, the part is that of the first proposal's layer.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Text
from cellc.tools.diagnose.symptoms import Action, Pattern, Topic, read_table

_OF_ORIGIN, _OF_WORDS, _OF_LAYER = 3, 1, 1
"""Points of a thing that a log names, of a word, and of the layer of the first proposal."""
_MOST = 3
"""More things or words of one kind say nothing more."""


class Bisection(Action):
    """An action that halves what is left, with what either outcome says."""

    good: Text
    bad: Text

    @property
    def read(self) -> tuple[str, ...]:
        """What outcomes say."""
        return self.good, self.bad


class Section(CatalogModel):
    """A part of a cell.

    Args:
        layers: of the symptoms that it may have, its own the first.
        origins: patterns of what logs and devices name.
        says: patterns of words of users.
        ask: the first of ``steps`` as a question.
    """

    name: Text
    layers: tuple[Topic, ...] = Field(min_length=1)
    origins: tuple[Pattern, ...] = Field(min_length=1)
    says: tuple[Pattern, ...] = Field(min_length=1)
    ask: Text
    source: Text
    steps: tuple[Bisection, ...] = Field(min_length=3, max_length=4)


class Contrast(CatalogModel):
    """What is compared where a text states that something works.

    Args:
        stated: statements of ``evidence.yaml``.
    """

    name: Text
    stated: tuple[Text, ...] = Field(min_length=1)
    source: Text
    steps: tuple[Bisection, ...] = Field(min_length=1, max_length=3)


class Blind(CatalogModel):
    """What a command cannot tell.

    Args:
        command: as an observation begins.
        of: pattern of the causes that its outcome does not exclude.
    """

    command: Text
    of: Annotated[str, Field(min_length=1, max_length=300)]
    says: Text


class Sections(CatalogModel):
    """All parts of a cell, what is compared, and what commands cannot tell."""

    sections: tuple[Section, ...]
    contrasts: tuple[Contrast, ...]
    blind: tuple[Blind, ...]


@dataclass(frozen=True, slots=True)
class Placed:
    """The part of a cell that a text is of; ``is_named``: by what a log or a device names, and not by words alone."""

    section: Section
    is_named: bool


@cache
def sections() -> Sections:
    """Return the table.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return read_table("symptoms/sections.yaml", Sections)


def placed(text: str, layers: Sequence[Topic] = ()) -> Placed | None:
    """Return the part of a cell that a text is of; None where nothing tells it.

    Args:
        layers: of the proposals, the best first.
    """
    small = " ".join(text.casefold().replace("’", "'").split())
    best: tuple[float, Placed] | None = None
    for section, origins, says in _patterns():
        named = min(_MOST, sum(1 for pattern in origins if pattern.search(small)))
        points = float(_OF_ORIGIN * named + _OF_WORDS * min(_MOST, sum(1 for each in says if each.search(small))))
        points += _OF_LAYER * (section.layers[0] in layers[:1]) + _OF_LAYER / 2 * any(
            layer in section.layers for layer in layers[:1]
        )
        if points and (best is None or points > best[0]):
            best = (points, Placed(section, named > 0))
    return None if best is None else best[1]


def contrasts(stated: Sequence[str]) -> tuple[Contrast, ...]:
    """Return what is compared, by the statements of a text."""
    return tuple(each for each in sections().contrasts if set(each.stated) & set(stated))


def blind_to(action: str, cause: str) -> str:
    """Return why the outcome of a command does not exclude a cause; empty where it does."""
    rows = (row for row in sections().blind if action.startswith(row.command) and re.search(row.of, cause))
    return next((row.says for row in rows), "")


_Compiled = tuple[Section, tuple[re.Pattern[str], ...], tuple[re.Pattern[str], ...]]


@cache
def _patterns() -> tuple[_Compiled, ...]:
    return tuple(
        (each, tuple(map(re.compile, each.origins)), tuple(map(re.compile, each.says))) for each in sections().sections
    )
