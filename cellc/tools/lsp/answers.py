"""Answers about a position in a cell: what it is, where it is declared, which completions fit, how to fix it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from cellc.compiler.cell.cell import Cell
from cellc.compiler.formats.escape import code
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.source.compose import compose
from cellc.compiler.source.document import Node, SourceDocument
from cellc.compiler.source.include import INCLUDE
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.meanings import meaning_of_word
from cellc.compiler.spec.wording import value_at
from cellc.contract.diagnostics import Diagnostic, Span, YamlPath
from cellc.tools.lsp.cards import card, limits_table, words_table
from cellc.tools.lsp.cursor import Here, Typed, here, typed_at
from cellc.tools.lsp.fields import annotation_at, keys_at, meaning_of, quantity_of, root_model, takes_a_frame, words_of
from cellc.tools.lsp.names import Names, kinds_at, names_of
from cellc.tools.lsp.parts import place_of_part
from cellc.tools.lsp.units import in_other_units
from cellc.tools.report.resolved import flatten, resolved_at, resolved_tree

_MOST_ROWS = 12


@dataclass(frozen=True, slots=True)
class Known:
    """What the last check of a cell left: the text may have gone on since.

    Args:
        document: the last that could be read.
        cell: the last that could be linked.
    """

    document: SourceDocument | None = None
    cell: Cell | None = None
    names: Names = field(default_factory=Names)

    def with_more(self, document: SourceDocument | None, cell: Cell | None) -> Known:
        """Return what is known after another check, of which either may be missing."""
        document, cell = document or self.document, cell or self.cell
        return Known(document, cell, self.names if document is None else names_of(document, cell))


@dataclass(frozen=True, slots=True)
class Proposal:
    """A word that may stand at a place."""

    word: str
    kind: str
    meaning: str = ""


@dataclass(frozen=True, slots=True)
class Symbol:
    """A section or a name in it."""

    name: str
    detail: str
    span: Span
    inner: tuple[Symbol, ...] = ()


def hover(text: str, line: int, column: int, known: Known) -> tuple[str, Span] | None:
    """Return what is known of the key or value at a place, as Markdown: meaning, SI value, what cellc uses and why."""
    root = compose("", text).value
    place = here(root, line, column) if root is not None else None
    if root is None or place is None:
        return None
    parts = [f"**{code(str(place.path[-1]))}**", meaning_of(root.data, _field(place.path))]
    annotation = annotation_at(root.data, place.path)
    parts += list(_of_the_value(annotation, place)) if not place.is_key else []
    parts.append(words_table(annotation, str(_field(place.path)[-1])))
    if root_model(root.data) is CellSpec:
        model = str(value_at(root.data, place.path)) if place.path[-1] == "model" else ""
        parts.append(card(model) if model else "")
        parts += [] if known.cell is None else [limits_table(known.cell, place.path), _uses(known.cell, place.path)]
    return "\n\n".join(part for part in parts if part), place.span


def _of_the_value(annotation: object, place: Here) -> Iterator[str]:
    quantity = quantity_of(annotation, place.text)
    others = () if quantity is None else in_other_units(quantity[1])
    if others:
        yield f"{code(place.text)} is {', or '.join(others)}."
    meaning = meaning_of_word(str(_field(place.path)[-1]), place.text)
    if meaning and place.text in words_of(annotation):
        yield f"{code(place.text)}: {meaning}."


def _uses(cell: Cell, path: YamlPath) -> str:
    leaves = [item for tree, name in resolved_at(resolved_tree(cell), path) for item in flatten(tree, name)]
    rows = [(code(name), code(leaf.text or " "), leaf.origin) for name, leaf in leaves[:_MOST_ROWS]]
    more = len(leaves) - _MOST_ROWS
    rows += [(f"{more} more", "", "`cellc show`")] if more > 0 else []
    return table(("cellc uses", "", "from"), rows) if rows else ""


def definition(text: str, line: int, column: int, known: Known, file: Path) -> Span | None:
    """Return where what is named at a place is written: in the spec, an included file, a device, its description."""
    root = compose("", text).value
    target = here(root, line, column) if root is not None else None
    if target is None:
        return None
    if target.path[0] == INCLUDE:
        return _top(file.parent / target.text)
    if target.path[-1] == "model" and not target.is_key:
        return _device(target.text, file)
    if target.is_key and not kinds_at(target.path[:-1]):
        return None
    kinds, owner = kinds_at(_field(target.path)), target.text.partition("/")[0]
    place = known.names.place_of(target.text, kinds)
    if place is None and owner != target.text:
        at_part = column - target.span.column > len(owner)
        part = place_of_part(known.cell, target.text, kinds) if at_part and known.cell is not None else None
        if part is not None:
            return part
        place = known.names.place_of(owner, ("device",))
    return known.document.locate_key(place) if place is not None and known.document is not None else None


def _device(model: str, file: Path) -> Span | None:
    from cellc.compiler.catalog.compiled import DEVICE_FILE, device_file

    if model.startswith("."):
        return _top(file.parent / model / DEVICE_FILE)
    try:
        return _top(device_file(model))
    except KeyError:
        return None


def _top(file: Path) -> Span | None:
    return Span(file.as_posix(), 1, 1, 1, 1) if file.is_file() else None


def completions(text: str, line: int, column: int, known: Known) -> list[Proposal]:
    """Return the proposals that fit a position, in the order of the reference or of the spec."""
    proposals = (_keys(item, known) if item.is_key else _values(item, known) for item in typed_at(text, line, column))
    return list(dict.fromkeys(proposal for each in proposals for proposal in each))


def _keys(typed: Typed, known: Known) -> Iterator[Proposal]:
    for key in keys_at(typed.data, typed.path):
        meaning = f"{key.meaning}\n\nExample: `{key.example}`" if key.example else key.meaning
        yield Proposal(key.name, "required key" if key.required else "key", meaning)
    # The keys of a mapping such as `to: {task: …}` are names themselves.
    if typed.path and not isinstance(typed.path[-1], int):
        yield from (Proposal(name, kind) for name, kind in known.names.of(kinds_at(typed.path)))


def _values(typed: Typed, known: Known) -> Iterator[Proposal]:
    annotation = annotation_at(typed.data, typed.path)
    key = next((part for part in reversed(typed.path) if isinstance(part, str)), "")
    for word in words_of(annotation):
        yield Proposal(word, "word", meaning_of_word(key, word))
    if key == "model" and typed.path[0] == "devices":
        yield from _models()
    elif key == "type" and "controllers" in typed.path:
        yield from _controller_types(known)
    kinds = kinds_at(typed.path) or (("frame",) if takes_a_frame(annotation) else ())
    yield from (Proposal(name, kind) for name, kind in known.names.of(kinds))


def _models() -> Iterator[Proposal]:
    from cellc.tools.browse.search import entries

    return (Proposal(entry.model.model, "device", entry.model.summary) for entry in entries())


def _controller_types(known: Known) -> Iterator[Proposal]:
    from cellc.compiler.catalog.load import controller_kinds

    yield from (Proposal(kind, "controller") for kind in controller_kinds())
    for device in known.cell.devices if known.cell is not None else ():
        own = device.control.controller_kinds
        here = (kind for kind, distros in own.items() if known.cell is None or known.cell.distro in distros)
        yield from (Proposal(kind, f"controller of {device.name}") for kind in here)


def symbols(text: str) -> list[Symbol]:
    """Return the sections of a file and the names in them."""
    root = compose("", text).value
    return [] if root is None else list(_symbols(root, 2))


def _symbols(node: Node, depth: int) -> Iterator[Symbol]:
    for name, child in node.children.items():
        if child.key_span is not None:
            inner = tuple(_symbols(child.node, depth - 1)) if depth > 1 else ()
            detail = "" if child.node.is_collection else re.sub(r"\s+", " ", child.node.text)
            yield Symbol(str(name), detail, child.key_span, inner)


def by_file(diagnostics: Iterable[Diagnostic]) -> dict[str, list[Diagnostic]]:
    """Return findings by the file that they point into."""
    files: dict[str, list[Diagnostic]] = {}
    for item in diagnostics:
        files.setdefault(item.span.file, []).append(item)
    return files


def _field(path: YamlPath) -> YamlPath:
    """Return the path without indices at its end: of an item, that of its list."""
    while path and isinstance(path[-1], int):
        path = path[:-1]
    return path
