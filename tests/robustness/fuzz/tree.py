"""Documents as trees that can hold what no plain value can: raw text, anchors, aliases; and how they are written."""

from __future__ import annotations

import json
import random
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias, Union

import yaml


@dataclass(frozen=True)
class Raw:
    """Text that is written as it stands, such as ``.nan`` or a tag."""

    text: str


@dataclass(frozen=True)
class Anchored:
    """A value with an anchor, which `Raw("*name")` elsewhere repeats."""

    name: str
    value: Tree


Tree: TypeAlias = Union[dict[str, "Tree"], list["Tree"], str, int, float, bool, Raw, Anchored, None]
Holder: TypeAlias = Union[dict[str, Tree], list[Tree]]
Write = Callable[[Tree], str]

_PLAIN = re.compile(r"[A-Za-z0-9_./+\-][A-Za-z0-9_./+\-*%^ ]*(?<! )")
_BLOCK_LEVELS = 3


def read_yaml(text: str) -> Tree:
    """Return a YAML document with every scalar as it is written; a text that needs its quotes keeps them."""
    node = yaml.compose(text, Loader=yaml.CSafeLoader)
    return None if node is None else _read(node)


def _read(node: yaml.Node) -> Tree:
    if isinstance(node, yaml.MappingNode):
        return {str(key.value): _read(value) for key, value in node.value}
    if isinstance(node, yaml.SequenceNode):
        return [_read(item) for item in node.value]
    assert isinstance(node, yaml.ScalarNode)
    return str(node.value) if node.style not in ("'", '"') or _is_text(node.value) else Raw(_quoted(node.value))


def _is_text(written: str) -> bool:
    """Whether a scalar without quotes is a text."""
    resolvers = yaml.SafeLoader.yaml_implicit_resolvers
    return not any(pattern.match(written) for _, pattern in [*resolvers.get(written[:1], []), *resolvers.get(None, [])])


def copied(tree: Tree) -> Tree:
    """Return a deep copy, aliases written out."""
    if isinstance(tree, dict):
        return {key: copied(value) for key, value in tree.items()}
    return [copied(value) for value in tree] if isinstance(tree, list) else tree


def places(tree: Tree) -> Iterator[tuple[Holder, str | int]]:
    """Yield every value below the root as its holder and its key or index."""
    if isinstance(tree, Anchored):
        yield from places(tree.value)
    elif isinstance(tree, dict):
        for key, value in tree.items():
            yield tree, key
            yield from places(value)
    elif isinstance(tree, list):
        for index, value in enumerate(tree):
            yield tree, index
            yield from places(value)


def paths(tree: Tree, at: tuple[str | int, ...] = ()) -> list[tuple[tuple[str | int, ...], Holder, str | int]]:
    """Return every value below the root as its path, its holder and its key or index."""
    if isinstance(tree, Anchored):
        return paths(tree.value, at)
    if not isinstance(tree, (dict, list)):
        return []
    found: list[tuple[tuple[str | int, ...], Holder, str | int]] = []
    for key in tree if isinstance(tree, dict) else range(len(tree)):
        found.append(((*at, key), tree, key))
        found += paths(value_at(tree, key), (*at, key))
    return found


def value_at(holder: Holder, key: str | int) -> Tree:
    """Return the value at a place."""
    return holder[str(key)] if isinstance(holder, dict) else holder[int(key)]


def put(holder: Holder, key: str | int, value: Tree) -> None:
    """Set the value at a place."""
    if isinstance(holder, dict):
        holder[str(key)] = value
    else:
        holder[int(key)] = value


def remove(holder: Holder, key: str | int) -> None:
    """Take the value at a place away, where it still is."""
    if isinstance(holder, dict):
        holder.pop(str(key), None)
    elif isinstance(key, int) and key < len(holder):
        del holder[key]


def write_json(tree: Tree) -> str:
    """Write JSON, and what only looks like it where the tree holds raw text."""
    return "".join(_flow(tree, _quoted)) + "\n"


def write_yaml(tree: Tree, levels: int = _BLOCK_LEVELS) -> str:
    """Write YAML: the outer levels in block style, the rest in flow style."""
    return "".join(_block(tree, levels, "")) or "\n"


def _block(tree: Tree, levels: int, indent: str) -> Iterator[str]:
    if levels and isinstance(tree, dict) and tree:
        for key, value in tree.items():
            yield f"{indent}{_plain(key)}:"
            yield from _below(value, levels, indent)
    elif levels and isinstance(tree, list) and tree and any(isinstance(item, (dict, list)) for item in tree):
        for item in tree:
            yield f"{indent}- {''.join(_flow(item, _plain))}\n"
    else:
        yield f"{indent}{''.join(_flow(tree, _plain))}\n"


def _below(value: Tree, levels: int, indent: str) -> Iterator[str]:
    anchor = ""
    if isinstance(value, Anchored):
        anchor, value = f" &{value.name}", value.value
    if levels > 1 and isinstance(value, (dict, list)) and value:
        yield f"{anchor}\n"
        yield from _block(value, levels - 1, f"{indent}  ")
    else:
        yield f"{anchor} {''.join(_flow(value, _plain))}\n"


def _flow(tree: Tree, text: Callable[[str], str]) -> Iterator[str]:
    if isinstance(tree, dict):
        yield "{"
        for number, (key, value) in enumerate(tree.items()):
            yield f"{', ' if number else ''}{text(key)}: "
            yield from _flow(value, text)
        yield "}"
    elif isinstance(tree, list):
        yield "["
        for number, value in enumerate(tree):
            yield ", " if number else ""
            yield from _flow(value, text)
        yield "]"
    elif isinstance(tree, Anchored):
        yield f"&{tree.name} "
        yield from _flow(tree.value, text)
    elif isinstance(tree, Raw):
        yield tree.text
    else:
        yield text(tree) if isinstance(tree, str) else json.dumps(tree)


def _plain(text: str) -> str:
    if text.startswith(("<<", "*")) and len(text) < 12:  # a merge key, or a key that is an alias or a wildcard
        return text if text == "<<" else json.dumps(text)
    marked = text.startswith(("-", "+", ".")) and not text[1:2].isdigit() and not text.startswith("./")
    return text if _PLAIN.fullmatch(text) and not marked else _quoted(text)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=any(character < " " or character == "\x7f" for character in text))


def names_in(tree: Tree) -> Sequence[str]:
    """Return the keys and short texts of a document, which its references are made of."""
    found: dict[str, None] = {}
    for holder, key in places(tree):
        if isinstance(key, str):
            found[key] = None
        value = value_at(holder, key)
        if isinstance(value, str) and len(value) < 40:
            found[value] = None
    return list(found)


def any_place(tree: Tree, chance: random.Random) -> tuple[Holder, str | int] | None:
    """Return a place at random, None where the document is a single value."""
    found = list(places(tree))
    return chance.choice(found) if found else None
