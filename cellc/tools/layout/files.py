"""The canonical form of files as a user names them: of a spec with what it includes, of a device, of standard input."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from cellc.compiler.source.compose import compose
from cellc.compiler.source.read import link_out, not_a_mapping, read
from cellc.compiler.source.text import read_text, text_of
from cellc.contract.diagnostics import Diagnostic, Span
from cellc.tools.layout.layout import formatted


@dataclass(frozen=True, slots=True)
class Taken:
    """A file as it is and in its canonical form, with line breaks as ``\\n``; with findings it has none."""

    name: str
    before: str = ""
    after: str = ""
    findings: tuple[Diagnostic, ...] = ()

    @property
    def changes(self) -> bool:
        """Whether the file is not in its form."""
        return not self.findings and self.before != self.after


def take_file(file: str) -> Taken:
    """Read a file, and bring its text into form."""
    name = file.replace(os.sep, "/")
    escape = link_out(Path(file), name)
    if escape is not None:
        return Taken(name, findings=(escape,))
    text = read_text(Path(file), name, Span(name, 1, 1, 1, 1))
    return _taken(name, text.value, text.diagnostics)


def take_content(content: bytes, name: str) -> Taken:
    """Format a content that was passed instead of a file."""
    text = text_of(content, name)
    return _taken(name, text.value, text.diagnostics)


def with_includes(spec: str) -> tuple[str, ...]:
    """Return a spec and every file that it includes; itself alone where it cannot be read."""
    document = read(spec).value
    return tuple(dict.fromkeys((spec, *(document.texts if document is not None else ()))))


def _taken(name: str, text: str | None, findings: tuple[Diagnostic, ...]) -> Taken:
    if text is None or findings:
        return Taken(name, text or "", findings=findings)
    root = compose(name, text).value
    other = not_a_mapping(name, root) if root is not None and root.data is not None else None
    if other is not None:  # a text of any kind is YAML of one value
        return Taken(name, text, findings=(other,))
    text_in_form = formatted(name, text)
    return Taken(name, text, text_in_form.value or "", text_in_form.diagnostics)
