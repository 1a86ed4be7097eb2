"""From a symptom or log line to hypotheses that name the cell's own controllers, topics and frames.

Nothing that is said here acts: each hypothesis comes with the observations that can rule it out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import islice
from typing import TYPE_CHECKING

from cellc.compiler.formats.escape import shell_word
from cellc.tools.diagnose.fields import FIELDS, Scope, Subject, placeholders
from cellc.tools.diagnose.log_lines import Named, fixed_begin, found_in, length, plain
from cellc.tools.diagnose.symptoms import Hypothesis, LayerKnowledge, Observation, Symptom, knowledge, synonyms
from cellc.tools.diagnose.words import Words

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


_AT_MOST = 3


@dataclass(frozen=True, slots=True)
class Match:
    """A symptom that fits, what the line names, (kind, name), and the text of a source that it has."""

    layer: LayerKnowledge
    symptom: Symptom
    named: Named = ()
    template: str = ""


def classify(text: str, layers: Sequence[LayerKnowledge], drivers: Collection[str] | None = None) -> tuple[Match, ...]:
    """Return up to three symptoms, the best first; layers that are ruled out first win ties.

    A recognized log line says more than any choice of words: next to one, words that happen to fit would only distract.

    Args:
        text: a symptom in words, its name, or one or more log lines.
        drivers: packages of the drivers that the cell has, where it is known: a symptom of others is not guessed by
            words alone.
    """
    known = _known(layers)
    asked = [match for match in known if match.symptom.name.casefold() == text.strip().casefold()]
    named = asked or _logged(known, text)
    if named:
        return tuple(named[:_AT_MOST])
    possible = _possible(known, drivers)
    return tuple(possible[number] for number in islice(_words_of(possible).fitting(text), _AT_MOST))


def nearest(text: str, layers: Sequence[LayerKnowledge], drivers: Collection[str] | None = None) -> tuple[Match, ...]:
    """Return up to three symptoms that share the most with a text that none fits."""
    possible = _possible(_known(layers), drivers)
    return tuple(possible[number] for number in _words_of(possible).nearest(text)[:_AT_MOST])


def logged(text: str) -> tuple[Match, ...]:
    """Return the symptoms that a log line shows, the longest text of a source first: no words are guessed from."""
    pasted = plain(text)
    return tuple(_logged(_known(knowledge()), text)) if any(begin in pasted for begin in _begins()) else ()


@cache
def _begins() -> tuple[str, ...]:
    """Return a piece of each text of a source: a line without any of them shows nothing."""
    texts = {fixed_begin(text) for layer in knowledge() for symptom in layer.symptoms for text in symptom.logged}
    return tuple(sorted(texts))


def _known(layers: Sequence[LayerKnowledge]) -> list[Match]:
    return [Match(layer, symptom) for layer in layers for symptom in layer.symptoms]


def _possible(known: Sequence[Match], drivers: Collection[str] | None) -> list[Match]:
    return [
        match
        for match in known
        if drivers is None or not match.symptom.drivers or any(driver in drivers for driver in match.symptom.drivers)
    ]


def _words_of(known: Sequence[Match]) -> Words:
    return Words(synonyms().words, [match.symptom.said for match in known])


def _logged(known: Sequence[Match], text: str) -> list[Match]:
    """Return what logs a line of the text, the longest text of a source first."""
    pasted = plain(text)
    matches: list[tuple[int, Match]] = []
    for match in known:
        lines = [(template, found_in(template, pasted)) for template in match.symptom.logged]
        names = [named for _, named in lines if named is not None]
        if names:
            named = tuple(dict.fromkeys(pair for pairs in names for pair in pairs))
            template = max((text for text, found in lines if found is not None), key=length)
            matches.append((length(template), Match(match.layer, match.symptom, named, template)))
    return [match for _, match in sorted(matches, key=lambda entry: -entry[0])]


_SHOWN_SUBJECTS = 3
# What a line may name → the scope in which the cell would have it.
_SCOPE_OF_NAMED: dict[str, Scope] = {"controller": "controller", "topic": "topic", "frame": "frame", "target": "frame"}


def diagnose(text: str, cell: Cell | None) -> tuple[Suspicion, ...]:
    """Return what a symptom or log line may mean, the best first; nothing where nothing known fits.

    Args:
        cell: whose names are filled in, and whose drivers decide which symptoms count; without one the commands hold
            placeholders.
    """
    return tuple(suspicion_of(match, text, cell) for match in classify(text, knowledge(), _drivers(cell)))


def near(text: str, cell: Cell | None) -> tuple[Suspicion, ...]:
    """Return the symptoms that are nearest to a text that none fits."""
    return tuple(suspicion_of(match, text, cell) for match in nearest(text, knowledge(), _drivers(cell)))


def _drivers(cell: Cell | None) -> Collection[str] | None:
    return None if cell is None else {device.software.packages.driver or "" for device in cell.devices}


def suspicion_of(match: Match, text: str, cell: Cell | None) -> Suspicion:
    """Return what a symptom that fits may mean in a cell."""
    area = match.layer.owner
    owner = f"owner of the approval `{area}`" if cell is None else str(getattr(cell.owners.approvals, area))
    causes = [_cause(hypothesis, text, cell) for hypothesis in match.symptom.hypotheses]
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


def _cause(hypothesis: Hypothesis, text: str, cell: Cell | None) -> Cause:
    steps: list[Step] = []
    omitted = 0
    for observation in hypothesis.observations:
        chosen = _chosen(_subjects(cell, observation.of), observation.of, text)
        steps += [_step(observation, subject, cell is not None) for subject in chosen[:_SHOWN_SUBJECTS]]
        omitted = max(omitted, len(chosen) - _SHOWN_SUBJECTS)
    return Cause(hypothesis.cause, tuple(dict.fromkeys(steps)), omitted)


def _subjects(cell: Cell | None, scope: Scope) -> tuple[Subject, ...]:
    if cell is None:
        return (placeholders(scope),)
    from cellc.tools.diagnose.subjects import subjects

    return subjects(cell, scope)


def _chosen(found: tuple[Subject, ...], scope: Scope, text: str) -> tuple[Subject, ...]:
    """Return the subjects that the text names, all where it names none."""
    key = FIELDS[scope][0]
    named = tuple(mapping for mapping in found if re.search(rf"(?<![\w/]){re.escape(mapping[key])}(?![\w/])", text))
    return named or found


def _step(observation: Observation, subject: Subject, of_cell: bool) -> Step:
    action = observation.run or observation.look or ""
    # A command is there to be copied: what a name of the spec holds is one word of it.
    words = {name: shell_word(value) if value else "" for name, value in subject.items()}
    action = action.format_map(words if observation.run and of_cell else subject)
    return Step(action, observation.run is not None, observation.refuted.format_map(subject))
