"""A file beside the spec that somebody else's tool wrote: bounded, inside the spec's folder, and text alone."""

from __future__ import annotations

import hashlib
import math
import os
import re
from pathlib import Path

from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.source.text import bytes_of, lies_under, text_of
from cellc.contract.diagnostics import Diagnostic, Outcome, Severity, Span, YamlPath
from cellc.contract.frozen import dataclass

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d{1,3})?")


@dataclass(frozen=True, slots=True)
class SideFile:
    """What was read: ``name`` as reports show it, ``path`` from the root spec's folder, hash of the bytes, the text."""

    name: str
    path: str
    sha256: str
    text: str


def read_side_file(written: str, document: SourceDocument, at: YamlPath) -> Outcome[SideFile]:
    """Read a file that the spec names at a path, relative to the file that names it."""
    place = document.locate(at)
    file = Path(place.file).parent / written
    shown = file.as_posix()
    if not lies_under(file, Path(document.file).parent):
        message = f"`{shown}` leads out of the folder of the spec"
        advice = "copy the file beside the spec"
        return Outcome(None, (Diagnostic("include-escape", Severity.ERROR, message, place, at, advice),))
    content = bytes_of(file, shown, place)
    if isinstance(content, Diagnostic):
        return Outcome(None, (content,))
    text = text_of(content, shown)
    if text.value is None or text.diagnostics:
        return Outcome(None, text.diagnostics)
    from_root = os.path.relpath(file, Path(document.file).parent).replace(os.sep, "/")
    return Outcome(SideFile(shown, from_root, hashlib.sha256(content).hexdigest(), text.value))


def compose_side_file(file: SideFile) -> Outcome[SourceDocument]:
    """Return the data of a file in YAML or JSON, each value with its place."""
    root = compose(file.name, file.text)
    if root.value is None or root.diagnostics:
        empty = Diagnostic("empty-file", Severity.ERROR, f"`{file.name}` holds no data", Span(file.name, 1, 1, 1, 1))
        return Outcome(None, root.diagnostics or (empty,))
    return Outcome(SourceDocument(file.name, {file.name: file.text}, root.value))


def number(text: str, largest: float) -> float:
    """Return a number of a file, where YAML reads `5e-06` as text; NaN for anything else, or beyond any real value."""
    value = float(text) if _NUMBER.fullmatch(text) else math.nan
    return value if abs(value) <= largest else math.nan
