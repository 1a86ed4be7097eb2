"""A generated file before it is written."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Artifact:
    """Relative path with forward slashes, and text with ``\\n`` line ends that ends in one."""

    path: str
    text: str
