"""Which stated figures enter the message of a finding: each is changed a little, and the message is read again.

All figures are changed at once, each by another factor; where the message says the same, none of them enters. Else
the half that does is looked for, so that a rule takes a dozen checks instead of one for each figure of the cell.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from cellc.compiler.graph.cell_graph import build_graph
from cellc.compiler.link.link import link
from cellc.compiler.rules.kit import Finding, Rule
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.document import Node
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import YamlPath
from tests.cells import document_of

_FIGURE = re.compile(r"(?<![\w.:/-])-?\d+(?:\.\d+)?(?![\w.:/-]*[.:/-]\d)(?=$| |,)")
_WHOLE = re.compile(r"-?\d+")


@dataclass(frozen=True, slots=True)
class Figure:
    """A scalar of a spec that is a number, or numbers with a unit, and its text when changed a little."""

    path: YamlPath
    line: int
    changed: str


def figures(document: SourceDocument) -> list[Figure]:
    """Return the figures of a spec with what each is changed to; an integer without a unit becomes the next."""
    found = []
    for number, (path, node) in enumerate(_scalars(document.root)):
        if re.match(r"[-\d]", node.text) and _FIGURE.search(node.text) and path != ("format",):
            factor = 1.013 + 0.0017 * (number % 17)
            if _WHOLE.fullmatch(node.text):
                changed = str(int(node.text) + 1)
            else:
                changed = _FIGURE.sub(partial(_times, factor), node.text)
            found.append(Figure(path, document.locate(path).line, changed))
    return found


def _times(factor: float, match: re.Match[str]) -> str:
    return f"{float(match[0]) * factor:.6g}"


def _scalars(node: Node, path: YamlPath = ()) -> Iterator[tuple[YamlPath, Node]]:
    for key, child in node.children.items():
        if child.node.is_collection:
            yield from _scalars(child.node, (*path, key))
        else:
            yield (*path, key), child.node


class Blame:
    """Of the findings of one rule in one spec."""

    def __init__(self, rule: Rule, spec: Path) -> None:
        """Bind a rule and a spec that it finds something in."""
        self._rule = rule
        self._document = document_of(spec)
        self.findings = tuple(finding for finding in self._found(()) or () if _shows_a_figure(finding))

    def entering(self, index: int) -> Iterator[Figure]:
        """Yield the figures whose change changes the message of a finding."""
        yield from self._halves(figures(self._document), self.findings[index])

    def _halves(self, some: Sequence[Figure], finding: Finding) -> Iterator[Figure]:
        if not some or self._says_the_same(some, finding):
            return
        if len(some) == 1:
            yield from some
            return
        middle = len(some) // 2
        yield from self._halves(some[:middle], finding)
        yield from self._halves(some[middle:], finding)

    def _says_the_same(self, some: Sequence[Figure], finding: Finding) -> bool:
        """Whether the finding has its message, or is gone; a part of figures that no cell links with is looked into."""
        found = self._found(some)
        if found is None:
            return len(some) == 1
        there = [other for other in found if other.path == finding.path and _words(other) == _words(finding)]
        gone = not there and len(some) == 1
        return gone or any(other.message == finding.message for other in there)

    def _found(self, some: Sequence[Figure]) -> list[Finding] | None:
        file = self._document.file
        lines = self._document.texts[file].split("\n")
        for figure in some:
            span = self._document.locate(figure.path)
            line = lines[span.line - 1]
            lines[span.line - 1] = line[: span.column - 1] + figure.changed + line[span.end_column - 1 :]
        document = read(file, {**self._document.texts, file: "\n".join(lines)}).value
        spec = None if document is None else parse(document)
        if document is None or spec is None or spec.value is None or not spec.ok:
            return None
        cell = link(spec.value, document)
        return None if cell.value is None or not cell.ok else list(self._rule.check(build_graph(cell.value)))


def _shows_a_figure(finding: Finding) -> bool:
    return re.search(r"\d", re.sub(r"`[^`]*`", "", finding.message)) is not None


def _words(finding: Finding) -> str:
    """Return a message without its figures."""
    return re.sub(r"\d+(\.\d+)?(e-?\d+)?", "", finding.message)


def is_named(figure: Figure, finding: Finding, document_lines: dict[int, YamlPath]) -> bool:
    """Whether a finding shows the line of a figure, or of the value that it is a part of."""
    shown = [finding.span.line, *(related.span.line for related in finding.related)]
    paths = [document_lines.get(line, ()) for line in shown]
    return figure.line in shown or any(path and figure.path[: len(path)] == path for path in paths)


def lines_of(spec: Path) -> dict[int, YamlPath]:
    """Return the outermost path of each line of a spec."""
    document = document_of(spec)
    lines: dict[int, YamlPath] = {}
    for path in _paths(document.root):
        lines.setdefault(document.locate(path).line, path)
    return lines


def _paths(node: Node, path: YamlPath = ()) -> Iterator[YamlPath]:
    for key, child in node.children.items():
        yield (*path, key)
        yield from _paths(child.node, (*path, key))
