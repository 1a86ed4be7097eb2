"""What is known of one spec once it was checked, for whoever tells a person."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from cellc.diagnostics.diagnostic import Diagnostic, Severity


@dataclass(frozen=True, slots=True)
class Findings:
    """The findings of all stages, sorted by place.

    Args:
        file: the spec as the user named it.
        texts: every file that was read, by the name that spans carry.
    """

    file: str
    texts: Mapping[str, str]
    diagnostics: tuple[Diagnostic, ...]

    @property
    def ok(self) -> bool:
        """Whether nothing was found that stops artifacts."""
        return all(found.severity is not Severity.ERROR for found in self.diagnostics)

    def with_more(self, found: Iterable[Diagnostic]) -> Findings:
        """Add findings of a later stage."""
        return replace(self, diagnostics=tuple(sorted((*self.diagnostics, *found), key=Diagnostic.sort_key)))
