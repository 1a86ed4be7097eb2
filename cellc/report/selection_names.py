"""What the names in a selection stand for."""

from __future__ import annotations

from collections.abc import Iterable

from cellc.diagnostics import did_you_mean
from cellc.report.families import codes_by_family
from cellc.report.pages import all_pages
from cellc.report.selection import Selection


class UnknownSelectionError(ValueError):
    """A name is neither a code nor a family; the message says which are near."""


def selection(select: Iterable[str], ignore: Iterable[str]) -> Selection:
    """Return the selection that codes and families stand for.

    Raises:
        UnknownSelectionError: a name is neither.
    """
    names, without = tuple(select), tuple(ignore)
    return Selection(_codes(names), _codes(without)) if names or without else Selection()


def _codes(names: tuple[str, ...]) -> frozenset[str]:
    families, pages = codes_by_family(), all_pages()
    codes: set[str] = set()
    for name in names:
        if name not in families and name not in pages:
            known = did_you_mean(name, [*families, *pages], "families")
            raise UnknownSelectionError(f"there is no code or family `{name}`: {known}")
        codes |= families.get(name, frozenset({name}))
    return frozenset(codes)
