"""From a symptom or log line to hypotheses that name the cell's own controllers, topics and frames.

Nothing that is said here acts: each hypothesis comes with the observations that can rule it out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from string import Formatter
from typing import TYPE_CHECKING

from cellc.compiler.formats.escape import shell_word
from cellc.tools.diagnose.classify import Match, classify
from cellc.tools.diagnose.evidence import Stated, stated
from cellc.tools.diagnose.fields import FIELDS, NOT_STATED, Scope, Subject, placeholders
from cellc.tools.diagnose.naming import loggers, names_of
from cellc.tools.diagnose.symptoms import Hypothesis, Observation, knowledge, questions

if TYPE_CHECKING:
    from cellc.compiler.cell.cell import Cell


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


@dataclass(frozen=True, slots=True)
class Answer:
    """What a text may mean.

    Attributes:
        suspicions: the best first.
        ask: the one question that decides between layers, with what either answer speaks for; empty where the layer of
            the first suspicion is certain.
        likely: the layer of the first suspicion is far ahead of all others, though not certain.
        fits: False where the suspicions are merely the nearest.
        stated: what the text says beside the symptom and was counted with.
    """

    suspicions: tuple[Suspicion, ...]
    ask: str = ""
    yes: tuple[str, ...] = ()
    no: tuple[str, ...] = ()
    likely: bool = False
    fits: bool = True
    stated: tuple[str, ...] = ()


_ELSE = "no other layer has any of these words; add what was done before, or a line of the log"
_SHOWN_SUBJECTS = 3
_OF_NETWORK = re.compile(r"\bping\b|\bip route\b|\bsubnet\b|\bnetwork\b")
# What a line may name → the scope in which the cell would have it.
_SCOPE_OF_NAMED: dict[str, Scope] = {"controller": "controller", "topic": "topic", "frame": "frame", "target": "frame"}


def diagnose(text: str, cell: Cell | None) -> Answer:
    """Return what a symptom or log line may mean, and how sure that is.

    Args:
        cell: whose names are filled in, and whose drivers decide which symptoms count; without one the commands hold
            placeholders.
    """
    classified = classify(text, knowledge(), _drivers(cell))
    suspicions = tuple(suspicion_of(match, text, cell) for match in classified.matches)
    question, said = classified.question, stated(text).names
    if question is not None:
        no = _meant(question.no) or (_ELSE,)
        return Answer(suspicions, question.ask, _meant(question.yes), no, question.confirms, stated=said)
    if classified.fits:
        return Answer(suspicions, stated=said)
    asked = questions().narrowing
    titles = {layer.layer: layer.title for layer in knowledge()}
    yes, no = (tuple(titles[layer] for layer in layers) for layers in (asked.yes, asked.no))
    return Answer(suspicions, asked.ask, yes, no, fits=False, stated=said)


def _meant(matches: Sequence[Match]) -> tuple[str, ...]:
    return tuple(f"{match.layer.title}: {match.symptom.name}" for match in matches)


def _drivers(cell: Cell | None) -> Collection[str] | None:
    return None if cell is None else {device.software.packages.driver or "" for device in cell.devices}


def suspicion_of(match: Match, text: str, cell: Cell | None) -> Suspicion:
    """Return what a symptom that fits may mean in a cell."""
    area = match.layer.owner
    owner = f"owner of the approval `{area}`" if cell is None else str(getattr(cell.owners.approvals, area))
    facts = stated(text)
    causes = [_cause(hypothesis, text, cell, facts) for hypothesis in _open(match.symptom.hypotheses, facts)]
    return Suspicion(
        layer=match.layer.title,
        symptom=match.symptom.name,
        evidence=tuple(f"{kind} `{name}`" for kind, name in match.named),
        unknown=_unknown(match, cell),
        causes=tuple(sorted(causes, key=lambda cause: not cause.steps)),  # what the cell has comes first
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


def _open(hypotheses: Sequence[Hypothesis], facts: Stated) -> list[Hypothesis]:
    """Return the hypotheses that what is stated leaves, those first that it speaks for."""
    left = [each for each in hypotheses if not facts.rules_out(each.cause)] or list(hypotheses)
    return sorted(left, key=lambda each: not facts.speaks_for(each.cause))


def _cause(hypothesis: Hypothesis, text: str, cell: Cell | None, facts: Stated) -> Cause:
    steps: list[Step] = []
    omitted = 0
    for observation in hypothesis.observations:
        if facts.has_seen(" ".join((observation.run or observation.look or "", observation.refuted))):
            continue
        chosen = [each for each in _chosen(cell, observation.of, text) if _is_fit(observation, each)]
        steps += [_step(observation, subject, cell is not None) for subject in chosen[:_SHOWN_SUBJECTS]]
        omitted = max(omitted, len(chosen) - _SHOWN_SUBJECTS)
    return Cause(hypothesis.cause, tuple(dict.fromkeys(steps)), omitted)


def _subjects(cell: Cell | None, scope: Scope) -> tuple[Subject, ...]:
    if cell is None:
        return (placeholders(scope),)
    from cellc.tools.diagnose.subjects import subjects

    return subjects(cell, scope)


def _chosen(cell: Cell | None, scope: Scope, text: str) -> tuple[Subject, ...]:
    """Return the subjects that the text names, all where it names none."""
    found = _subjects(cell, scope)
    own = names_of(text, scope)
    if cell is None:
        return ({**found[0], **own},)
    key = FIELDS[scope][0]
    spoken = " ".join((text, *loggers(text)))
    named = tuple(mapping for mapping in found if re.search(rf"(?<![\w/]){re.escape(mapping[key])}(?![\w/])", spoken))
    if not named and key in own:
        return ({**placeholders(scope), **own},)
    return named or found


def _is_fit(observation: Observation, subject: Subject) -> bool:
    """Tell that a subject has every value that an observation speaks of, and an address of the right kind."""
    text = " ".join((observation.run or observation.look or "", observation.refuted))
    used = {name for _, name, _, _ in Formatter().parse(text) if name}
    if any(subject[name] == NOT_STATED for name in used):
        return False
    address = subject["address"] if "address" in used else ""
    if address.startswith("/dev/"):
        return not _OF_NETWORK.search(text)
    return not address or address.startswith("<") or "/dev/" not in text


def _step(observation: Observation, subject: Subject, of_cell: bool) -> Step:
    action = observation.run or observation.look or ""
    # A command is there to be copied: what a name of the spec holds is one word of it.
    words = {name: shell_word(value) if value else "" for name, value in subject.items()}
    action = action.format_map(words if observation.run and of_cell else subject)
    return Step(action, observation.run is not None, observation.refuted.format_map(subject))
