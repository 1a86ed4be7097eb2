"""A spec with another version tuple, edited in memory: nothing of it is written, and everything of it is checked."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from pydantic import ValidationError

from cellc.compiler.catalog.load import load_distros
from cellc.compiler.catalog.tables import DistroFacts
from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph.versions import Pin
from cellc.compiler.link.link import link
from cellc.compiler.pipeline import Checked, check
from cellc.compiler.source import read
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import Span
from cellc.contract.errors import CellcError
from cellc.contract.stated import Versions
from cellc.contract.vocabulary import Distro
from cellc.tools.edit.rewrite import Edit, apply_edits
from cellc.tools.review.tuples import moved_pins

_SCALAR = re.compile(r"((?:[&!]\S* +)*)(.*)")

_Place = tuple[str, int, int]
"""File, line and column."""

PARTS = tuple(name for name in Versions.model_fields if name != "rollback")
"""The parts of the tuple that belong to the whole cell."""


class UpgradeError(CellcError):
    """The spec cannot be moved to another tuple; the text is one line, lower case."""


def unusable(part: str, text: str) -> str:
    """Say why a text is no value of a part of the tuple; empty where it is one."""
    if part not in PARTS:
        return f"expected one of {', '.join(PARTS)}, got `{part}`"
    distros = [distro.value for distro in Distro]
    if part == "ros" and text not in distros:
        return f"`ros` must be one of {', '.join(distros)}, got `{text}`"
    try:
        Versions.model_validate({"ros": distros[0], part: text})
    except ValidationError as problem:
        return f"`{part}` cannot be `{text}`: {problem.errors()[0]['msg'].lower()}"
    return ""


def check_with(file: str, wanted: Mapping[str, str]) -> Checked:
    """Check a spec as if parts of its tuple were others; what goes with a distribution moves as in `cellc upgrade`.

    Args:
        wanted: part → its text; of an implementation of the middleware the name is enough.

    Raises:
        UpgradeError: the spec cannot be edited.
    """
    document = read(file)
    cell = _linked(document.value) if document.ok else None
    if cell is None or document.value is None:
        return check(file)  # which says why
    target = Distro(wanted.get("ros", cell.distro.value))
    facts = facts_of_distro(target)
    moves = () if target is cell.distro else moved_pins(cell, target, facts)
    texts = {move.pin: move.text for move in moves}
    for part, text in wanted.items():
        path = ("versions", part)
        if not cell.states(*path):
            raise UpgradeError(f"{file}: `versions.{part}` must be in the spec to be replaced; UNKNOWN is enough")
        texts[Pin(cell.name, part, cell.text(*path), path)] = _whole(part, text, facts)
    _, moved = edited_check(file, cell, document.value.texts, tuple(texts.items()))
    return moved or check(file)


def _linked(document: SourceDocument | None) -> Cell | None:
    spec = None if document is None else parse(document)
    if document is None or spec is None or spec.value is None or not spec.ok:
        return None
    cell = link(spec.value, document)
    return cell.value if cell.ok else None


def _whole(part: str, text: str, facts: DistroFacts) -> str:
    return f"{text} {facts.packages[text]}" if part == "rmw" and text in facts.packages else text


def facts_of_distro(target: Distro) -> DistroFacts:
    """Return what the catalog knows of a distribution."""
    table = load_distros().value
    assert table is not None  # package data, held valid by the catalog's tests
    return next(facts for name, facts in table.distros.items() if name == target)


def edited_check(
    file: str, cell: Cell, texts: Mapping[str, str], pins: Sequence[tuple[Pin, str]]
) -> tuple[tuple[Edit, ...], Checked | None]:
    """Return the edits that give pins other texts, and what the check says then; None where nothing is edited.

    Args:
        texts: of the files of the spec.

    Raises:
        UpgradeError: a pin cannot be edited by itself.
    """
    edits = tuple(_edits(cell, pins, texts))
    if not edits:
        return edits, None
    moved = check(file, _edited(edits, texts))
    _hold(pins, moved)
    return edits, moved


def _edits(cell: Cell, pins: Sequence[tuple[Pin, str]], texts: Mapping[str, str]) -> Iterator[Edit]:
    """Yield the edit of each text that pins become another by; an alias becomes what its anchor does by itself."""
    taken: dict[_Place, str] = {}
    spans = {pin: cell.locate(*pin.path) for pin, _ in pins if cell.states(*pin.path)}
    becomes = {_place(spans[pin]): text for pin, text in pins if pin in spans}
    for pin, text in pins:
        if pin not in spans:
            continue
        span = spans[pin]
        place = _place(span)
        anchor = _anchor(span, texts[span.file].split("\n"))
        if text == (pin.text if anchor is None else becomes.get(anchor, pin.text)) or taken.get(place) == text:
            continue
        if span.line != span.end_line:
            raise UpgradeError(f"{span}: `{pin.part}` spans several lines; write it in one")
        if taken.setdefault(place, text) != text:
            raise UpgradeError(f"{span}: one text pins several parts that get different versions; write each out")
        said = f"`{pin.part}` of `{pin.holder}`: `{pin.text}` becomes `{text}`"
        yield Edit(*place, span.end_column, _as_yaml(text, _written(span, texts[span.file].split("\n"))), said)


def _place(span: Span) -> _Place:
    return span.file, span.line, span.column


def _written(span: Span, lines: Sequence[str]) -> str:
    return lines[span.line - 1][span.column - 1 : span.end_column - 1]


def _anchor(span: Span, lines: Sequence[str]) -> _Place | None:
    """Return where the anchor of an alias is written; None for what is no alias."""
    text = _written(span, lines)
    if not text.startswith("*"):
        return None
    before = (*lines[: span.line - 1], lines[span.line - 1][: span.column - 1])
    named = re.compile(rf"&{re.escape(text[1:])}(?=[\s,\]}}]|$)")
    for number in range(len(before), 0, -1):
        columns = [match.start() + 1 for match in named.finditer(before[number - 1])]
        if columns:
            return span.file, number, columns[-1]
    return None


def _as_yaml(text: str, written: str) -> str:
    """Return a scalar in place of another, with its anchor and its quotes; in quotes where it would be a number."""
    match = _SCALAR.fullmatch(written)
    before, value = ("", written) if match is None else match.groups()
    quote = value[:1] if value[:1] in ("'", '"') else ""
    if not quote and re.fullmatch(r"[-+]?[0-9.]+([eE][-+]?[0-9]+)?", text) and text.count(".") < 2:
        quote = '"'
    return f"{before}{quote}{text}{quote}"


def _edited(edits: Sequence[Edit], texts: Mapping[str, str]) -> dict[str, str]:
    files = {edit.file for edit in edits}
    return {file: apply_edits(texts[file], (edit for edit in edits if edit.file == file)) for file in files}


def _hold(pins: Sequence[tuple[Pin, str]], moved: Checked) -> None:
    """Refuse an edit that says something else than was meant; where nothing is linked, findings say why."""
    if moved.graph is None:
        return
    cell = moved.graph.cell
    for pin, text in pins:
        if cell.states(*pin.path) and cell.text(*pin.path) != text:
            raise UpgradeError(f"{cell.locate(*pin.path)}: `{pin.part}` cannot be edited by itself")
