"""Paths that artifacts may have."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from pathlib import Path, PurePosixPath

from cellc.artifact import Artifact
from cellc.diagnostics import Diagnostic
from cellc.output.finding import finding

# Forbidden in names of one of the common file systems.
_RESERVED = frozenset('<>:"|?*\\')


def check_paths(artifacts: Sequence[Artifact], folder: Path) -> Iterator[Diagnostic]:
    """Yield a diagnostic for each path that leads out of the folder, is not portable, or collides with another."""
    seen: dict[str, str] = {}
    for artifact in artifacts:
        reason = _reason(artifact.path)
        key = unicodedata.normalize("NFC", artifact.path).casefold()
        if not reason and key in seen:
            reason = f"is the same file as `{seen[key]}` where case does not count"
        seen.setdefault(key, artifact.path)
        if reason:
            shown = artifact.path.encode("unicode_escape").decode().replace("`", "'")
            yield finding("bad-artifact-path", f"`{shown}` {reason}", folder)
    yield from _files_as_folders(seen, folder)


def _files_as_folders(seen: dict[str, str], folder: Path) -> Iterator[Diagnostic]:
    for key, path in seen.items():
        parent = next((seen[str(p)] for p in PurePosixPath(key).parents if str(p) in seen), None)
        if parent is not None:
            yield finding("bad-artifact-path", f"`{path}` needs a folder where the file `{parent}` stands", folder)


def _reason(path: str) -> str:
    parts = path.split("/")
    if path.startswith("/"):
        return "is absolute"
    if any(part in ("", ".", "..") for part in parts):
        return "leads out of the folder or has an empty part"
    if any(char in _RESERVED or not char.isprintable() for char in path):
        return "holds a character that not every file system allows"
    return "is longer than file systems allow" if any(len(part.encode()) > 255 for part in parts) else ""
