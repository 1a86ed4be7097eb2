"""Errors of the operating system in a text: by number, name or words, and by the object that the call was made on."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from cellc.tools.diagnose.symptoms import OsError, system_errors

_BEFORE, _AFTER = 160, 120
"""Letters around an error in which its object is named."""
_NUMBER = re.compile(r"\b(?:errno|os error|oserror)\b\W{0,4}(\d{1,3})\b")
_OTHER = "other"


@dataclass(frozen=True, slots=True)
class Meaning:
    """An error on an object: the symptom that it is; ``kind`` is empty where no object is known."""

    symptom: str
    error: str
    kind: str


def os_errors(text: str) -> tuple[Meaning, ...]:
    """Return what the errors of a text mean, those whose object is known first."""
    small = text.casefold()
    found = [
        _meaning(error, name, small[max(0, start - _BEFORE) : end + _AFTER])
        for error, name, start, end in _errors(small)
    ]
    by_symptom: dict[str, Meaning] = {}
    for meaning in sorted(found, key=lambda meaning: not meaning.kind):
        by_symptom.setdefault(meaning.symptom, meaning)
    return tuple(by_symptom.values())


def _meaning(error: OsError, name: str, around: str) -> Meaning:
    # The texts of the error itself tell nothing of its object: `no such file or directory`.
    for text in error.texts:
        around = around.replace(text, " ")
    kinds = (kind for kind, words in system_errors().kinds.items() if any(word in around for word in words))
    kind = next((kind for kind in kinds if kind in error.means), "")
    return Meaning(error.means[kind or _OTHER], name, kind)


def _errors(text: str) -> Iterator[tuple[OsError, str, int, int]]:
    """Yield each error of a text, its name there, and where it begins and ends."""
    by_number = {
        number: (error, name)
        for error in system_errors().errors
        for number, name in zip(error.numbers, error.names, strict=True)
    }
    for match in _NUMBER.finditer(text):
        if int(match[1]) in by_number:
            yield *by_number[int(match[1])], match.start(), match.end()
    by_word = {word.casefold(): error for error in system_errors().errors for word in (*error.names, *error.texts)}
    for match in _words().finditer(text):
        yield by_word[match[0]], match[0], match.start(), match.end()


@cache
def _words() -> re.Pattern[str]:
    """Return what finds every name as a word of its own, and every text."""
    errors = system_errors().errors
    names = [rf"\b{name.casefold()}\b" for error in errors for name in error.names]
    texts = [re.escape(text) for error in errors for text in error.texts]
    return re.compile("|".join([*texts, *names]))
