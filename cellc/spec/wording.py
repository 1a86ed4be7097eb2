"""Say in the words of a YAML author what stands in a place."""

from __future__ import annotations

import re

from cellc.diagnostics import YamlPath, format_path
from cellc.source.plain import Plain

_MAX_QUOTE = 60


def quote(text: str) -> str:
    """Put a user's text in backticks on one line, shortened where it is long."""
    flat = "".join(char if char.isprintable() else " " for char in text).replace("`", "'")
    flat = re.sub(r"\s+", " ", flat)
    return f"`{flat[: _MAX_QUOTE - 1]}…`" if len(flat) > _MAX_QUOTE else f"`{flat}`"


def quote_path(path: YamlPath) -> str:
    """Name a place of the document; the root is ``the spec``."""
    return quote(format_path(path)) if path else "the spec"


def scalar_text(value: Plain) -> str:
    """Write a scalar as YAML 1.2 does."""
    if value is None:
        return "null"
    return str(value).lower() if isinstance(value, bool) else str(value)


def describe(value: Plain, written: str = "") -> str:
    """Say what a value is: ``the number `5```, ``a list``; a number as it is written, where that is known."""
    if isinstance(value, dict):
        return "a mapping"
    if isinstance(value, list):
        return "a list"
    if isinstance(value, str):
        return f"the text {quote(value)}"
    kind = "" if value is None or isinstance(value, bool) else "the number "
    return f"{kind}{quote(written or scalar_text(value))}"


def value_at(data: Plain, path: YamlPath) -> Plain:
    """Return the value at a path, or None where there is none."""
    for part in path:
        if isinstance(data, dict) and isinstance(part, str):
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            return None
    return data
