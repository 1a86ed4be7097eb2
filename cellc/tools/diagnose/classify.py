"""Which symptoms a text is like, how sure that is, and the one question that decides where it is not.

A layer is certain where the text is the name of a symptom, or has a line that names the cause and none that names the
cause in another layer. All else is a proposal: first other lines that programs write and errors of the operating system
whose object is known, then what is like the words, at last lines that any failure leads to.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice

from cellc.tools.diagnose.evidence import Stated, stated
from cellc.tools.diagnose.log_lines import Named, fixed_begin, found_in, graver, length, plain, spoken
from cellc.tools.diagnose.os_errors import os_errors
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


@dataclass(frozen=True, slots=True)
class Match:
    """A symptom that fits, what the line names, (kind, name), and the text of a source that it has."""

    layer: LayerKnowledge
    symptom: Symptom
    named: Named = ()
    template: str = ""

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
    """

    matches: tuple[Match, ...]
    question: Question | None = None
    fits: bool = True


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
    possible = [match for match in known if _is_of(match, drivers)]
    known_facts = stated(text)
    like = _weighed(_words_of(possible).likenesses(_besides(logged, spoken(text))), possible, known_facts)
    calls, bare = _failed_calls(known, text)
    said = [*causes, *(match for match in logged if match not in causes and not match.says_little), *calls]
    least = _LEAST_BESIDES if said else _LEAST_POINTS
    is_like = bool(like) and (like[0].points >= least or (not said and like[0].whole > 0))
    near = list(_near(like, possible, _LEAST_BESIDES if said else 0))
    little = [*bare, *(match for match in logged if match.says_little)]
    best = _proposed([*said, *near, *little] if is_like else [*said, *little, *near])
    if not is_like and not said and not little:
        return Classified(best, fits=False)
    is_ahead = not logged and not calls and _is_ahead(like, possible) if like else False
    return Classified(best, _question(best, known_facts, is_ahead=is_ahead))


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
            (calls if meaning.kind else bare).append(Match(match.layer, match.symptom, named))
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


def _weighed(like: Sequence[Likeness], possible: Sequence[Match], facts: Stated) -> list[Likeness]:
    """Return the likenesses, the likest first, with what the text states counted in."""
    factors = [facts.factor(possible[each.number].symptom.name) for each in like]
    weighed = [replace(each, points=each.points * factor) for each, factor in zip(like, factors, strict=True)]
    return sorted(weighed, key=lambda each: (-each.points, each.number))


def _near(like: Sequence[Likeness], possible: Sequence[Match], least: float) -> Iterator[Match]:
    """Yield what comes near the likest; at last the likest of another layer, unless it has less than asked for."""
    like = [each for each in like if each.points >= least]
    if not like:
        return
    yield from (possible[each.number] for each in like if each.points >= _NEAR * like[0].points)
    others = (possible[each.number] for each in like if possible[each.number].layer != possible[like[0].number].layer)
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


def _question(matches: Sequence[Match], facts: Stated, *, is_ahead: bool) -> Question:
    """Return what separates the first proposal from the others best: its own question, or that of the two layers.

    A question that the text answers is left for the next one.
    """
    first, *rest = matches
    if first.symptom.ask is not None and not facts.answers(first.symptom.ask):
        return Question(first.symptom.ask, (first,), tuple(rest), is_ahead)
    other = next((match.layer.layer for match in rest if match.layer.layer != first.layer.layer), None)
    layers = {first.layer.layer} if is_ahead or other is None else {first.layer.layer, other}
    of_both = (each for each in questions().between if set(each.layers) == layers and not facts.answers(each.ask))
    between = next(of_both, None)
    if between is not None:
        ask, layer = between.ask, between.layers[0]
    else:
        of_any = [each for each in questions().deciding if each.layer in {match.layer.layer for match in matches}]
        open_yet = [each for each in of_any if not facts.answers(each.ask)]
        asked = next((each for each in open_yet if each.layer in layers), (open_yet or of_any)[0])
        ask, layer = asked.ask, asked.layer
    yes = tuple(match for match in matches if match.layer.layer == layer)
    return Question(ask, yes, tuple(match for match in matches if match not in yes), is_ahead)


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
            matches.append((length(template), Match(match.layer, match.symptom, named, template)))
    return [match for _, match in sorted(matches, key=lambda entry: -entry[0])]
