"""What ends a finding: the texts that it proposes, and the comment that excuses it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Advice, Diagnostic, Fix, Severity, Span, YamlPath
from cellc.tools.edit.fixes import edit_of
from cellc.tools.edit.rewrite import Edit


@dataclass(frozen=True, slots=True)
class Remedy:
    """An edit that ends a finding.

    Args:
        preferred: it is what was probably meant.
    """

    about: Diagnostic
    edit: Edit
    preferred: bool


def fixes(diagnostics: Sequence[Diagnostic], document: SourceDocument) -> Iterator[Remedy]:
    """Yield the fixes of each finding, the nearest first, and the comment that excuses one which may be excused.

    The comment has no reason, and no effect, until its author writes one.
    """
    for item in diagnostics:
        advice = item.help
        is_near = item.fix is not None or (isinstance(advice, Advice) and advice.is_near)
        for number, edit in enumerate(proposed(item, document)):
            yield Remedy(item, edit, is_near and number == 0)
        comment = _excuse(item, document)
        if comment is not None:
            yield Remedy(item, comment, False)


def _excuse(diagnostic: Diagnostic, document: SourceDocument) -> Edit | None:
    from cellc.compiler.rules.ignores import may_be_ignored

    lines = document.texts.get(diagnostic.span.file, "").split("\n")
    if (
        diagnostic.severity is Severity.ERROR
        or not may_be_ignored(diagnostic.code)
        or diagnostic.span.line > len(lines)
    ):
        return None
    line = lines[diagnostic.span.line - 1]
    if "#" in line:
        return None
    end, text = len(line.rstrip()) + 1, f"  # cellc: ignore {diagnostic.code} "
    return Edit(
        diagnostic.span.file,
        diagnostic.span.line,
        end,
        end,
        text,
        f"Ignore `{diagnostic.code}`: say why behind the comment",
    )


def proposed(diagnostic: Diagnostic, document: SourceDocument) -> Iterator[Edit]:
    """Yield the edits that a finding proposes, the nearest first; none where what it speaks of is not in the document.

    Each alone ends the finding; which one was meant a person says.
    """
    fix, advice = diagnostic.fix, diagnostic.help
    if fix is not None:
        yield edit_of(fix)
    if not isinstance(advice, Advice) or not advice.written:
        return
    span = _place_of(advice.written, diagnostic, document) if fix is None else fix.span
    written = advice.written if fix is None else fix.written
    for text in advice.instead:
        if span is not None and text != written and (fix is None or text != fix.text):
            yield edit_of(Fix(span, written, text, sure=False))


def _place_of(written: str, diagnostic: Diagnostic, document: SourceDocument) -> Span | None:
    """Return where a finding has its text: within its span, else as the key or value at its path or below it."""
    path = diagnostic.yaml_path
    spans = [diagnostic.span]
    if document.has(path):
        spans += [document.locate(path), document.locate_key(path), *_below(path, written, document)]
    return next((within for span in spans if (within := word_in(span, written, document.texts)) is not None), None)


def _below(path: YamlPath, written: str, document: SourceDocument) -> Iterator[Span]:
    for below, child in document.below(path):
        if child.key_span is not None and below[-1] == written:
            yield child.key_span
        if child.node.text == written:
            yield child.node.span


def word_in(span: Span, written: str, texts: Mapping[str, str]) -> Span | None:
    """Return the first place of a whole word or text on the first line of a span; None where it is not there."""
    lines = texts.get(span.file, "").split("\n")
    if span.line > len(lines):
        return None
    end = span.end_column - 1 if span.end_line == span.line else None
    word = re.compile(rf"(?<!\w){re.escape(written)}(?!\w)")
    found = word.search(lines[span.line - 1][:end], span.column - 1)
    return None if found is None else Span(span.file, span.line, found.start() + 1, span.line, found.end() + 1)
