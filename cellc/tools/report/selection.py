"""Which findings a person asked to see, and what the names in that wish stand for."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cellc.contract.code_page import meant_code
from cellc.contract.diagnostics import Diagnostic
from cellc.contract.errors import CellcError


@dataclass(frozen=True, slots=True)
class Selection:
    """Codes to show, all where none is named, less those to leave out; leaving out wins."""

    selected: frozenset[str] = frozenset()
    ignored: frozenset[str] = frozenset()

    def shows(self, diagnostic: Diagnostic) -> bool:
        """Return whether a finding is to be shown."""
        return (not self.selected or diagnostic.code in self.selected) and diagnostic.code not in self.ignored


class UnknownSelectionError(CellcError, ValueError):
    """A name is neither a code nor a family; the message says which are near."""


def selection(select: Iterable[str], ignore: Iterable[str]) -> Selection:
    """Return the selection that codes and families stand for.

    Raises:
        UnknownSelectionError: a name is neither.
    """
    names, without = tuple(select), tuple(ignore)
    return Selection(_codes(names), _codes(without)) if names or without else Selection()


def _codes(names: tuple[str, ...]) -> frozenset[str]:
    # A command that leaves nothing out does not collect the codes of all stages.
    from cellc.compiler.pages import all_codes, codes_by_family

    families, every = codes_by_family(), all_codes()
    codes: set[str] = set()
    for name in names:
        if name not in families and name not in every:
            known = meant_code(name, [*families, *every], "families")
            raise UnknownSelectionError(f"there is no code or family `{name}`: {known}")
        codes |= families.get(name, frozenset({name}))
    return frozenset(codes)
