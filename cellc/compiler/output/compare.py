"""Tell how a folder differs from what a build would write, without writing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Literal

from cellc.compiler.artifact import Artifact
from cellc.compiler.output.manifest import MANIFEST
from cellc.compiler.output.plan import content_of, plan
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class Difference:
    """One file that is not as a build would leave it.

    Args:
        path: relative to the folder.
        kind: ``missing``: not there. ``outdated``: as an earlier build wrote it. ``edited``: as no build wrote it.
            ``unexpected``: made by an earlier build, and this one makes none.
        line: first line that differs, counted from 1; 0 where lines were not compared.
        expected: that line as a build writes it, or None past its end.
        found: that line as it is, or None past its end.
    """

    path: str
    kind: Literal["missing", "outdated", "edited", "unexpected"]
    line: int = 0
    expected: str | None = None
    found: str | None = None


def compare(artifacts: Sequence[Artifact], folder: Path) -> tuple[Difference, ...]:
    """Return the differences in the order of paths; none where a build would change nothing.

    Raises:
        OSError: a file cannot be read.
    """
    return tuple(sorted(_differences(artifacts, folder), key=lambda difference: difference.path))


def _differences(artifacts: Sequence[Artifact], folder: Path) -> Iterator[Difference]:
    planned = plan(artifacts, folder)
    for path in planned.remove:
        yield Difference(path, "unexpected")
    for artifact in planned.write:
        content = content_of(folder / artifact.path)
        if content is None:
            yield Difference(artifact.path, "missing")
            continue
        text = content.decode("utf-8", errors="replace")
        line, expected, actual = _first_difference(artifact.content.decode(), text)
        is_edited = artifact.path in planned.edited and artifact.path != MANIFEST
        yield Difference(artifact.path, "edited" if is_edited else "outdated", line, expected, actual)


def _first_difference(expected: str, found: str) -> tuple[int, str | None, str | None]:
    # Split at line feeds alone: a carriage return is a difference, not a line end.
    pairs = zip_longest(expected.split("\n"), found.split("\n"))
    for number, (wanted, actual) in enumerate(pairs, start=1):
        if wanted != actual:
            return number, wanted, actual
    return 0, None, None
