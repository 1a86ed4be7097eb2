"""Faults put into single lines of emitted files, chosen by a seed that is told."""

from __future__ import annotations

import random
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace

from tests.consumers.matrix import Build


@dataclass(frozen=True, slots=True)
class Corruption:
    """One line of one file that an emitter with a fault would have written otherwise."""

    path: str
    line: int
    old: str
    new: str | None  # None: the line is missing

    def of(self, built: Build) -> Build:
        """Return the build with the fault in place."""
        artifacts = tuple(
            replace(artifact, text=self._in(artifact.text)) if artifact.path == self.path else artifact
            for artifact in built.artifacts
        )
        return replace(built, artifacts=artifacts)

    def _in(self, text: str) -> str:
        lines = text.splitlines(keepends=True)
        lines[self.line - 1 : self.line] = [] if self.new is None else [self.new + "\n"]
        return "".join(lines)


def corruptions(built: Build, seed: int, count: int) -> Iterator[Corruption]:
    """Yield faults, the files in turn so that a long one does not hide the rest; comments and blanks are left alone."""
    chance = random.Random(seed)
    files = sorted(built.texts.items())
    for number in range(count):
        path, text = files[number % len(files)]
        lines = [(at, line) for at, line in enumerate(text.splitlines(), 1) if _says_something(line, at)]
        at, line = chance.choice(lines)
        yield Corruption(path, at, line, _changed(line, chance))


def _says_something(line: str, at: int) -> bool:
    """Whether a line is more than the head of its file, a comment or a lone bracket."""
    return (
        at > 5 and re.search(r"\w{2}|\d", line) is not None and not line.lstrip().startswith(("#", "<!--", "%%", "</"))
    )


def _changed(line: str, chance: random.Random) -> str | None:
    numbers = list(re.finditer(r"(?<![\w.])\d+(?:\.\d+)?(?![\w.])", line))
    names = list(re.finditer(r"[A-Za-z_]{3,}", line))
    kinds = ["missing", *(["number"] if numbers else []), *(["name"] if names else [])]
    kind = chance.choice(kinds)
    if kind == "missing":
        return None
    found = chance.choice(numbers if kind == "number" else names)
    text = found.group()
    if kind == "number":
        new = f"{float(text) + 1}" if "." in text else str(int(text) + 1)
    else:
        middle = len(text) // 2
        new = text[:middle] + ("x" if text[middle] != "x" else "y") + text[middle + 1 :]
    return line[: found.start()] + new + line[found.end() :]
