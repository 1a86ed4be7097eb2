"""A generated file before it is written."""

from __future__ import annotations

from typing import Protocol

from cellc.contract.frozen import dataclass


class NewFile(Protocol):
    """What is written into a folder: relative path with forward slashes, content, and whether it is a program."""

    @property
    def path(self) -> str: ...

    @property
    def content(self) -> bytes: ...

    @property
    def executable(self) -> bool: ...


@dataclass(frozen=True, slots=True)
class Artifact:
    """Relative path with forward slashes, and text with ``\\n`` line ends that ends in one.

    ``executable`` is a program: its file gets the execute bit wherever it has the read bit.
    """

    path: str
    text: str
    executable: bool = False

    @property
    def content(self) -> bytes:
        """What the file holds."""
        return self.text.encode()
