"""From a symptom or log line to hypotheses that name the cell's own controllers, topics and frames.

Nothing that is said here acts: each hypothesis comes with the observations that can rule it out.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from cellc.cell.cell import Cell
from cellc.diagnose.subjects import FIELDS, Scope, Subject, subjects
from cellc.diagnose.symptoms import Hypothesis, LayerKnowledge, Observation, Symptom, knowledge


@dataclass(frozen=True, slots=True)
class Step:
    """One observation: a command that only reads, or something to look at; and what would rule the cause out."""

    action: str
    is_command: bool
    refuted: str


@dataclass(frozen=True, slots=True)
class Cause:
    """A hypothesis; ``omitted`` counts further subjects of the cell to which the same steps apply."""

    text: str
    steps: tuple[Step, ...]
    omitted: int


@dataclass(frozen=True, slots=True)
class Suspicion:
    """One symptom that fits.

    Args:
        layer: title of the layer.
        evidence: what the line itself names, such as ``controller arm_trajectory``.
        unknown: those of the named things that the cell does not have.
        owner: the person or team who decides, or the approval area where no cell was given.
    """

    layer: str
    symptom: str
    evidence: tuple[str, ...]
    unknown: tuple[str, ...]
    causes: tuple[Cause, ...]
    never: str
    owner: str
    source: str


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


_SHOWN_SUBJECTS = 3
# What a line may name → the scope in which the cell would have it.
_SCOPE_OF_NAMED: dict[str, Scope] = {"controller": "controller", "topic": "topic", "frame": "frame", "target": "frame"}


def diagnose(text: str, cell: Cell | None) -> tuple[Suspicion, ...]:
    """Return what a symptom or log line may mean, the best first; nothing where nothing known fits.

    Args:
        cell: whose names are filled in; without one the commands hold placeholders.
    """
    return tuple(_suspicion(match, text, cell) for match in classify(text, knowledge()))


def _suspicion(match: Match, text: str, cell: Cell | None) -> Suspicion:
    area = match.layer.owner
    owner = f"owner of the approval `{area}`" if cell is None else str(getattr(cell.owners.approvals, area))
    return Suspicion(
        layer=match.layer.title,
        symptom=match.symptom.name,
        evidence=tuple(f"{kind} `{name}`" for kind, name in match.named),
        unknown=_unknown(match, cell),
        causes=tuple(_cause(hypothesis, text, cell) for hypothesis in match.symptom.hypotheses),
        never=match.symptom.never,
        owner=owner,
        source=match.symptom.source,
    )


def _unknown(match: Match, cell: Cell | None) -> tuple[str, ...]:
    if cell is None:
        return ()
    known: dict[str, set[str]] = {"frame": {frame.name for frame in cell.frames}}
    known["controller"] = {controller.name for controller in cell.controllers}
    known["topic"] = {interface.name for interface in cell.interfaces}
    return tuple(
        f"{kind} `{name}`"
        for kind, name in match.named
        if kind in _SCOPE_OF_NAMED and name not in known[_SCOPE_OF_NAMED[kind]]
    )


def _cause(hypothesis: Hypothesis, text: str, cell: Cell | None) -> Cause:
    steps: list[Step] = []
    omitted = 0
    for observation in hypothesis.observations:
        chosen = _chosen(subjects(cell, observation.of), observation.of, text)
        steps += [_step(observation, subject) for subject in chosen[:_SHOWN_SUBJECTS]]
        omitted = max(omitted, len(chosen) - _SHOWN_SUBJECTS)
    return Cause(hypothesis.cause, tuple(dict.fromkeys(steps)), omitted)


def _chosen(found: tuple[Subject, ...], scope: Scope, text: str) -> tuple[Subject, ...]:
    """Return the subjects that the text names, all where it names none."""
    key = FIELDS[scope][0]
    named = tuple(one for one in found if re.search(rf"(?<![\w/]){re.escape(one[key])}(?![\w/])", text))
    return named or found


def _step(observation: Observation, subject: Subject) -> Step:
    action = observation.run or observation.look or ""
    return Step(action.format_map(subject), observation.run is not None, observation.refuted.format_map(subject))
