"""What an answer is kept under: the question, and the program that answers it."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

from cellc import __version__

_ANSWERING = ("feasibility", "planning", "description")
"""Packages whose code decides the answers; a change of theirs makes every kept answer a stranger."""


def entry_name(kind: str, question: str) -> str:
    """Return the path of an entry in the cache folder."""
    digest = hashlib.sha256("\0".join((__version__, _program(), kind, question)).encode()).hexdigest()
    return f"{kind}/{digest}.json"


@cache
def _program() -> str:
    root = Path(__file__).resolve().parents[1]
    digest = hashlib.sha256()
    for package in _ANSWERING:
        for file in sorted((root / package).glob("*.py")):
            digest.update(f"{file.name}\0".encode() + file.read_bytes() + b"\0")
    return digest.hexdigest()
