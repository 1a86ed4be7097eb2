"""Which known symptoms a text fits: log lines by their pattern, people's words by their beginnings."""

from __future__ import annotations

import re
from dataclasses import dataclass

from cellc.diagnose.knowledge_model import LayerKnowledge, Symptom

# A recognised log line says more than any choice of words.
_LOG_LINE = 100
_AT_MOST = 3


@dataclass(frozen=True, slots=True)
class Match:
    """A symptom that fits, and what the line names: (kind, name)."""

    layer: LayerKnowledge
    symptom: Symptom
    named: tuple[tuple[str, str], ...]


def classify(text: str, layers: tuple[LayerKnowledge, ...]) -> tuple[Match, ...]:
    """Return up to three symptoms, the best first; layers that are ruled out first win ties.

    Args:
        text: a symptom in words, or one or more log lines.
    """
    found: list[tuple[int, Match]] = []
    words = re.findall(r"[\w-]+", text.lower())
    for layer in layers:
        for symptom in layer.symptoms:
            named = _logged(symptom, text)
            score = _said(symptom, words) if named is None else _LOG_LINE
            if score:
                found.append((score, Match(layer, symptom, named or ())))
    best = max((score for score, _ in found), default=0)
    # Next to a recognised log line, words that happen to fit would only distract.
    kept = [entry for entry in found if best < _LOG_LINE or entry[0] >= _LOG_LINE]
    return tuple(match for _, match in sorted(kept, key=lambda entry: -entry[0])[:_AT_MOST])


def _logged(symptom: Symptom, text: str) -> tuple[tuple[str, str], ...] | None:
    matches = [match for pattern in symptom.logged if (match := re.search(pattern, text))]
    if not matches:
        return None
    return tuple(dict.fromkeys((kind, name) for match in matches for kind, name in match.groupdict().items() if name))


def _said(symptom: Symptom, words: list[str]) -> int:
    """Return the length of the longest list whose words all begin a word of the text."""
    fitting = (
        len(beginnings)
        for beginnings in symptom.said
        if all(any(word.startswith(beginning) for word in words) for beginning in beginnings)
    )
    return max(fitting, default=0)
