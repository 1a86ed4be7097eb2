"""A second import into a folder: what the vendor changed comes in, what a person wrote stays.

A value is the person's where it differs from what the import before had written, which the lock keeps. Blocks of the
file in which nothing changes stay as they are, to the letter, with their comments.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import yaml

from cellc.contract.limits import limits
from cellc.robot.description.yaml_values import load_values

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
        facts = load_values(text, _Loader, limits().spec_values)
    except (yaml.YAMLError, ValueError, RecursionError):
        return None
    return facts if isinstance(facts, dict) else None


def dumped(facts: Mapping[str, object]) -> str:
    """Write facts as YAML, in their order."""
    return yaml.safe_dump(dict(facts), sort_keys=False, default_flow_style=None, width=120, allow_unicode=True)


def merged(before: Facts, now: Facts, person: Facts) -> Facts:
    """Return what a person has, with what the vendor changed since: a value that both changed is the person's."""
    facts: Facts = {}
    for key in (*person, *(key for key in now if key not in person)):
        value = _one(before.get(key, _ABSENT), now.get(key, _ABSENT), person.get(key, _ABSENT))
        if value is not _ABSENT:
            facts[key] = value
    return facts


def _one(before: Any, now: Any, person: Any) -> Any:
    if isinstance(now, dict) and isinstance(person, dict):
        return merged(before if isinstance(before, dict) else {}, now, person)
    if _of_pairs(now) and _of_pairs(person):
        parts = (_by_pair(before) if _of_pairs(before) else {}, _by_pair(now), _by_pair(person))
        return list(merged(*parts).values())
    return now if person == before else person


def _of_pairs(value: Any) -> bool:
    """Tell whether a value is the list of pairs of links that may touch."""
    return isinstance(value, list) and all(
        isinstance(item, dict) and isinstance(item.get("links"), list) for item in value
    )


def _by_pair(pairs: list[Facts]) -> Facts:
    return {" ".join(sorted(map(str, pair["links"]))): pair for pair in pairs}


def rewritten(text: str, person: Facts, facts: Facts) -> str:
    """Return the text of a file that holds ``person``, with the blocks replaced that differ in ``facts``."""
    blocks = dict(_blocks(dumped(facts)))
    changed = {key: blocks[key] for key in facts if key not in person or person[key] != facts[key]}
    kept = [changed.pop(key, block) for key, block in _blocks(text) if not key or key in facts]
    return "".join((*kept, *changed.values()))


def _blocks(text: str) -> Iterator[tuple[str, str]]:
    """Yield each key at the left with all up to the next one; what is above the first is of no key."""
    starts = [match.start() for match in _KEY.finditer(text)]
    yield "", text[: starts[0]] if starts else text
    for begin, end in pairwise((*starts, len(text))):
        yield text[begin:].partition(":")[0], text[begin:end]
