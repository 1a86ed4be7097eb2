"""Which symptoms a text is like, how sure that is, and the one question that decides where it is not.

A layer is certain where the text is the name of a symptom, holds a text of a source that is long or names something, or
where it has a whole phrase that weighs enough, says most of what the text says, and no other layer comes near it. All
else is a proposal.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import islice

from cellc.tools.diagnose.log_lines import Named, fixed_begin, found_in, length, plain
from cellc.tools.diagnose.symptoms import LayerKnowledge, Symptom, knowledge, questions, synonyms
from cellc.tools.diagnose.words import Likeness, Words

_AT_MOST = 3
_LEAST_POINTS = 600
"""Of a symptom none of whose phrases a text has as a whole: less is no likeness."""
_CERTAIN_WHOLE = 800
"""Weight of a phrase that makes certain: two rare words, or three."""
_CERTAIN_SHARE = 0.6
"""Part of what a text says that this phrase has to be."""
_AHEAD = 1.8
"""How many times the points of the best of another layer make a layer likely; certain with such a phrase alone."""
_NEAR = 0.4
"""Part of the points of the best that a further proposal has."""
_CERTAIN_TEXT = 20
"""Letters of a text of a source that is found nowhere else by chance."""


@dataclass(frozen=True, slots=True)
class Match:
    """A symptom that fits, what the line names, (kind, name), and the text of a source that it has."""

    layer: LayerKnowledge
    symptom: Symptom
    named: Named = ()
    template: str = ""


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
        question: what decides between their layers; None where the first one's layer is certain, or nothing fits.
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
    if logged and (logged[0].named or length(logged[0].template) >= _CERTAIN_TEXT):
        return Classified(tuple(logged[:_AT_MOST]))
    possible = [match for match in known if _is_of(match, drivers)]
    words = _words_of(possible)
    like = words.likenesses(text)
    best = _proposed([*logged, *_near(like, possible)])
    if not logged and (not like or (like[0].points < _LEAST_POINTS and not like[0].whole)):
        return Classified(best, fits=False)
    is_ahead = not logged and _is_ahead(like, possible)
    if is_ahead and like[0].whole >= max(_CERTAIN_WHOLE, _CERTAIN_SHARE * words.weight(text)):
        return Classified(best)
    return Classified(best, _question(best, is_ahead=is_ahead))


def logged(text: str) -> tuple[Match, ...]:
    """Return the symptoms that a log line shows, the longest text of a source first: no words are guessed from."""
    pasted = plain(text)
    return tuple(_logged(_known(), pasted)) if any(begin in pasted for begin in _begins()) else ()


@cache
def _known() -> tuple[Match, ...]:
    return tuple(Match(layer, symptom) for layer in knowledge() for symptom in layer.symptoms)


@cache
def _begins() -> tuple[str, ...]:
    """Return a piece of each text of a source: a line without any of them shows nothing."""
    return tuple(sorted({fixed_begin(text) for match in _known() for text in match.symptom.logged}))


def _is_of(match: Match, drivers: Collection[str] | None) -> bool:
    of = match.symptom.drivers
    return drivers is None or not of or any(driver in drivers for driver in of)


def _words_of(known: Sequence[Match]) -> Words:
    table = synonyms()
    heard = [(match.symptom.name, *match.symptom.heard.values()) for match in known]
    return Words(table.words, [match.symptom.said for match in known], heard, table.together, table.ignored)


def _near(like: Sequence[Likeness], possible: Sequence[Match]) -> Iterator[Match]:
    """Yield what comes near the likest; at last the likest of another layer, however far it is."""
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


def _question(matches: Sequence[Match], *, is_ahead: bool) -> Question:
    """Return what decides between the layers of some proposals, or whether the first one's is right."""
    layers = {match.layer.layer for match in matches[: 1 if is_ahead else _AT_MOST]}
    asked = next(question for question in questions().deciding if question.layer in layers)
    yes = tuple(match for match in matches if match.layer.layer == asked.layer)
    no = tuple(match for match in matches if match.layer.layer != asked.layer)
    return Question(asked.ask, yes, no, is_ahead)


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
