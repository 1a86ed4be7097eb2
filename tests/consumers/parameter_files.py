"""Parameter files of a build as rclcpp matches them to nodes, read with a YAML parser that is not cellc's."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from tests.foreign_yaml import safe_load


def flat(tree: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    """Yield parameters with dots for nesting."""
    for key, value in tree.items():
        if isinstance(value, dict):
            yield from flat(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


def sections(text: str) -> dict[str, dict[str, Any]]:
    """Return the flat parameters of each node key, which gets its leading slash."""
    loaded = safe_load(text)
    return {
        key if key.startswith("/") else f"/{key}": dict(flat(section["ros__parameters"]))
        for key, section in loaded.items()
    }


def matches(key: str, node: str) -> bool:
    """Whether a key applies to a fully qualified node name: ``*`` is one token, ``**`` any number."""
    pattern = re.escape(key).replace(r"/\*\*", "(/[^/]+)*").replace(r"/\*", "/[^/]+")
    return re.fullmatch(pattern, node) is not None


def told(texts: Mapping[str, str], files: tuple[str, ...], node: str) -> dict[str, Any]:
    """Return what a node gets from files in order, later ones winning."""
    values: dict[str, Any] = {}
    for file in files:
        for key, section in sections(texts[file]).items():
            if matches(key, node):
                values |= section
    return values
