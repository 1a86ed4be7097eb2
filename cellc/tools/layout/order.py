"""The canonical order of keys, and the canonical spelling of quantities, by the models of spec and device."""

from __future__ import annotations

import re
from collections import Counter
from typing import get_args, get_origin

from cellc.compiler.source.document import Plain
from cellc.compiler.source.include import INCLUDE
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.place import chosen, inner, keys_in_order, model_of, required
from cellc.compiler.spec.plant import PlantSpec, spec_model
from cellc.compiler.spec.quantity import QuantityType, spaced
from cellc.tools.layout.tree import Collection, Entry, Scalar, Value, names, plain

_OF_A_DEVICE = frozenset(("model", "family", "vendor", "kind"))
_QUANTITY_BEGINS = re.compile(r"[-+.0-9]")


def put_in_order(root: Value, data: Plain) -> None:
    """Put the keys of a cell in the order of the reference, and those of a device in the order of its schema.

    Args:
        root: is changed.
        data: what the file says, as ``compose`` read it.
    """
    if not isinstance(data, dict):
        return
    if not _OF_A_DEVICE & data.keys():
        _order(root, data, spec_model(data))
        return
    # Of a device or its family. A repository of cells alone is formatted without these models.
    from cellc.compiler.catalog.device_model import DeviceModel

    _order(root, data, DeviceModel)


def _order(value: Value, data: Plain, annotation: object) -> None:
    if isinstance(value, Scalar):
        if isinstance(data, str) and _is_quantity(annotation) and len(value.lines) == 1 and value.block is None:
            value.lines = (_with_spaces(value.lines[0]),)
        return
    annotation = chosen(annotation, data)
    for position, entry in enumerate(value.entries):
        part = position if entry.key is None else plain(entry.key)
        _order(entry.value, _at(data, part), inner(annotation, part))
    model = model_of(annotation)
    if model is None or not value.is_mapping or _is_bound(value.entries):
        return
    keys = keys_in_order(model)
    if model in (CellSpec, PlantSpec):
        # Where a person looks for it: before the sections, of which it brings some.
        keys = tuple(text for key in keys for text in ((INCLUDE, key) if key in ("versions", "cells") else (key,)))
    ranks = {key: rank for rank, key in enumerate(keys)}
    _sort(value, ranks)


def _sort(value: Collection, ranks: dict[str, int]) -> None:
    ordered = sorted(value.entries, key=lambda one: ranks.get(plain(one.key or ""), len(ranks)))
    if ordered != value.entries:
        first, new = value.entries[0], ordered[0]
        # No empty line opens a section, and none is lost.
        if first is not new and new.above[:1] == [""]:
            new.above = new.above[1:]
            first.above = ["", *first.above] if first.above[:1] != [""] else first.above
        value.entries[:] = ordered
        for entry in ordered:
            entry.opens = False


def _is_bound(entries: list[Entry]) -> bool:
    """Whether entries take aliases from each other: an anchor is before its aliases."""
    used = Counter(name for entry in entries for name in set(names(entry.value)))
    return any(count > 1 for count in used.values())


def _at(data: Plain, part: str | int) -> Plain:
    if isinstance(data, dict):
        return data.get(str(part))
    return data[part] if isinstance(data, list) and isinstance(part, int) and part < len(data) else None


def _is_quantity(annotation: object) -> bool:
    annotation = required(annotation)
    if any(isinstance(argument, QuantityType) for argument in get_args(annotation)[1:]):
        return True
    return any(_is_quantity(argument) for argument in get_args(annotation) if get_origin(argument) is not None)


def _with_spaces(text: str) -> str:
    """Return a plain text with the spaces of a quantity; one in quotes or with an anchor stays."""
    return spaced(text) if _QUANTITY_BEGINS.match(text) else text
