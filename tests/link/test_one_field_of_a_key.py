"""No two fields of a linked entity come from one key of the spec: what reads one cannot contradict what reads another.

Found from outside: each key is changed alone, the cell is linked again, and the fields that differ are counted.
"""

from __future__ import annotations

import copy
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.entity import Entity
from cellc.compiler.cell.members import field_names
from cellc.compiler.link.link import link
from cellc.compiler.source.document import Plain, SourceDocument
from cellc.compiler.spec.parse import parse
from cellc.contract.diagnostics import YamlPath
from tests.cells import CORPUS, document_of, spec_of, there

Leaves = dict[tuple[str, str], list[object]]
"""Entity and names of fields down to a value → what is there, of every key and index."""

FOLLOW = {
    *("parameters", "on_real"),  # what ROS gets of the values of an entity, in the names of its node
    *("does", "tool"),  # sentences and commands for people, with the values of an entity in them
    "measured_on",  # the text of its key as a date
}
"""Fields that nothing but a text is made of."""
STRUCTURAL = {
    "cell": "the name of the package",
    "prefix": "a part of every name",
    "run": "the program of a node, and with it what the catalog knows of the node",
    "dynamic": "the kind of a frame",
    "topic": "the type of an interface, by which a device is driven past ros2_control or not",
    "action": "the same",
}
"""Keys that decide what there is, and not how much of it."""


def names_an_entity(path: YamlPath) -> bool:
    """Return whether a key is the name of an entity, so that another value is another entity."""
    return path[:2] == ("bringup", "first_motion") and path[-1] == "joint"


PLACES = {"path", "span", "places", "description", "vendor_description"}
_QUANTITY = re.compile(r"\s*([-+]?[\d.]+)(.*[a-zA-Z%].*)", re.DOTALL)


def leaves(value: object, entity: str = "cell", names: tuple[str, ...] = ()) -> Iterator[tuple[str, str, object]]:
    """Yield every value below an entity with the names of the fields that lead there."""
    if names_of := field_names(value):
        if isinstance(value, Entity):
            entity, names = f"{entity}/{value.name}", ()
        for name in names_of:
            if name not in PLACES | FOLLOW:
                yield from leaves(getattr(value, name), entity, (*names, name))
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from leaves(item, f"{entity}" if names else f"{entity}/{key}", names)
    elif isinstance(value, (tuple, frozenset)):
        for item in value if isinstance(value, tuple) else sorted(value, key=repr):
            yield from leaves(item, entity, names)
    else:
        yield entity, ".".join(names), value


def gathered(cell: Cell) -> Leaves:
    """Return the values of a cell by entity and field; those of the cell itself are entities by their sections."""
    found: Leaves = defaultdict(list)
    for entity, field, value in leaves(cell):
        found[entity, field].append(value)
    return found


def linked(document: SourceDocument, data: Plain) -> Cell | None:
    """Return the cell of changed data; None where it is refused, as a name that nothing has is."""
    changed = replace(document, root=replace(document.root, data=data))
    spec = parse(changed)
    if spec.value is None or not spec.ok:
        return None
    cell = link(spec.value, changed)
    return cell.value if cell.ok else None


def scalars(data: Plain, path: YamlPath = ()) -> Iterator[tuple[YamlPath, Plain]]:
    """Yield every scalar with its path."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from scalars(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from scalars(value, (*path, index))
    else:
        yield path, data


def other(value: Plain) -> Plain:
    """Return another value of the same kind, near the first."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    quantity = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if quantity is not None and re.fullmatch(r"[-+]?\d+(\.\d*)?", quantity[1]):
        number = float(quantity[1])
        return f"{number * 0.99 if number else 0.001:.9g}{quantity[2]}"
    return f"{value}x"


def with_other(data: Plain, path: YamlPath) -> Plain:
    """Return the data with another value at a path."""
    changed = copy.deepcopy(data)
    at: Any = changed
    for step in path[:-1]:
        at = at[step]
    at[path[-1]] = other(at[path[-1]])
    return changed


SPECS = {
    "ur5e_pick": spec_of("ur5e_pick"),
    "fr3_hand": spec_of("fr3_hand"),
    "more_fields": CORPUS / "valid" / "more_fields.yaml",
}


@pytest.mark.parametrize("name", SPECS)
def test_no_two_fields_of_an_entity_come_from_one_key(name: str) -> None:
    document = document_of(SPECS[name])
    cell = there(linked(document, document.data))
    before, tried, twice = gathered(cell), 0, []
    for path, _ in scalars(document.data):
        changed = linked(document, with_other(document.data, path))
        if changed is None or path[-1] in STRUCTURAL or names_an_entity(path):
            continue
        tried += 1
        after = gathered(changed)
        by_entity: dict[str, set[str]] = defaultdict(set)
        for entity, field in before.keys() | after.keys():
            if before.get((entity, field)) != after.get((entity, field)):
                by_entity[entity].add(field)
        twice += [(path, entity, sorted(found)) for entity, found in by_entity.items() if len(found) > 1]
    assert tried > 100
    assert twice == []
