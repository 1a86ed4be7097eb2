"""The comment by which editors find the schema of a spec."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from cellc.edit.edit import Edit

_MODELINE = "yaml-language-server:"
_SCHEMA = Path("schemas") / "cell.schema.json"


def missing_modeline(file: str, text: str) -> Iterator[Edit]:
    """Yield the edit that puts the modeline first, where the spec has none and a schema lies beside or above it.

    Args:
        file: the root spec as the user named it.
    """
    schema = _schema_above(Path(file))
    if schema is None or any(_MODELINE in line for line in text.split("\n") if line.lstrip().startswith("#")):
        return
    line = f"# {_MODELINE} $schema={schema}"
    yield Edit(file, 1, 1, 1, f"{line}\n", f"`{line}` is added")


def _schema_above(file: Path) -> str | None:
    folder = file.resolve().parent
    for above in (folder, *folder.parents):
        if (above / _SCHEMA).is_file():
            return Path(os.path.relpath(above / _SCHEMA, folder)).as_posix()
    return None
