"""Make text of a hostile file harmless for the terminal that shows it."""

from __future__ import annotations

import unicodedata

# Controls, invisible formatting, lone surrogates, and the separators that some terminals break lines at.
_UNSAFE_CATEGORIES = frozenset({"Cc", "Cf", "Cs", "Zl", "Zp"})


def escape(text: str) -> str:
    """Return ``text`` on one line with every character that could steer a terminal written as an escape."""
    if text.isascii() and text.isprintable():
        return text
    return "".join(escape_character(character) for character in text)


def escape_character(character: str) -> str:
    """Return a character itself, or its escape such as ``\\x1b``."""
    if unicodedata.category(character) not in _UNSAFE_CATEGORIES:
        return character
    return character.encode("unicode_escape").decode("ascii")
