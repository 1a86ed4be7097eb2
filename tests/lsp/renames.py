"""Renames of a cell, held against the findings of a check and against what the review of both calls it."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator

from cellc.compiler.pipeline import check
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.document import places
from cellc.contract.diagnostics import YamlPath
from cellc.tools.edit.rewrite import Edit, apply_edits
from cellc.tools.lsp.rename import RenameRefusedError, name_at, renamed
from cellc.tools.review.renames import SECTIONS, renames_between
from tests.cells import there

FIXED_ELSEWHERE = re.compile(r"does not publish|has no action|does not subscribe")
"""Why an interface of a known program keeps its name: the program gives it."""


def names(document: SourceDocument) -> Iterator[YamlPath]:
    """Yield the path of everything in a spec that has a name."""
    for path, _ in places(document.root):
        if any(_is_in(path, section) for section in (*SECTIONS, ("managers",))):
            yield path


def _is_in(path: YamlPath, section: tuple[str, ...]) -> bool:
    return len(path) == len(section) + 1 and all(one in ("*", other) for one, other in zip(section, path, strict=False))


def edited(document: SourceDocument, edits: list[Edit]) -> dict[str, str]:
    """Return the texts of a document after edits."""
    return {
        file: apply_edits(text, [edit for edit in edits if edit.file == file]) for file, text in document.texts.items()
    }


def faults_of_a_rename(document: SourceDocument, path: YamlPath) -> Iterator[str]:
    """Rename what is at a path, and yield what is then not as before; nothing where it is refused with its reason."""
    key = document.locate_key(path)
    found = name_at(document, key.file, key.line, key.column)
    old, new = str(path[-1]), f"{path[-1]}_anew"
    if found is None or found[0].path != path:
        yield f"{path} is not found where it is written: {found}"
        return
    try:
        edits = renamed(document, found[0], new, {})
    except RenameRefusedError as refused:
        if path[0] != "interfaces" or FIXED_ELSEWHERE.search(str(refused)) is None:
            yield f"{path} is refused: {refused}"
        return
    texts = edited(document, edits)
    if _told(document.file, dict(document.texts), old, new) != _told(document.file, texts, old, new):
        yield f"{path} has other findings as `{new}`"
    said = [
        (one.section, one.before, one.after) for one in renames_between(document, there(read(key.file, texts).value))
    ]
    if (path[:-1], old, new) not in said or any(before.replace(old, new) != after for _, before, after in said):
        yield f"the review of `{new}` for {path} says {said}"


def _told(spec: str, texts: dict[str, str], old: str, new: str) -> Counter[tuple[str, tuple[str, ...]]]:
    """Return the findings of a spec as words in no order, the old name for the new one."""
    loose = re.compile(rf"(?<![A-Za-z0-9]){re.escape(new)}(?![A-Za-z0-9])")
    found = check(spec, texts).diagnostics
    return Counter((one.code, tuple(sorted(re.findall(r"[\w/.-]+", loose.sub(old, one.message))))) for one in found)
