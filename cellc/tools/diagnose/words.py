"""How much a text of a user is like what is said of each symptom.

A text becomes what its words mean. A word means every group of ``catalog/symptoms/words.yaml`` that has a beginning of
it, so that "PCs", "machine" and "laptop" all mean ``host``; a word in no group means itself, without its ending. A
beginning of up to three letters is a whole word or its plural. Words that say nothing of a symptom are left out.

What is rare among the symptoms says more than what many have: a meaning that n of N symptoms have weighs the logarithm
of 1 + N/n. A phrase is as like a text as what they share weighs, by the part of the phrase that is shared: a phrase
that is there as a whole counts in full and a bit more, of one that is there by half a half of its half. A symptom is as
like as its likest phrase, and by a part of what the text shares with all its phrases together.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

_WHOLE_WORD = 3
_SHORTEST_STEM = 4
_ENDINGS = ("ations", "ation", "ings", "ing", "edly", "ed", "ies", "es", "s", "ly", "e", "y")
_UNIT = 100
"""Of a weight: whole numbers add up to the same in every order."""
_WHOLE_PHRASE = 0.4
"""Share by which the heaviest whole phrase counts once more."""
_ALL_PHRASES = 0.3
"""Share that counts of what a text has in common with all phrases of a symptom."""
_WORD = re.compile(r"[a-z0-9]+(?:-[a-z0-9]+)*")

Meanings = frozenset[str]


@dataclass(frozen=True, slots=True)
class Likeness:
    """How like a symptom is to a text.

    Attributes:
        number: of the symptom.
        points: comparable between symptoms of one text.
        whole: weight of the heaviest phrase that the text has as a whole; 0 where it has none.
    """

    number: int
    points: float
    whole: int


class Words:
    """What words mean, and what is said of every symptom.

    Args:
        groups: meaning → beginnings of words that have it.
        said: phrases of every symptom, of names of groups and beginnings of words.
        heard: sentences of every symptom, as users write.
        together: terms of several words that are read as one.
        ignored: words that say nothing.
    """

    def __init__(
        self,
        groups: Mapping[str, Sequence[str]],
        said: Sequence[Sequence[str]],
        heard: Sequence[Sequence[str]] = (),
        together: Sequence[str] = (),
        ignored: Sequence[str] = (),
    ) -> None:
        """Note which beginning means what, and how rare each meaning is."""
        self._ignored = frozenset(ignored)
        longest_first = sorted(together, key=lambda term: (-len(term), term))
        terms = "|".join(rf"\b{re.escape(term).replace(chr(92) + ' ', '[ -]')}" for term in longest_first)
        self._together = re.compile(terms) if terms else None
        self._beginnings: dict[str, set[str]] = {}
        for meaning, beginnings in groups.items():
            for beginning in beginnings:
                self._beginnings.setdefault(beginning, set()).add(meaning)
        phrases = [[[frozenset({word}) for word in phrase.split()] for phrase in row] for row in said]
        for word in {word for row in said for phrase in row for word in phrase.split()} - set(groups):
            self._beginnings.setdefault(word, set()).add(word)
        sentences = [[self._learn(sentence) for sentence in row] for row in heard] or [[] for _ in said]
        self._phrases = [[*row, *more] for row, more in zip(phrases, sentences, strict=True)]
        self._all = [frozenset[str]().union(*(word for phrase in row for word in phrase)) for row in self._phrases]
        having = Counter(meaning for every in self._all for meaning in every)
        self._weights = {
            meaning: round(_UNIT * math.log2(1 + len(self._all) / number)) for meaning, number in having.items()
        }

    def likenesses(self, text: str) -> list[Likeness]:
        """Return the symptoms that share a meaning with a text, the likest first."""
        words = list(self._meanings(text))
        said = frozenset[str]().union(*words)
        like = [self._likeness(number, words, said) for number, every in enumerate(self._all) if every & said]
        return sorted(like, key=lambda each: (-each.points, each.number))

    def weight(self, text: str) -> int:
        """Return what all words of a text weigh that are known of any symptom."""
        return sum(self._weight(word) for word in self._meanings(text))

    def _likeness(self, number: int, words: Sequence[Meanings], said: Meanings) -> Likeness:
        likest, whole = 0.0, 0
        for phrase in self._phrases[number]:
            full = sum(map(self._weight, phrase))
            shared = sum(self._weight(word & said) for word in phrase)
            likest = max(likest, shared * shared / full if full else 0.0)
            whole = max(whole, full if all(word & said for word in phrase) else 0)
        common = sum(self._weight(word & self._all[number]) for word in words)
        return Likeness(number, likest + _WHOLE_PHRASE * whole + _ALL_PHRASES * common, whole)

    def _weight(self, word: Meanings) -> int:
        """Return how much a word says by its rarest meaning."""
        return max((self._weights.get(meaning, 0) for meaning in word), default=0)

    def _learn(self, sentence: str) -> list[Meanings]:
        """Return what the words of a sentence mean; those in no group mean themselves from now on."""
        for word in self._words(sentence):
            if not any(True for _ in self._meanings_of(word)) and len(word) >= _WHOLE_WORD:
                stem = _stem(word)
                self._beginnings.setdefault(stem, set()).add(stem)
        return list(dict.fromkeys(self._meanings(sentence)))

    def _meanings(self, text: str) -> Iterator[Meanings]:
        for word in self._words(text):
            meanings = frozenset(self._meanings_of(word))
            if meanings:
                yield meanings

    def _meanings_of(self, word: str) -> Iterator[str]:
        for length in range(1, len(word) + 1):
            if length > _WHOLE_WORD or word[length:] in ("", "s"):
                yield from self._beginnings.get(word[:length], ())

    def _words(self, text: str) -> Iterator[str]:
        # "can't" is one word; "e-stop" is read as `estop` and as its parts, `joint_states` as its parts.
        plain = re.sub(r"['’]", "", text.lower()).replace("_", " ")
        if self._together is not None:
            plain = self._together.sub(lambda match: re.sub("[ -]", "", match[0]), plain)
        for word in _WORD.findall(plain):
            parts = [word.replace("-", ""), *(word.split("-") if "-" in word else ())]
            yield from (part for part in parts if part not in self._ignored)


def _stem(word: str) -> str:
    ending = next((end for end in _ENDINGS if word.endswith(end) and len(word) - len(end) >= _SHORTEST_STEM), "")
    return word.removesuffix(ending)
