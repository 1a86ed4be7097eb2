"""Read a spec and all that it includes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import Node, SourceDocument
from cellc.compiler.source.findings import finding
from cellc.compiler.source.include import INCLUDE, IncludeLine, include_lines, merge, resolve_include
from cellc.compiler.source.text import as_yaml, lies_under, read_text
from cellc.contract.diagnostics import Diagnostic, Outcome, Span
from cellc.contract.limits import limits


def read(path: str | Path, edited: Mapping[str, str] | None = None) -> Outcome[SourceDocument]:
    """Read a spec, its includes merged in, with the position of every value.

    Args:
        path: the root spec; it appears in every message as given here, with forward slashes.
        edited: texts that are read in place of files, by the name that spans carry: what is not saved yet.

    Returns:
        A document in every case, so that its texts can be shown with the findings; its data is whole only where the
        outcome is ok.
    """
    name = str(path).replace(os.sep, "/") or "."
    reader = _Reader(Path(path), edited or {})
    place = Span(name, 1, 1, 1, 1)
    escape = link_out(Path(path), name)
    if escape is not None:
        reader.findings.append(escape)
    else:
        reader.read(Path(path), name, place)
    findings = list(reader.findings)
    root = Node(Span(name, 1, 1, 1, 1), {})
    if reader.roots:
        merged = merge(reader.roots)
        findings.extend(merged.diagnostics)
        root = merged.value or root
    document = SourceDocument(name, reader.texts, root)
    return Outcome(document, tuple(sorted(findings, key=Diagnostic.sort_key)))


def link_out(path: Path, name: str) -> Diagnostic | None:
    """Return that a file is a link that leads out of its folder; None where it is not."""
    if not os.path.islink(path) or lies_under(path, path.parent):
        return None
    message = f"`{name}` is a link that leads out of its folder"
    return finding("include-escape", message, Span(name, 1, 1, 1, 1), advice="copy the file to this place")


def not_a_mapping(name: str, node: Node) -> Diagnostic | None:
    """Return that the root of a file is something else than a mapping; None where it is one."""
    if isinstance(node.data, dict):
        return None
    kind = "a list" if isinstance(node.data, list) else "a single value"
    return finding("root-not-mapping", f"the root of `{name}` is {kind}, not a mapping of sections", node.span)


class _Reader:
    """The files read so far, and those that are being read."""

    def __init__(self, root: Path, edited: Mapping[str, str]) -> None:
        self.texts: dict[str, str] = {}
        self.roots: list[Node] = []
        self.findings: list[Diagnostic] = []
        self._edited = edited
        self._root_folder = _real(root.parent)
        self._names: dict[Path, str] = {}
        self._active: list[Path] = []
        self._is_full = False

    def read(self, path: Path, name: str, place: Span) -> None:
        """Read one file and, depth first, what it includes; at most `spec-files` of them.

        Args:
            place: the include that names the file, or the start of the root spec.
        """
        real = _real(path)
        self._names[real] = name
        text = as_yaml(self._edited[name], name) if name in self._edited else read_text(path, name, place)
        self.findings.extend(text.diagnostics)
        if text.value is None:
            return
        self.texts[name] = text.value
        if text.diagnostics:
            return
        node = self._compose(name, text.value)
        if node is None:
            return
        self.roots.append(node)
        lines = include_lines(node)
        if isinstance(lines, Diagnostic):
            self.findings.append(lines)
            return
        self._active.append(real)
        for line in lines:
            self._include(line, path.parent, name)
        self._active.pop()

    def _compose(self, name: str, text: str) -> Node | None:
        composed = compose(name, text)
        self.findings.extend(composed.diagnostics)
        if composed.diagnostics:
            return None
        node = composed.value
        if node is None or node.data in (None, {}, []):
            self.findings.append(finding("empty-file", f"`{name}` holds no data", Span(name, 1, 1, 1, 1)))
            return None
        problem = not_a_mapping(name, node)
        if problem is not None:
            self.findings.append(problem)
            return None
        return node

    def _include(self, line: IncludeLine, folder: Path, includer: str) -> None:
        real = resolve_include(line, folder, self._root_folder)
        if isinstance(real, Diagnostic):
            self.findings.append(real)
        elif real in self._active:
            message = f"`{line.path}` includes itself"
            self.findings.append(finding("include-cycle", message, line.span, path=(INCLUDE,)))
        elif real not in self._names:
            self._read_included(line, folder, includer)

    def _read_included(self, line: IncludeLine, folder: Path, includer: str) -> None:
        if len(self._names) < limits().spec_files:
            name = str(PurePosixPath(includer).parent / line.path)
            self.read(folder / line.path, name, line.span)
        elif not self._is_full:
            self._is_full = True
            message = f"more than {limits().spec_files} files belong to one spec"
            self.findings.append(finding("too-many-includes", message, line.span, path=(INCLUDE,), limit="spec-files"))


def _real(path: Path) -> Path:
    try:
        return Path(os.path.realpath(path))
    except (OSError, ValueError):
        # A zero character in the name, say: reading it reports what is wrong.
        return path
