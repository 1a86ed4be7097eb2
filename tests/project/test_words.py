"""The words of texts that people read: how many banned ones are left, by folder. The numbers may only sink."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from tests.project.words import BANNED, banned, files, folder_of, inner, printed, suggestion

PRINTED: dict[str, int] = {}
"""Banned words in printed texts by folder: messages, pages, generated packages. A folder without a row has none."""

INNER: dict[str, int] = {}
"""Banned words in docstrings, comments and public names by folder. A folder without a row has none."""


@pytest.mark.parametrize(("texts", "left"), [(printed, PRINTED), (inner, INNER)], ids=["printed", "inner"])
def test_banned_words_only_get_fewer(texts: Callable[[Path], list[str]], left: dict[str, int]) -> None:
    """Where a folder has more than it had, the words of its files are listed with what to write instead."""
    found = _found(texts)
    more = {folder for folder, words in found.items() if words.total() > left.get(folder, 0)}
    shown = [
        f"{file}: {word} ({times} x): write {suggestion(word)}"
        for file, words in _by_file(texts).items()
        for word, times in words.items()
        if folder_of(file) in more
    ]
    counts = {folder: (found[folder].total(), left.get(folder, 0)) for folder in sorted(more)}
    assert not more, f"more banned words than allowed (found, allowed): {counts}\n" + "\n".join(shown)


def _found(texts: Callable[[Path], list[str]]) -> dict[str, Counter[str]]:
    found: dict[str, Counter[str]] = {}
    for file, words in _by_file(texts).items():
        found.setdefault(folder_of(file), Counter()).update(words)
    return found


@cache
def _by_file(texts: Callable[[Path], list[str]]) -> dict[Path, Counter[str]]:
    return {file: Counter(word for text in texts(file) for word in banned(text)) for file in files()}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Nobody answers for it.", ["nobody", "answers for"]),
        ("It is told its behaviour, in metres.", ["told", "behaviour", "metres"]),
        ("centimetres, CENTRED", ["centimetres", "centred"]),
        ("A key such as `behaviour` is code, and `metres` too.", []),
        ("```\nit went\n```\nIt is always safe, likewise withstands.", []),
        ("They move at once.", ["at once"]),
    ],
)
def test_words_are_found_outside_of_code(text: str, words: list[str]) -> None:
    assert banned(text) == words


def test_every_banned_word_has_something_to_write_instead() -> None:
    assert all(BANNED.values())


if __name__ == "__main__":
    for name, texts in (("PRINTED", printed), ("INNER", inner)):
        print(f"{name} = {{")
        for folder, words in sorted(_found(texts).items()):
            if words.total():
                print(f'    "{folder}": {words.total()},')
        print("}")
