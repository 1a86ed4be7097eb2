"""Which symptoms a text is like, how sure that is, and the one question that decides where it is not.

A layer is certain where the text is the name of a symptom, or has a line that names the cause and none that names the
cause in another layer. All else is a proposal: first other lines that programs write and errors of the operating system
whose object is known, then what is like the words, at last lines that any failure leads to.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import islice

from cellc.tools.diagnose.evidence import Stated, stated
from cellc.tools.diagnose.log_lines import Named, fixed_begin, found_in, graver, length, plain, spoken
from cellc.tools.diagnose.os_errors import os_errors
from cellc.tools.diagnose.sections import Placed, placed
from cellc.tools.diagnose.symptoms import LayerKnowledge, Symptom, knowledge, questions, synonyms
from cellc.tools.diagnose.words import Likeness, Words

_AT_MOST = 3
_LEAST_POINTS = 600
"""Of a symptom none of whose phrases a text has as a whole: less is no likeness."""
_LEAST_BESIDES = 1500
"""Of a symptom by its words beside a line that shows one."""
_AHEAD = 1.8
"""How many times the points of the best of another layer make a layer likely."""
_NEAR = 0.4
"""Part of the points of the best that a further proposal has."""
_SHOWN, _CALLED, _LITTLE = 4000.0, 2500.0, 400.0
"""Points of a line that a program writes, of an error on a known object, and of what any failure leads to."""
_IN_PLACE, _OUT_OF_PLACE = 1.5, 0.6
"""By what points are multiplied where a log or a device names the part of the cell."""
_COVERED, _ALIKE = 0.33, 0.5
"""Part of a text's weight that the heaviest whole phrase of the best has at least, or its points; less is weak."""


@dataclass(frozen=True, slots=True)
class Match:
    """A symptom that fits, what the line names, (kind, name), the text of a source in it, and how well it fits."""

    layer: LayerKnowledge
    symptom: Symptom
    named: Named = ()
    template: str = ""
    points: float = field(default=0.0, compare=False)

    @property
    def names_cause(self) -> bool:
        """The line says the cause by itself."""
        return self.template in self.symptom.names_cause

    @property
    def says_little(self) -> bool:
        """Any failure may lead to the line."""
        return not self.template or self.template in self.symptom.says_little


@dataclass(frozen=True, slots=True)
class Question:
    """What is asked, and which proposals either answer speaks for.

    Attributes:
        no: empty where no other layer has anything of the text.
        confirms: yes speaks for the layer of the first proposal, which is far ahead of all others.
    """

    ask: str
    yes: tuple[Match, ...]
    no: tuple[Match, ...]
    confirms: bool


@dataclass(frozen=True, slots=True)
class Classified:
    """What a text is like.

    Attributes:
        matches: up to three symptoms, the best first.
        question: what decides between them; None where the first one's layer is certain, or nothing fits.
        fits: False where the matches are merely the nearest.
        placed: the part of the cell; None where a line names the cause, or nothing tells it.
        weak: no line shows the matches, and little of the text is like them.
    """

    matches: tuple[Match, ...]
    question: Question | None = None
    fits: bool = True
    placed: Placed | None = None
    weak: bool = False


def classify(text: str, layers: Sequence[LayerKnowledge], drivers: Collection[str] | None = None) -> Classified:
    """Return what a text is like.

    Args:
        text: a symptom in words, its name, or one or more log lines.
        drivers: packages of the drivers that the cell has, where it is known: a symptom of others is not guessed by
            words alone.
    """
    known = [Match(layer, symptom) for layer in layers for symptom in layer.symptoms]
    asked = [match for match in known if match.symptom.name.casefold() == text.strip().casefold()]
    if asked:
        return Classified(tuple(asked))
    logged = _logged(known, plain(text)) or _logged(known, plain(text), is_typed=True)
    grave = plain(graver(text))
    causes = [match for match in logged if match.names_cause and found_in(match.template, grave) is not None]
    if len({match.layer.layer for match in causes}) == 1:
        return Classified(tuple(causes[:_AT_MOST]))
    return _proposal(text, known, logged, causes, [match for match in known if _is_of(match, drivers)])


def _proposal(
    text: str, known: Sequence[Match], logged: Sequence[Match], causes: Sequence[Match], possible: Sequence[Match]
) -> Classified:
    """Return what is likely: lines that show a symptom, then likeness by words, then what any failure leads to."""
    facts, words = stated(text), _words_of(possible)
    like = _weighed(words.likenesses(_besides(logged, spoken(text))), possible, facts, placed(text))
    calls, bare = _failed_calls(known, text)
    said = [*causes, *(match for match in logged if match not in causes and not match.says_little), *calls]
    least = _LEAST_BESIDES if said else _LEAST_POINTS
    is_like = bool(like) and (like[0].points >= least or (not said and like[0].whole > 0))
    near = list(_near(like, possible, _LEAST_BESIDES if said else 0))
    little = [*bare, *(match for match in logged if match.says_little)]
    best = _proposed([*said, *near, *little] if is_like else [*said, *little, *near])
    place = placed(text, [match.layer.layer for match in best])
    if not is_like and not said and not little:
        return Classified(best, fits=False, placed=place)
    is_ahead = not logged and not calls and _is_ahead(like, possible) if like else False
    weak = not logged and not calls and not _is_strong(like, words.weight(spoken(text)), place)
    return Classified(best, _question(best, facts, place, is_ahead=is_ahead), placed=place, weak=weak)


def logged(text: str) -> tuple[Match, ...]:
    """Return the symptoms that a log line shows, the longest text of a source first: no words are guessed from."""
    pasted = plain(text)
    found = _logged(_known(), pasted) if any(begin in pasted for begin in _begins()) else []
    calls, bare = _failed_calls(_known(), pasted)
    little = [match for match in found if match.says_little]
    return (*(match for match in found if not match.says_little), *calls, *little, *bare)


@cache
def _known() -> tuple[Match, ...]:
    return tuple(Match(layer, symptom) for layer in knowledge() for symptom in layer.symptoms)


@cache
def _begins() -> tuple[str, ...]:
    """Return a piece of each text of a source: a line without any of them shows nothing."""
    return tuple(sorted({fixed_begin(text) for match in _known() for text in match.symptom.logged}))


def _failed_calls(known: Sequence[Match], text: str) -> tuple[list[Match], list[Match]]:
    """Return what errors of the operating system mean: those whose object is known, and the others."""
    by_name = {match.symptom.name: match for match in known}
    calls: list[Match] = []
    bare: list[Match] = []
    for meaning in os_errors(text):
        if meaning.symptom in by_name:
            match = by_name[meaning.symptom]
            named = (("error", meaning.error), *((("object", meaning.kind),) if meaning.kind else ()))
            points = _CALLED if meaning.kind else _LITTLE
            (calls if meaning.kind else bare).append(Match(match.layer, match.symptom, named, points=points))
    return calls, bare


def _besides(logged: Sequence[Match], text: str) -> str:
    """Return a text without the lines that any failure leads to: their words say nothing more."""
    begins = {fixed_begin(match.template) for match in logged if match.says_little}
    return re.sub("|".join(map(re.escape, begins)), " ", text, flags=re.IGNORECASE) if begins else text


def _is_of(match: Match, drivers: Collection[str] | None) -> bool:
    of = match.symptom.drivers
    return drivers is None or not of or any(driver in drivers for driver in of)


def _words_of(known: Sequence[Match]) -> Words:
    table = synonyms()
    heard = [(match.symptom.name, *match.symptom.heard.values()) for match in known]
    return Words(table.words, [match.symptom.said for match in known], heard, table.together, table.ignored)


def _weighed(
    like: Sequence[Likeness], possible: Sequence[Match], facts: Stated, place: Placed | None
) -> list[Likeness]:
    """Return the likenesses, the likest first, with what the text states and names counted in."""

    def factor(match: Match) -> float:
        of_place = 1.0
        if place is not None and place.is_named:
            of_place = _IN_PLACE if match.layer.layer in place.section.layers else _OUT_OF_PLACE
        return of_place * facts.factor(match.symptom.name, match.layer.layer)

    weighed = [replace(each, points=each.points * factor(possible[each.number])) for each in like]
    return sorted(weighed, key=lambda each: (-each.points, each.number))


def _near(like: Sequence[Likeness], possible: Sequence[Match], least: float) -> Iterator[Match]:
    """Yield what comes near the likest; at last the likest of another layer, unless it has less than asked for."""
    like = [each for each in like if each.points >= least]
    if not like:
        return

    def match(each: Likeness) -> Match:
        return replace(possible[each.number], points=each.points)

    yield from (match(each) for each in like if each.points >= _NEAR * like[0].points)
    others = (match(each) for each in like if possible[each.number].layer != possible[like[0].number].layer)
    yield from islice(others, 1)


def _proposed(matches: Iterable[Match]) -> tuple[Match, ...]:
    """Return the first three symptoms; where all are of one layer, the third is the first of another."""
    by_name: dict[str, Match] = {}
    for match in matches:
        by_name.setdefault(match.symptom.name, match)
    once = list(by_name.values())
    first, rest = once[: _AT_MOST - 1], once[_AT_MOST - 1 :]
    layers = {match.layer.layer for match in first}
    others = (match for match in rest if match.layer.layer not in layers)
    third = next(others, None) if len(layers) == 1 else None
    return (*first, *([third] if third is not None else rest[:1]))


def _is_ahead(like: Sequence[Likeness], possible: Sequence[Match]) -> bool:
    """Tell that no other layer comes near the first one."""
    layer = possible[like[0].number].layer
    other = next((each.points for each in like if possible[each.number].layer != layer), 0.0)
    return like[0].points >= _AHEAD * other


def _is_strong(like: Sequence[Likeness], weight: int, place: Placed | None) -> bool:
    """Tell that much of a text is like the best; where a log names the part of the cell, that takes a whole phrase."""
    if not like:
        return False
    is_named = place is not None and place.is_named
    return like[0].whole >= _COVERED * weight or (not is_named and like[0].points >= _ALIKE * weight)


def _question(matches: Sequence[Match], facts: Stated, place: Placed | None, *, is_ahead: bool) -> Question:
    """Return the question whose answer tells most, by how strongly each proposal fits.

    A question that the text answers is left for the next one. Where one layer is far ahead, it is confirmed.
    """
    asked = list(_askable(matches, place))
    opened = [each for each in asked if not facts.answers(each.ask)] or asked
    total = sum(match.points for match in matches) or 1.0

    def gain(each: _Askable) -> float:
        return each.worth * _gain(sum(match.points for match in each.yes) / total)

    of_first = (each for each in opened if {match.layer.layer for match in each.yes} == {matches[0].layer.layer})
    best = next(of_first, opened[0]) if is_ahead else max(opened, key=gain)
    return Question(best.ask, best.yes, tuple(match for match in matches if match not in best.yes), is_ahead)


@dataclass(frozen=True, slots=True)
class _Askable:
    """A question, the proposals that yes speaks for, and how much better than others it is to be answered."""

    ask: str
    yes: tuple[Match, ...]
    worth: float


def _askable(matches: Sequence[Match], place: Placed | None) -> Iterator[_Askable]:
    """Yield questions: of the first proposal, of the part of the cell, between layers, of a layer, of the others."""
    first, *rest = matches
    layers = {match.layer.layer for match in matches}

    def of(*among: str) -> tuple[Match, ...]:
        return tuple(match for match in matches if match.layer.layer in among)

    if first.symptom.ask is not None:
        yield _Askable(first.symptom.ask, (first,), 1.3)
    elif place is not None and first.layer.layer in place.section.layers[:1]:
        inside = of(*place.section.layers[:1])
        outside = tuple(match for match in matches if match not in inside)
        yield _Askable(place.section.ask, outside, 1.2 if place.is_named else 0.9)
    for between in questions().between:
        if set(between.layers) <= layers:
            yield _Askable(between.ask, of(between.layers[0]), 1.1 if first.layer.layer in between.layers else 0.9)
    near = sorted(questions().deciding, key=lambda each: each.layer != first.layer.layer)
    yield from (_Askable(each.ask, of(each.layer), 1.0) for each in near if each.layer in layers)
    yield from (_Askable(each.symptom.ask, (each,), 0.95) for each in rest if each.symptom.ask is not None)


def _gain(part: float) -> float:
    """Return how much an answer tells that speaks for a part of what is likely: the entropy of yes and no."""
    return 0.0 if part <= 0 or part >= 1 else -part * math.log2(part) - (1 - part) * math.log2(1 - part)


def _logged(known: Sequence[Match], pasted: str, *, is_typed: bool = False) -> list[Match]:
    """Return what logs a line of the text, the longest text of a source first.

    Args:
        is_typed: in any case, as somebody types a line; names in it are not those of the cell.
    """
    text = pasted.casefold() if is_typed else pasted
    matches: list[tuple[int, Match]] = []
    for match in known:
        lines = [(line, found_in(line.casefold() if is_typed else line, text)) for line in match.symptom.logged]
        names = [named for _, named in lines if named is not None]
        if names:
            named = () if is_typed else tuple(dict.fromkeys(pair for pairs in names for pair in pairs))
            template = max((line for line, found in lines if found is not None), key=length)
            points = _LITTLE if template in match.symptom.says_little else _SHOWN
            matches.append((length(template), Match(match.layer, match.symptom, named, template, points)))
    return [match for _, match in sorted(matches, key=lambda entry: -entry[0])]
