"""What a key that no model knows may have meant."""

from __future__ import annotations

from pydantic import BaseModel

from cellc.diagnostics import YamlPath, did_you_mean, nearest
from cellc.spec.place import Place, annotations_by_key, fields_by_key, model_of
from cellc.spec.wording import quote_path


def help_for_unknown_key(key: str, place: Place) -> str:
    """Write the help: the place one level off where the key exists, the nearest keys, or the allowed ones."""
    path, model = place.models[-1]
    return _one_level_off(key, path, model, place) or did_you_mean(key, fields_by_key(model), "keys that are allowed")


def could_mean(unknown: str, missing: str) -> bool:
    """Whether an unknown key is probably the missing one misspelt, so that one mistake gives one error."""
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
