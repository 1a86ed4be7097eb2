"""A generated file before it is written."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Artifact:
    """Relative path with forward slashes, and text with ``\\n`` line ends that ends in one.

    ``executable`` is a program: its file may be executed by whoever may read it.
    """

    path: str
    text: str
    executable: bool = False
