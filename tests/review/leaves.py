"""Every scalar of a spec, and what else it may be: another figure, another of the words and names that fit there."""

from __future__ import annotations

import datetime
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from cellc.compiler.pipeline import Checked, check
from cellc.compiler.source.document import Node, SourceDocument
from cellc.contract.diagnostics import Span, YamlPath
from tests.cells import EVERY_CELL, ROOT, document_of, spec_of

_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?![\w.:/]*[.:/]\d)")
_DATE = re.compile(r"\d{4}-\d\d-\d\d")
_NAMING = ("devices", "nodes", "hosts", "calibrations", "frames", "control", "motion", "interfaces", "scene")
_MOST_TRIED = 40


@dataclass(frozen=True, slots=True)
class SpecLeaf:
    """A scalar of the spec of a cell, by its path."""

    cell: str
    path: YamlPath
    text: str

    @property
    def name(self) -> str:
        """The path as people write it."""
        return f"{self.cell}: {'.'.join(map(str, self.path))}"

    @property
    def key(self) -> str:
        """The last key of the path; an entry of a list has that of the list."""
        return next((part for part in reversed(self.path) if isinstance(part, str)), "")


def leaves_of(cell: str) -> Iterator[SpecLeaf]:
    """Yield every scalar of a cell of the repository, in the order of the file."""
    yield from (SpecLeaf(cell, path, node.text) for path, node in _scalars(_document(cell).root))


def changed(leaf: SpecLeaf) -> tuple[str, Checked] | None:
    """Return the first other value of a leaf with which the cell is without errors; None where none of them is."""
    document = _document(leaf.cell)
    tried = [text for text in dict.fromkeys(_candidates(leaf, document)) if text != leaf.text]
    for text in tried[:_MOST_TRIED]:
        checked = check(document.file, _edited(document, leaf.path, text))
        if checked.ok:
            return text, checked
    return None


def with_text(leaf: SpecLeaf, text: str) -> Checked:
    """Return the cell with another text of a leaf, checked."""
    document = _document(leaf.cell)
    return check(document.file, _edited(document, leaf.path, text))


def with_texts(texts: Mapping[SpecLeaf, str]) -> Checked:
    """Return a cell with other texts of several leaves, checked."""
    (cell,) = {leaf.cell for leaf in texts}
    document = _document(cell)
    # From the end, so that the places before stay where they are.
    last_first = sorted(texts, key=lambda leaf: _place(document.locate(leaf.path)), reverse=True)
    sources: Mapping[str, str] = document.texts
    for leaf in last_first:
        sources = _edited(document, leaf.path, texts[leaf], sources)
    return check(document.file, dict(sources))


def _place(span: Span) -> tuple[int, int]:
    return span.line, span.column


@cache
def _document(cell: str) -> SourceDocument:
    return document_of(spec_of(cell))


def _scalars(node: Node, path: YamlPath = ()) -> Iterator[tuple[YamlPath, Node]]:
    for key, child in node.children.items():
        if child.node.is_collection:
            yield from _scalars(child.node, (*path, key))
        else:
            yield (*path, key), child.node


def _edited(
    document: SourceDocument, path: YamlPath, text: str, texts: Mapping[str, str] | None = None
) -> dict[str, str]:
    texts = document.texts if texts is None else texts
    span = document.locate(path)
    lines = texts[span.file].split("\n")
    line = lines[span.line - 1]
    assert span.line == span.end_line, path
    lines[span.line - 1] = line[: span.column - 1] + text + line[span.end_column - 1 :]
    return {**texts, span.file: "\n".join(lines)}


def _candidates(leaf: SpecLeaf, document: SourceDocument) -> Iterator[str]:
    """Yield other values, the likeliest first; what is none of its type is refused by the check."""
    if leaf.text in ("true", "false"):
        yield "false" if leaf.text == "true" else "true"
        return
    yield from _of_schema().get(leaf.key, ())
    yield from _numbers(leaf.text)
    yield from _beside(leaf.key)
    yield from _names(document)
    yield from _texts(leaf.text)


def _numbers(text: str) -> Iterator[str]:
    dates = _DATE.fullmatch(text)
    if dates:
        for days in (1, -1):
            yield (datetime.date.fromisoformat(text) + datetime.timedelta(days)).isoformat()
        return
    for match in reversed(list(_NUMBER.finditer(text))):
        value = float(match[0])
        whole = "." not in match[0]
        steps = (value + 1, value - 1, value * 2) if whole else ()
        for other in (*steps, value * 1.05, value * 0.95, value * 1.5, value * 0.5, value + 1, value - 1):
            shown = f"{other:.6g}"
            yield f"{text[: match.start()]}{shown}{text[match.end() :]}"


def _texts(text: str) -> Iterator[str]:
    counted = re.search(r"\d+(?=\D*$)", text)
    if counted:
        yield f"{text[: counted.start()]}{int(counted[0]) + 1}{text[counted.end() :]}"
    yield from (f"{text}_b", f"{text} too", f"{text}b", f"/b{text}")
    yield "UNKNOWN"


@cache
def _beside(key: str) -> Sequence[str]:
    """Return what any spec of the repository says under a key of that name."""
    return tuple(dict.fromkeys(leaf.text for cell in EVERY_CELL for leaf in leaves_of(cell) if leaf.key == key))


def _names(document: SourceDocument) -> Iterator[str]:
    """Yield the names of the things of a spec, and the paths that it has in other places."""
    data: Any = document.data
    for section in _NAMING:
        held = data.get(section, {})
        for part in (held, *(inner for inner in held.values() if section in ("control", "motion"))):
            yield from (name for name in part if isinstance(part, dict))
    yield from (node.text for _, node in _scalars(document.root) if re.fullmatch(r"\w+/[\w/]+", node.text))


@cache
def _of_schema() -> dict[str, tuple[str, ...]]:
    """Return the words of each key that has a list of them."""
    schema = json.loads((ROOT / "schemas" / "cell.schema.json").read_text(encoding="utf-8"))
    found: dict[str, dict[str, None]] = {}

    def enumerated(part: Any) -> Iterator[str]:
        if isinstance(part, dict):
            yield from map(str, part.get("enum", ()))
            yield from ([str(part["const"])] if "const" in part else ())
            reference = str(part.get("$ref", "")).rpartition("/")[2]
            if reference and "enum" in schema["$defs"][reference]:
                yield from map(str, schema["$defs"][reference]["enum"])
            for inner in ("anyOf", "oneOf"):
                for option in part.get(inner, ()):
                    yield from enumerated(option)
            yield from enumerated(part.get("items"))

    def walk(part: Any) -> None:
        if isinstance(part, dict):
            for key, inner in part.get("properties", {}).items():
                found.setdefault(key, {}).update(dict.fromkeys(enumerated(inner)))
            for inner in part.values():
                walk(inner)
        elif isinstance(part, list):
            for inner in part:
                walk(inner)

    walk(schema)
    return {key: tuple(words) for key, words in found.items() if words}
