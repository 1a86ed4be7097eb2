"""From a symptom or log line to hypotheses that name the cell's own controllers, topics and frames.

Nothing that is said here acts: each hypothesis comes with the observations that can rule it out.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from string import Formatter
from typing import TYPE_CHECKING

from cellc.compiler.formats.escape import shell_word
from cellc.tools.diagnose.classify import Match, classify
from cellc.tools.diagnose.codes import codes_in
from cellc.tools.diagnose.evidence import Stated, stated
from cellc.tools.diagnose.fields import FIELDS, NOT_STATED, Scope, Subject, placeholders
from cellc.tools.diagnose.looks import Chosen, first_looks
from cellc.tools.diagnose.named import named_in
from cellc.tools.diagnose.naming import NO_NODE, loggers, names_of
from cellc.tools.diagnose.sections import Bisection, Contrast, Placed, Section, blind_to, contrasts, placed
from cellc.tools.diagnose.symptoms import Action, Hypothesis, Observation, knowledge, questions

if TYPE_CHECKING:
    from cellc.compiler.cell.cell import Cell


@dataclass(frozen=True, slots=True)
class Step:
    """One observation: a command that only reads, or something to look at; and what would rule the cause out.

    Attributes:
        refuted: empty for a command that merely tells a name.
        blind: why that outcome makes the cause less likely and does not rule it out; empty where it does.
    """

    action: str
    is_command: bool
    refuted: str
    blind: str = ""


@dataclass(frozen=True, slots=True)
class Halving:
    """One observation that halves what is left, and what either outcome says."""

    action: str
    is_command: bool
    good: str
    bad: str


@dataclass(frozen=True, slots=True)
class Route:
    """A part of the cell, or a comparison, with its observations in the order in which they are made."""

    name: str
    steps: tuple[Halving, ...]
    source: str


@dataclass(frozen=True, slots=True)
class Cause:
    """A hypothesis; ``omitted`` counts further subjects of the cell to which the same steps apply."""

    text: str
    steps: tuple[Step, ...]
    omitted: int


@dataclass(frozen=True, slots=True)
class First:
    """A cause of a part that the text names, and the one observation that tells.

    Attributes:
        part: empty for a cause of no part.
    """

    cause: str
    action: str
    is_command: bool
    part: str
    source: str


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
        routes: what is compared, then how the part of the cell is narrowed down; empty where a line names the cause.
        weak: no symptom fits well: the routes come first, and the question is that of the part.
        first: what is looked at first, by what the text names; empty where a line names the cause.
        named: what the numbers and names of the text are, one line each.
    """

    suspicions: tuple[Suspicion, ...]
    ask: str = ""
    yes: tuple[str, ...] = ()
    no: tuple[str, ...] = ()
    likely: bool = False
    fits: bool = True
    stated: tuple[str, ...] = ()
    routes: tuple[Route, ...] = ()
    weak: bool = False
    first: tuple[First, ...] = ()
    named: tuple[str, ...] = ()


_ELSE = "no other layer has any of these words; add what was done before, or a line of the log"
_SHOWN_SUBJECTS = 3
_COMPARED = 1
_OF_NETWORK = re.compile(r"\bping\b|\bip route\b|\bsubnet\b|\bnetwork\b")
# What a line may name → the scope in which the cell would have it.
_SCOPE_OF_NAMED: dict[str, Scope] = {"controller": "controller", "topic": "topic", "frame": "frame", "target": "frame"}


def diagnose(text: str, cell: Cell | None) -> Answer:
    """Return what a symptom or log line may mean, and how sure that is.

    Args:
        cell: whose names are filled in, and whose drivers decide which symptoms count; without one the commands hold
            placeholders.
    """
    answer = _answer(text, cell)
    named = (*codes_in(text), *named_in(text, cell))
    return replace(answer, first=first_in(text, cell) if answer.ask else (), named=named)


def first_in(text: str, cell: Cell | None) -> tuple[First, ...]:
    """Return what is looked at first, by the parts that a text names and the kind of trouble that it states."""
    facts = stated(text)
    chosen = (each for each in first_looks(text) if not facts.has_seen(each.look.action))
    return tuple(_first(each, text, cell) for each in chosen)


def _first(chosen: Chosen, text: str, cell: Cell | None) -> First:
    look, part = chosen.look, chosen.part
    subject = next((each for each in _chosen(cell, look.of, text) if _is_fit(look, each)), placeholders(look.of))
    if look.look is not None:
        subject = {field: "it" if value == f"<{field}>" else value for field, value in subject.items()}
    name, source = ("", "") if part is None else (part.part, part.source)
    return First(look.cause, _filled(look, subject, cell is not None), look.run is not None, name, source)


def _answer(text: str, cell: Cell | None) -> Answer:
    classified = classify(text, knowledge(), _drivers(cell))
    suspicions = tuple(suspicion_of(match, text, cell) for match in classified.matches)
    question, said = classified.question, stated(text).names
    if question is None and classified.fits:
        return Answer(suspicions, stated=said)
    routes = _routes(text, classified.placed, cell)
    if question is not None:
        yes, no = (_meant(each) or (_ELSE,) for each in (question.yes, question.no))
        answer = Answer(suspicions, question.ask, yes, no, question.confirms, stated=said, routes=routes)
        return _by_part(answer, classified.placed) if classified.weak else answer
    asked = questions().narrowing
    titles = {layer.layer: layer.title for layer in knowledge()}
    yes, no = (tuple(titles[layer] for layer in layers) for layers in (asked.yes, asked.no))
    return Answer(suspicions, asked.ask, yes, no, fits=False, stated=said, routes=routes)


def _by_part(answer: Answer, place: Placed | None) -> Answer:
    """Return an answer that asks for the part of the cell, as no symptom fits well."""
    if place is None:
        return answer
    first = answer.routes[-1].steps[0]
    return replace(answer, ask=place.section.ask, yes=(first.good,), no=(first.bad,), likely=False, weak=True)


def routes_in(text: str, cell: Cell | None) -> tuple[Route, ...]:
    """Return how the part of the cell that a log names is narrowed down; nothing where it names none."""
    place = placed(text)
    return _routes(text, place, cell) if place is not None and place.is_named else ()


def _routes(text: str, place: Placed | None, cell: Cell | None) -> tuple[Route, ...]:
    """Return what is compared where a text states that something works, and how the part of a cell is narrowed down."""
    compared = contrasts(stated(text).names)[:_COMPARED]
    chosen: list[Contrast | Section] = [*compared, *([] if place is None else [place.section])]
    return tuple(Route(each.name, tuple(_halvings(each.steps, text, cell)), each.source) for each in chosen)


def _halvings(steps: Sequence[Bisection], text: str, cell: Cell | None) -> Iterator[Halving]:
    for step in steps:
        subject = next((each for each in _chosen(cell, step.of, text) if _is_fit(step, each)), placeholders(step.of))
        if step.of == "node" and not names_of(text, "node").keys() & {"node"}:
            subject = {"node": NO_NODE}
        if step.look is not None:
            subject = {field: "it" if value == f"<{field}>" else value for field, value in subject.items()}
        good, bad = (each.format_map(subject) for each in step.read)
        yield Halving(_filled(step, subject, cell is not None), step.run is not None, good, bad)


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
        if observation.of == "node" and any(each["node"] == NO_NODE for each in chosen):
            steps.append(Step("ros2 node list --no-daemon", True, ""))
        shown = [_step(observation, subject, cell is not None) for subject in chosen[:_SHOWN_SUBJECTS]]
        steps += [replace(step, blind=blind_to(step.action, hypothesis.cause)) for step in shown]
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


def _is_fit(observation: Action, subject: Subject) -> bool:
    """Tell that a subject has every value that an observation speaks of, and an address of the right kind."""
    text = " ".join((observation.action, *observation.read))
    used = {name for _, name, _, _ in Formatter().parse(text) if name}
    if any(subject[name] == NOT_STATED for name in used):
        return False
    address = subject["address"] if "address" in used else ""
    if address.startswith("/dev/"):
        return not _OF_NETWORK.search(text)
    return not address or address.startswith("<") or "/dev/" not in text


def _step(observation: Observation, subject: Subject, of_cell: bool) -> Step:
    action = _filled(observation, subject, of_cell)
    return Step(action, observation.run is not None, observation.refuted.format_map(subject))


def _filled(action: Action, subject: Subject, of_cell: bool) -> str:
    # A command is there to be copied: what a name of the spec holds is one word of it.
    words = {name: shell_word(value) if value else "" for name, value in subject.items()}
    return action.action.format_map(words if action.run and of_cell else subject)
