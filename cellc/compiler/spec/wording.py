"""How messages quote what the user wrote, and what help they give for a name or key that does not fit."""

from __future__ import annotations

import re
from collections.abc import Mapping

from pydantic import BaseModel

from cellc.compiler.source.document import Plain
from cellc.compiler.spec.base import PACKAGE_NAME_PATTERN, REFERENCE_PATTERN
from cellc.compiler.spec.place import Place, annotations_by_key, fields_by_key, model_of
from cellc.contract.diagnostics import Advice, YamlPath, did_you_mean, format_path, nearest, only_nearest
from cellc.contract.stated import NAME_PATTERN

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
    """Return the value at a path, or None."""
    for part in path:
        if isinstance(data, dict) and isinstance(part, str):
            data = data.get(part)
        elif isinstance(data, list) and isinstance(part, int) and part < len(data):
            data = data[part]
        else:
            return None
    return data


_RULES: Mapping[str, str] = {
    NAME_PATTERN: "use letters, digits and `_`, beginning with a letter",
    PACKAGE_NAME_PATTERN: "use two or more lower case letters, digits and `_`, beginning with a letter",
    REFERENCE_PATTERN: "write `frame` or `device/link` with letters, digits and `_`",
}


def rule_of(pattern: str) -> str:
    """Return what the pattern of a name allows, in words."""
    return _RULES.get(pattern, "use letters, digits and `_`; in a namespace each part begins with `/`")


def help_for_bad_name(written: str, pattern: str) -> str:
    """Tell what the pattern allows and, where it is near, a name that fits."""
    rule = rule_of(pattern)
    suggestion = re.sub(r"[^A-Za-z0-9_/]+", "_", written.strip()).strip("_/")
    suggestion = suggestion.lower() if pattern == PACKAGE_NAME_PATTERN else suggestion
    fits = pattern in _RULES and len(suggestion) <= 64 and re.search(pattern, suggestion)
    return Advice(f"{rule}, such as `{suggestion}`", written, (suggestion,)) if fits else rule


def help_for_unknown_key(key: str, place: Place) -> str:
    """Write the help: the place one level off where the key exists, the nearest keys, or the allowed ones."""
    path, model = place.models[-1]
    return _one_level_off(key, path, model, place) or did_you_mean(key, fields_by_key(model), "keys that are allowed")


def meant_key(key: str, place: Place) -> str | None:
    """Return the key that an unknown one is a misspelling of; None where it belongs one level off."""
    path, model = place.models[-1]
    return None if _one_level_off(key, path, model, place) else only_nearest(key, fields_by_key(model))


def could_mean(unknown: str, missing: str) -> bool:
    """Whether an unknown key is probably the missing one misspelled, so that one mistake gives one error."""
    return bool(nearest(unknown, (missing,)))


def _one_level_off(key: str, path: YamlPath, model: type[BaseModel], place: Place) -> str:
    for name, annotation in annotations_by_key(model).items():
        child = model_of(annotation)
        if child is not None and key in fields_by_key(child):
            return f"move it under `{name}`"
    if len(place.models) > 1 and not nearest(key, fields_by_key(model)):
        outer_path, outer = place.models[-2]
        if key in fields_by_key(outer):
            where = f"into {quote_path(outer_path)}" if outer_path else "to the top level"
            return f"move it out of {quote_path(path)} {where}"
    return ""
