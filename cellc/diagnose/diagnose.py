"""From a symptom and a cell to hypotheses that name the cell's own controllers, topics and frames."""

from __future__ import annotations

import re

from cellc.cell.cell import Cell
from cellc.diagnose.classify import Match, classify
from cellc.diagnose.diagnosis import Cause, Step, Suspicion
from cellc.diagnose.knowledge_model import Hypothesis, Observation
from cellc.diagnose.load import knowledge
from cellc.diagnose.subjects import FIELDS, Scope, Subject, subjects

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
    owner = f"owner of the approval `{area}`" if cell is None else str(getattr(cell.spec.owners.approvals, area))
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
