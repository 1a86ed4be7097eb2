"""The base of every exception that cellc raises on purpose: ``except CellcError`` catches what a caller can answer.

What is wrong with a user's file is a diagnostic, not an exception. An exception says that a call cannot be answered at
all; its text is one line for people.
"""

from __future__ import annotations


class CellcError(Exception):
    """A call cannot be answered; the text says why in one line."""


class ReasonError(CellcError):
    """An exception whose text is its reason.

    Args:
        reason: one line.
    """

    def __init__(self, reason: str) -> None:
        super().__init__(reason)
        self.reason = reason


def reason_of(error: OSError) -> str:
    """Return why the system refused something, as a part of a sentence."""
    return (error.strerror or type(error).__name__).lower()
