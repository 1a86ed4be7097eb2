"""What numbers mean that a text names: error codes of interfaces, processes and controllers, by ``codes.yaml``."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from typing import Annotated

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Text
from cellc.tools.diagnose.symptoms import Pattern, read_table, small_letters

_AT_MOST = 4


class Family(CatalogModel):
    """Codes of one kind.

    Args:
        of: patterns of what must be in a text for its numbers to be of this kind.
        number: pattern whose group is a code.
        base: of the numbers as they are written.
        codes: number or word → meaning.
    """

    family: Text
    of: tuple[Pattern, ...] = Field(min_length=1)
    number: Annotated[str, Field(min_length=5, max_length=300)]
    base: int = 10
    source: Text
    codes: dict[Text, Text]

    @property
    def meanings(self) -> dict[str, str]:
        """Code as ``code_of`` writes it → meaning."""
        return {_key(code, 0): meaning for code, meaning in self.codes.items()}

    def named_in(self, small: str) -> Iterator[tuple[str, str]]:
        """Yield each code of this kind that a text in small letters names, with its meaning."""
        if not any(re.search(pattern, small) for pattern in self.of):
            return
        meanings = self.meanings
        for match in re.finditer(self.number, small):
            meaning = meanings.get(_key(match[1], self.base))
            if meaning is not None:
                yield match[1], meaning


class Codes(CatalogModel):
    """All kinds of codes."""

    families: tuple[Family, ...]


@cache
def codes() -> Codes:
    """Return the table.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return read_table("symptoms/codes.yaml", Codes)


def codes_in(text: str) -> tuple[str, ...]:
    """Return what the numbers of a text mean, one line each: ``-4``, MoveItErrorCodes: CONTROL_FAILED …."""
    small = small_letters(text)
    found = (
        f"`{code}`, {family.family}: {meaning}"
        for family in codes().families
        for code, meaning in family.named_in(small)
    )
    return tuple(dict.fromkeys(found))[:_AT_MOST]


def _key(code: str, base: int) -> str:
    try:
        return str(int(code, base))
    except ValueError:
        return code.casefold()
