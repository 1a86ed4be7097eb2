"""Which findings a person asked to see."""

from __future__ import annotations

from dataclasses import dataclass

from cellc.diagnostics import Diagnostic


@dataclass(frozen=True, slots=True)
class Selection:
    """Codes to show, all where none is named, less those to leave out; leaving out wins."""

    selected: frozenset[str] = frozenset()
    ignored: frozenset[str] = frozenset()

    def shows(self, diagnostic: Diagnostic) -> bool:
        """Return whether a finding is to be shown."""
        return (not self.selected or diagnostic.code in self.selected) and diagnostic.code not in self.ignored
