"""Change one place of a real spec."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from cellc.compiler.source import Plain, read
from cellc.compiler.spec.wording import value_at
from cellc.contract.diagnostics import YamlPath
from tests.cells import there
from tests.properties import st


@cache
def data_of(path: Path) -> Plain:
    outcome = read(path)
    return there(outcome.value).data


def places(data: Plain, path: YamlPath = ()) -> Iterator[YamlPath]:
    """Walk all paths of the data below its root."""
    children: Iterator[tuple[str | int, Plain]] = iter(())
    if isinstance(data, dict):
        children = iter(data.items())
    elif isinstance(data, list):
        children = iter(enumerate(data))
    for part, value in children:
        yield (*path, part)
        yield from places(value, (*path, part))


def mutated(path: Path, data: st.DataObject, values: st.SearchStrategy[Plain]) -> Plain:
    """Return the spec with one value replaced, one entry deleted, or one key renamed."""
    spec = copy.deepcopy(data_of(path))
    place = data.draw(st.sampled_from(list(places(spec))))
    holder, key = value_at(spec, place[:-1]), place[-1]
    deed = data.draw(st.sampled_from(["replace", "delete", "rename"]))
    if isinstance(holder, dict) and isinstance(key, str):
        value = holder.pop(key)
        new_key = data.draw(st.sampled_from(["a", "9", "from_", "to", "nmae"])) if deed == "rename" else key
        if deed != "delete":
            holder[new_key] = data.draw(values) if deed == "replace" else value
    elif isinstance(holder, list) and isinstance(key, int):
        holder[key : key + 1] = [] if deed == "delete" else [data.draw(values)]
    return spec
