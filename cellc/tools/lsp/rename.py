"""Where a cell speaks of one of its names, and another name for it everywhere.

No table says which key names what. The linker does: a name is taken away, and what it then misses speaks of that name.
What is left to see is held too: the text with the new name is checked, and must have the findings that it had.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from cellc.compiler.pipeline import Checked, check_document
from cellc.compiler.source import SourceDocument, read
from cellc.compiler.source.document import Child, places
from cellc.contract.diagnostics import Advice, Diagnostic, Severity, Span, YamlPath
from cellc.contract.errors import CellcError
from cellc.tools.edit.rewrite import Edit, apply_edits
from cellc.tools.lsp.remedies import word_in
from cellc.tools.review.renames import named_in

_ROUNDS = 20
"""So often the linker is asked what it misses: each stage that stops hides what later ones miss."""
_LONGEST = 40


class RenameRefusedError(CellcError):
    """Says why a name cannot become another one."""


@dataclass(frozen=True, slots=True)
class Name:
    """A name that somebody gave to a part of the cell.

    Args:
        path: of the part; the name is its last key.
        noun: what it names, such as ``planning group``.
        spans: every place of the name, that which gives it first.
    """

    path: YamlPath
    noun: str
    spans: tuple[Span, ...]

    @property
    def word(self) -> str:
        """The name itself."""
        return str(self.path[-1])


@dataclass(frozen=True, slots=True)
class _Followed:
    """A document in which a name became another one, with the places, and what it has findings of that it had not."""

    document: SourceDocument
    spans: tuple[Span, ...]
    new: tuple[Diagnostic, ...]


def name_at(document: SourceDocument, file: str, line: int, column: int) -> tuple[Name, Span] | None:
    """Return the name that is spoken of at a place of a file with the place itself; None where there is no name."""
    said = _said_at(document, file, line, column)
    for path, noun in _given(document) if said else ():
        if not any(text == path[-1] or text.startswith(f"{path[-1]}/") for text in said):
            continue
        spans = _follow(document, path, _unused(document, path)).spans
        span = next((span for span in spans if span.file == file and _holds(span, line, column)), None)
        if span is not None:
            return Name(path, noun, spans), span
    return None


def renamed(document: SourceDocument, name: Name, new: str, others: Mapping[str, SourceDocument]) -> list[Edit]:
    """Return the edits that give a part another name everywhere.

    Args:
        others: other specs by file, which may read the same files.

    Raises:
        RenameRefusedError: the text with the new name would say something else, or has errors already.
    """
    if new == name.word:
        return []
    if not new:
        raise RenameRefusedError("a name has at least one character")
    if document.has((*name.path[:-1], new)):
        place = document.locate_key((*name.path[:-1], new))
        raise RenameRefusedError(f"there is a {name.noun} `{new}` already, in line {place.line}")
    before = check_document(document)
    if before.graph is None:
        first = next((found for found in before.diagnostics if found.severity is Severity.ERROR), None)
        raise RenameRefusedError(f"correct the errors first: {'the cell cannot be linked' if first is None else first}")
    followed = _follow(document, name.path, new, before)
    if followed.new:
        taken = next((f"there is a {noun} `{new}`, so that " for path, noun in _given(document) if path[-1] == new), "")
        raise RenameRefusedError(f"{taken}{_reason(followed.new[0])}")
    edits = [_edit(span, name.word, new) for span in followed.spans]
    _hold(document, followed.document, edits)
    for other in others.values():
        _hold_other(other, edits, name.word, new)
    return edits


def _said_at(document: SourceDocument, file: str, line: int, column: int) -> set[str]:
    said = set()
    for path, child in places(document.root):
        key = child.key_span
        if key is not None and key.file == file and _holds(key, line, column):
            said.add(str(path[-1]))
        span = child.node.span
        if not child.node.is_collection and span.file == file and _holds(span, line, column):
            said.add(child.node.text)
    return said


def _given(document: SourceDocument) -> Iterator[tuple[YamlPath, str]]:
    """Yield the path of every part with a name, and what it is."""
    for path, child in places(document.root):
        named = named_in(path[:-1])
        if named is not None and child.key_span is not None:
            yield path, named[1]
        elif path[:-1] == ("managers",):
            yield path, "controller manager"


def _unused(document: SourceDocument, path: YamlPath) -> str:
    """Return a name of the same kind that the part does not have, and no other."""
    texts = "\n".join(document.texts.values())
    stem = str(path[-1])[:_LONGEST]
    return next(name for number in range(len(texts) + 1) if (name := f"{stem}_{number}x") not in texts)


def _follow(document: SourceDocument, path: YamlPath, new: str, checked: Checked | None = None) -> _Followed:
    """Give a part another name, and then to whatever the linker and the rules miss under the name that it had."""
    old, before = str(path[-1]), check_document(document) if checked is None else checked
    known = Counter(_kind(found, old, new) for found in before.diagnostics)
    key = document.locate_key(path)
    spans = [word_in(key, old, document.texts) or key]
    document = document.renamed(path, new)
    more: tuple[Diagnostic, ...] = ()
    for _ in range(_ROUNDS):
        found = check_document(document).diagnostics
        left = Counter(_kind(each, old, new) for each in found) - known
        more = tuple(each for each in found if _kind(each, old, new) in left)
        speaking = list(dict.fromkeys(place for each in more for place in _speaking(each, document, old)))
        if not speaking:
            break
        for at, is_key in speaking:
            child = document.child(at)
            if (child is not None and child.key_span is not None) or not is_key:
                document, span = _changed(document, at, old, new, is_key=is_key)
                spans += [span] if span is not None and span not in spans else []
    return _Followed(document, tuple(spans), more)


def _speaking(found: Diagnostic, document: SourceDocument, old: str) -> Iterator[tuple[YamlPath, bool]]:
    """Yield where a finding misses a name, and whether the key there is what speaks of it."""
    written = found.help.written if isinstance(found.help, Advice) else ""
    if not written or _word(old).search(written) is None:
        return
    at = document.child(found.yaml_path)
    here: tuple[tuple[YamlPath, Child], ...] = () if at is None else ((found.yaml_path, at),)
    for path, child in (*here, *document.below(found.yaml_path)):
        text = "" if child.node.is_collection else child.node.text
        if text == written or (path == found.yaml_path and written in text):
            yield path, False
            return
        if path[-1] == written:
            yield path, True
            return


def _changed(
    document: SourceDocument, path: YamlPath, old: str, new: str, *, is_key: bool
) -> tuple[SourceDocument, Span | None]:
    """Return a document with the name changed in a key or a value, and where that is written."""
    child = document.child(path)
    written = str(path[-1]) if is_key else document.text_at(path)
    text = _word(old).sub(lambda _: new, written, count=1)
    span = None if child is None else child.key_span if is_key else child.node.span
    place = None if span is None else word_in(span, old, document.texts)
    return (document.renamed(path, text) if is_key else document.with_text(path, text)), place


def _hold(before: SourceDocument, meant: SourceDocument, edits: list[Edit]) -> None:
    """Refuse edits of a text that do not give the document which was checked."""
    after = read(before.file, _edited(before.texts, edits)).value
    if after is None or after.data != meant.data:
        raise RenameRefusedError("an anchor or a text of several lines holds the name together with something else")


def _hold_other(other: SourceDocument, edits: list[Edit], old: str, new: str) -> None:
    """Refuse edits of a file that another spec includes, and which then is another cell."""
    if not any(edit.file in other.texts for edit in edits):
        return
    was = Counter(_kind(found, old, new) for found in check_document(other).diagnostics)
    after = read(other.file, _edited(other.texts, edits))
    found = after.diagnostics if after.value is None else check_document(after.value, after.diagnostics).diagnostics
    worse = next((each for each in found if _kind(each, old, new) not in was), None)
    if worse is not None:
        raise RenameRefusedError(f"`{other.file}` includes the same file, and would have: {_reason(worse)}")


def _edited(texts: Mapping[str, str], edits: list[Edit]) -> dict[str, str]:
    return {file: apply_edits(text, [each for each in edits if each.file == file]) for file, text in texts.items()}


def _edit(span: Span, old: str, new: str) -> Edit:
    return Edit(span.file, span.line, span.column, span.end_column, new, f"`{old}` becomes `{new}`")


def _reason(found: Diagnostic) -> str:
    return f"{found.message}; {found.help}" if found.help else found.message


def _kind(found: Diagnostic, old: str, new: str) -> tuple[str, tuple[str, ...]]:
    """Return what a finding is and of what, whichever of two names that has."""
    names = "|".join(re.escape(name) for name in sorted((old, new), key=len, reverse=True))
    either = re.compile(rf"(?<![A-Za-z0-9])(?:{names})(?![A-Za-z0-9])")
    return found.code, tuple(either.sub("\0", str(part)) for part in found.yaml_path)


def _word(name: str) -> re.Pattern[str]:
    return re.compile(rf"(?<![\w-]){re.escape(name)}(?![\w-])")


def _holds(span: Span, line: int, column: int) -> bool:
    return (span.line, span.column) <= (line, column) <= (span.end_line, span.end_column)
