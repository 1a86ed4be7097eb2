"""Which symptoms a text names in the user's own words.

A text becomes the set of what its words mean. A word means every group of ``catalog/symptoms/words.yaml`` that has a
beginning of it, so that "PCs", "machine" and "laptop" all mean ``host``; a word of a symptom's phrases that is in no
group means itself and for what begins with it. A beginning of up to three letters is a whole word or its plural.

A phrase fits where the text means all its words, in whatever order; a symptom fits where one of its phrases does. What
is rare among the symptoms says more than what many have: a word that n of N symptoms have weighs the number of binary
digits of N/n. The symptom whose fitting phrase weighs most comes first; of two that weigh alike, the one that explains
words which no earlier one did, then the one with more weight in all its phrases together. Where none fits, the nearest
are those of which one phrase has the most weight in the text.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

_WHOLE_WORD = 3
_TIMEOUT = re.compile(r"\btim(?:e|es|ed|ing)[ -]out\b")
_WORD = re.compile(r"[a-z0-9]+(?:-[a-z0-9]+)*")

Meanings = frozenset[str]
_NOTHING: Meanings = frozenset()


class Words:
    """What words mean, and what every symptom is called.

    Args:
        groups: meaning → beginnings of words that have it.
        phrases: those of every symptom.
    """

    def __init__(self, groups: Mapping[str, Sequence[str]], phrases: Sequence[Sequence[str]]) -> None:
        """Note which beginning means what, and how rare each meaning is."""
        self._phrases = tuple(tuple(frozenset(phrase.split()) for phrase in row) for row in phrases)
        self._all = tuple(_NOTHING.union(*pair) for pair in self._phrases)
        having = Counter(meaning for group in self._all for meaning in group)
        self._weights = {meaning: (len(self._all) // number).bit_length() for meaning, number in having.items()}
        self._beginnings: dict[str, set[str]] = {}
        for meaning in having:
            for beginning in groups.get(meaning, (meaning,)):
                self._beginnings.setdefault(beginning, set()).add(meaning)

    def fitting(self, text: str) -> Iterator[int]:
        """Yield the numbers of the symptoms that fit, the best first."""
        said, explained = self._meanings(text), _NOTHING
        phrases = {number: self._best_of(phrase, said) for number, phrase in enumerate(self._phrases)}
        left = {number: phrase for number, phrase in phrases.items() if phrase}
        while left:
            best = max(
                left,
                key=lambda phrase: (
                    self._weight(left[phrase]),
                    self._weight(left[phrase] - explained),
                    self._weight(self._all[phrase] & said),
                    -phrase,
                ),
            )
            explained |= left.pop(best)
            yield best

    def nearest(self, text: str) -> list[int]:
        """Return the numbers of the symptoms that share a word with a text, the nearest first."""
        said = self._meanings(text)
        near = [number for number, every in enumerate(self._all) if every & said]
        return sorted(near, key=lambda number: self._nearness(number, said), reverse=True)

    def _nearness(self, number: int, said: Meanings) -> tuple[int, int]:
        most = max(self._weight(phrase & said) for phrase in self._phrases[number])
        return most, self._weight(self._all[number] & said)

    def _best_of(self, phrases: Sequence[Meanings], said: Meanings) -> Meanings:
        return max((phrase for phrase in phrases if phrase <= said), key=self._weight, default=_NOTHING)

    def _meanings(self, text: str) -> Meanings:
        """Return what the words of a text mean, as far as a phrase asks for it."""
        return frozenset(meaning for word in _words(text) for meaning in self._meanings_of(word))

    def _meanings_of(self, word: str) -> Iterator[str]:
        for length in range(1, len(word) + 1):
            if length > _WHOLE_WORD or word[length:] in ("", "s"):
                yield from self._beginnings.get(word[:length], ())

    def _weight(self, meanings: Meanings) -> int:
        return sum(self._weights[meaning] for meaning in meanings)


def _words(text: str) -> Iterator[str]:
    # "can't" is one word; "e-stop" is read as `estop` and as its parts, `joint_states` as its parts.
    plain = _TIMEOUT.sub("timeout", re.sub(r"['’]", "", text.lower()).replace("_", " "))
    for word in _WORD.findall(plain):
        yield word.replace("-", "")
        if "-" in word:
            yield from word.split("-")
