"""No text that people read has a banned word: messages, pages, packages, docstrings, comments, names."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.project.words import BANNED, banned, files, inner, printed, suggestion


@pytest.mark.parametrize("texts", [printed, inner])
def test_no_file_has_a_banned_word(texts: Callable[[Path], list[str]]) -> None:
    """``printed`` are messages, pages and generated packages; ``inner`` are docstrings, comments and public names."""
    found = [
        f"{file}: {word}: write {suggestion(word)}" for file in files() for text in texts(file) for word in banned(text)
    ]
    assert not found, "\n".join(found)


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
