"""A spec with its mistakes of shape and name taken for what was meant, or left out, so that one check names the rest.

Findings that rest on such a guess are no findings of the user: they are those on its line, or of the part of the cell
that it is in.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, YamlPath
from cellc.contract.frozen import dataclass

_PART = 2
"""Keys that lead to a part of the cell, such as ``devices.arm``."""


@dataclass(frozen=True, slots=True)
class Repaired:
    """A document that can be read on.

    Attributes:
        guessed: file and line of every text that is taken for another.
        words: these texts, and what they are taken for.
        left_out: paths of values that are taken as not written. Rules are not run on what is left: most look at all
            of a part.
    """

    document: SourceDocument
    guessed: frozenset[tuple[str, int]] = frozenset()
    words: frozenset[str] = frozenset()
    left_out: tuple[YamlPath, ...] = ()

    def is_apart(self, found: Diagnostic) -> bool:
        """Whether a finding would be there without the guesses too."""
        spans = (found.span, *(related.span for related in found.related))
        if any((span.file, line) in self.guessed for span in spans for line in (span.line, span.end_line)):
            return False
        names = {str(key) for path in self.left_out for key in path[1:]}
        if any(f"`{word}`" in found.message for word in self.words | names):
            return False
        return not any(path[:_PART] == found.yaml_path[: len(path[:_PART])] for path in self.left_out)


def repair(repaired: Repaired, stopped: Sequence[Diagnostic]) -> Repaired | None:
    """Return a document without the mistakes that stopped a stage; None where one of them is for people to repair.

    A text with a near name is taken for it. Any other value within a part of the cell is left out, which the next
    reading refuses where it is needed.
    """
    document, guessed, words, left_out = (
        repaired.document,
        set(repaired.guessed),
        set(repaired.words),
        list(repaired.left_out),
    )
    for found in sorted(stopped, key=lambda found: tuple(map(str, found.yaml_path)), reverse=True):
        path, fix = found.yaml_path, found.fix
        if not document.has(path) or (fix is None and len(path) <= _PART):
            return None
        if fix is None:
            document = document.without(path)
            left_out.append(path)
            continue
        written = document.text_at(path)
        if path[-1] == fix.written and written != fix.written:
            document = document.renamed(path, fix.text)
        else:
            document = document.with_text(path, written.replace(fix.written, fix.text, 1))
        guessed.add((fix.span.file, fix.span.line))
        words |= {fix.written, fix.text}
    return Repaired(document, frozenset(guessed), frozenset(words), tuple(left_out))
