"""What a text states beside its symptom, such as that ping works: each statement rules something out.

The table is ``catalog/symptoms/evidence.yaml``. A question that the text answers is not asked, an observation whose
outcome it states is left out, and so is a cause that it excludes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from cellc.tools.diagnose.symptoms import Evidence, Topic, evidence

_STRONGER, _WEAKER = 1.5, 0.5
"""By what the points of a symptom are multiplied that a statement speaks for, or against."""


@dataclass(frozen=True, slots=True)
class Stated:
    """The statements of a text."""

    rows: tuple[Evidence, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """What is stated, in words."""
        return tuple(row.stated for row in self.rows)

    def answers(self, question: str) -> bool:
        """Tell that a question is answered already."""
        return _has_any(question, (text for row in self.rows for text in row.answers))

    def has_seen(self, observation: str) -> bool:
        """Tell that the outcome of an observation is stated, or that it is of something that is not there."""
        return _has_any(observation, (text for row in self.rows for text in row.leaves_out))

    def rules_out(self, cause: str) -> bool:
        """Tell that a cause is excluded."""
        return _has_any(cause, (text for row in self.rows for text in row.rules_out))

    def speaks_for(self, cause: str) -> bool:
        """Tell that a cause is likelier than others of its symptom."""
        return _has_any(cause, (text for row in self.rows for text in row.likelier))

    def factor(self, symptom: str, layer: Topic) -> float:
        """Return by what the points of a symptom are multiplied."""
        factor = _WEAKER if any(layer in row.clears for row in self.rows) else 1.0
        for row in self.rows:
            factor *= _STRONGER if symptom in row.strengthens else _WEAKER if symptom in row.weakens else 1.0
        return factor


def stated(text: str) -> Stated:
    """Return what a text states."""
    small = " ".join(text.casefold().replace("’", "'").split())
    return Stated(tuple(row for row, says, unless in _table() if says.search(small) and not unless.search(small)))


@cache
def _table() -> tuple[tuple[Evidence, re.Pattern[str], re.Pattern[str]], ...]:
    return tuple((row, _any_of(row.says), _any_of(row.unless or ("(?!)",))) for row in evidence().evidence)


def _any_of(patterns: Iterable[str]) -> re.Pattern[str]:
    return re.compile("|".join(f"(?:{pattern})" for pattern in patterns))


def _has_any(text: str, pieces: Iterable[str]) -> bool:
    return any(piece in text for piece in pieces)
