"""A value or nothing, together with what was found on the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

from cellc.diagnostics.diagnostic import Diagnostic, Severity

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Outcome(Generic[T]):
    """What a stage returns: its value where it could make one, and every diagnostic that it has to tell."""

    value: T | None
    diagnostics: tuple[Diagnostic, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the next stage may go on: there is a value and no error."""
        return self.value is not None and not any(d.severity is Severity.ERROR for d in self.diagnostics)
