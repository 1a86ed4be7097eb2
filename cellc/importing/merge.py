"""A second import into a folder: what the vendor changed comes in, what a person wrote stays.

A value is the person's where it differs from what the import before had written, which the lock keeps. Blocks of the
file in which nothing changes stay as they are, to the letter, with their comments.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import yaml
from yaml.representer import SafeRepresenter

Facts = dict[str, Any]
"""What a ``device.yaml`` holds, as YAML has it."""
_KEY = re.compile(r"^([A-Za-z_][A-Za-z0-9_]*):", re.MULTILINE)
_ABSENT = object()


class _Loader(yaml.SafeLoader):
    """SafeLoader that leaves dates the texts that they are."""


_Loader.yaml_implicit_resolvers = {
    first: [(tag, pattern) for tag, pattern in resolvers if tag != "tag:yaml.org,2002:timestamp"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


def facts_in(text: str) -> Facts | None:
    """Return what a ``device.yaml`` holds; None where it cannot be read, which a check tells with its place."""
    try:
        found = yaml.load(text, Loader=_Loader)
    except (yaml.YAMLError, ValueError):
        return None
    return found if isinstance(found, dict) else None


def dumped(facts: Mapping[str, object]) -> str:
    """Write facts as YAML, in their order: each key begins a line, and what is small stands on it."""
    node = SafeRepresenter(default_flow_style=None, sort_keys=False).represent_data(dict(facts))
    assert isinstance(node, yaml.MappingNode)
    node.flow_style = False
    text: str = yaml.serialize(node, Dumper=yaml.SafeDumper, width=120, allow_unicode=True)
    return text


def merged(before: Facts, now: Facts, person: Facts) -> Facts:
    """Return what a person has, with what the vendor changed since: a value that both changed is the person's."""
    found: Facts = {}
    for key in (*person, *(key for key in now if key not in person)):
        value = _one(before.get(key, _ABSENT), now.get(key, _ABSENT), person.get(key, _ABSENT))
        if value is not _ABSENT:
            found[key] = value
    return found


def _one(before: Any, now: Any, person: Any) -> Any:
    if isinstance(now, dict) and isinstance(person, dict):
        return merged(before if isinstance(before, dict) else {}, now, person)
    if _of_pairs(now) and _of_pairs(person):
        parts = (_by_pair(before) if _of_pairs(before) else {}, _by_pair(now), _by_pair(person))
        return list(merged(*parts).values())
    return now if person == before else person


def _of_pairs(value: Any) -> bool:
    """Tell whether a value is the list of pairs of links that may touch."""
    return isinstance(value, list) and all(isinstance(one, dict) and "links" in one for one in value)


def _by_pair(pairs: list[Facts]) -> Facts:
    return {" ".join(sorted(map(str, one["links"]))): one for one in pairs}


def rewritten(text: str, person: Facts, facts: Facts) -> str:
    """Return a file that holds ``person`` with the blocks written anew that are otherwise in ``facts``."""
    left = {key: value for key, value in facts.items() if key not in person or person[key] != value}
    starts = [*(match.start() for match in _KEY.finditer(text)), len(text)]
    blocks = [text[: starts[0]], *(text[begin:end] for begin, end in pairwise(starts))]
    for number, block in enumerate(blocks):
        key = _KEY.match(block)
        if key is not None and key[1] in left:
            blocks[number] = dumped({key[1]: left.pop(key[1])})
        elif key is not None and key[1] not in facts:
            blocks[number] = ""
    return "".join(blocks) + (dumped(left) if left else "")
