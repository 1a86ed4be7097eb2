"""As much of a spec with errors as can be linked: what has an error is taken out until the rest holds together."""

from __future__ import annotations

import os
from collections.abc import Container, Iterable, Iterator
from pathlib import Path, PurePosixPath

from cellc.compiler.cell.cell import Cell
from cellc.compiler.link.link import link
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.document import Node, Plain
from cellc.compiler.spec.parse import parse
from cellc.compiler.spec.wording import could_mean
from cellc.contract.diagnostics import Diagnostic, Severity, YamlPath
from cellc.contract.vocabulary import Distro
from cellc.tools.view.standing import Wanted

_ROUNDS = 30
"""What is taken out may be missed elsewhere; after so many rounds the rest is left alone."""
_NAMED: tuple[YamlPath, ...] = (("devices",), ("frames",), ("scene",), ("motion", "poses"), ("motion", "goals"))
"""Sections whose entries have a name in the drawing."""
_BESIDE = frozenset(("since", "designed", "reference_points", "rate", "buffer", "published_by", "kind", "transform_at"))
"""What an entry may lose and still stand where it is written to stand."""
_PLACING = ("parent", "xyz", "rpy", "box", "frame", "group")
_NO_DEVICE = "no_device"
_STAND_INS: dict[str, Plain] = {
    "format": 1,
    "cell": "cell",
    "versions": {"ros": tuple(Distro)[-1].value},
    "devices": {_NO_DEVICE: {"model": "./no_device"}},
}
"""Sections that a spec cannot do without, and a drawing can."""


def cell_as_far(path: Path) -> tuple[Cell | None, Wanted]:
    """Link a spec without what has an error.

    Returns:
        The cell, None where the text cannot be read or too little is left of it; and what the whole spec names.
    """
    source = read(path)
    if source.value is None or not source.ok:
        return None, {}
    document, cell = source.value, None
    paths = frozenset(_keys(document.root))
    wanted: dict[YamlPath, Diagnostic | None] = dict.fromkeys(_named(document))
    for _ in range(_ROUNDS):
        cell, errors = _linked(document)
        places = {_place(document, diagnostic): diagnostic for diagnostic in reversed(errors)}
        wanted |= {
            place: error
            for place, error in places.items()
            if place in wanted and not (document is not source.value and _follows(error, paths))
        }
        smaller = _without(document, (pair for pair in places if pair))
        if smaller is document:
            break
        document = smaller
    return cell, wanted


def _follows(error: Diagnostic, written: Container[str]) -> bool:
    """Tell whether something is unknown only because it was taken out before."""
    _, _, named = error.message.partition("`")
    name = named.partition("`")[0].partition("/")[0]
    return error.code.startswith("unknown-") and (not name or name in written)


def _keys(node: Node) -> Iterator[str]:
    for key, child in node.children.items():
        yield str(key)
        yield from _keys(child.node)


def _named(document: SourceDocument) -> Iterator[YamlPath]:
    for section in _NAMED:
        node = document.root
        for key in section:
            node = node.children[key].node if key in node.children else Node(node.span, {})
        yield from ((*section, name) for name in node.children)


def _linked(document: SourceDocument) -> tuple[Cell | None, tuple[Diagnostic, ...]]:
    spec = parse(document)
    if spec.value is None:
        return None, spec.diagnostics
    devices = {name: device for name, device in spec.value.devices.items() if name != _NO_DEVICE}
    cell = link(spec.value.model_copy(update={"devices": devices}), document)
    return cell.value, tuple(diagnostic for diagnostic in cell.diagnostics if diagnostic.severity is Severity.ERROR)


def _without(document: SourceDocument, places: Iterable[YamlPath]) -> SourceDocument:
    """Take out what has an error, and put in what no spec can be linked without; the same document if nothing is."""
    for place in sorted(places, reverse=True):  # behind before in front, so that indices hold
        document = document.without(place) if document.has(place) else document
    for key, value in _STAND_INS.items():
        document = document if document.has((key,)) else document.with_value(key, value)
    return document


def _place(document: SourceDocument, error: Diagnostic) -> YamlPath:
    """Return what an error takes along: the value, or every entity whose pose depends on it."""
    path = error.yaml_path or _device_of(document, error.span.file)
    for section in (*_NAMED, ("areas",)):
        length = len(section) + 1
        if path[: length - 1] == section and _moves(document, path, length, error.code):
            path = path[:length]
    while not document.has(path):
        path = path[:-1]
    return path


def _moves(document: SourceDocument, path: YamlPath, length: int, code: str) -> bool:
    """Tell whether an entry would stand elsewhere without the value of a path."""
    if path[0] == "devices":
        if path[2:3] != ("mount",):
            return path[2:] == ("model",)
        length = 3
    entry, key = path[:length], str(path[length]) if len(path) > length else ""
    if code == "unknown-key":
        return any(could_mean(key, text) for text in _PLACING)
    return key not in _BESIDE and not (key == "calibration" and document.has((*entry, "xyz")))


def _device_of(document: SourceDocument, file: str) -> YamlPath:
    """Return the device in whose folder a file lies."""
    for name in (named[1] for named in _named(document) if named[0] == "devices"):
        path: YamlPath = ("devices", name, "model")
        beside = os.path.dirname(document.locate(path).file)
        folder = PurePosixPath(os.path.normpath(os.path.join(beside, document.text_at(path))))
        if folder in PurePosixPath(os.path.normpath(file)).parents:
            return path[:2]
    return ()
