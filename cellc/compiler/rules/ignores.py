"""Comments such as ``# cellc: ignore CODE reason``: read, applied to what was found, and judged."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice

from cellc.compiler.rules.run import ALL_RULES
from cellc.compiler.source.events import Comment, comments
from cellc.contract.code_page import meant_code, page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.frozen import dataclass

# Who, where and what stops it: no comment justifies motion without these answers.
_PROTECTED_FAMILIES = ("SAF", "OWN", "FRM")
_STOPPING = (Severity.ERROR, Severity.BLOCKER)
_RULES = {rule.code: rule for rule in ALL_RULES}
# A code of a stage and of a rule stops the stage, whatever the family of the rule.
_MARKER = re.compile(r"(?<!\S)#\s*cellc:\s*ignore\b")
_CODE = re.compile(r"[\w-]+")
_NEXT = re.compile(r"\s*,\s*")
_MOST_SHOWN = 100
"""Wrong comments of one spec that are reported, and as many without effect; each is compared with every code."""
_MOST_NAMED = 12
# What people put between the codes and the reason.
_SEPARATORS = " \t:-–—("


@dataclass(frozen=True, slots=True)
class IgnoredCode:
    """One code of a comment and where it is written."""

    code: str
    span: Span


@dataclass(frozen=True, slots=True)
class IgnoreComment:
    """One comment: the codes that it ignores on its line, and why; the reason may be missing."""

    span: Span
    codes: tuple[IgnoredCode, ...]
    reason: str


def ignore_comments(texts: Mapping[str, str]) -> tuple[IgnoreComment, ...]:
    """Return the comments of all files of a spec that ignore something.

    Args:
        texts: valid YAML by the name that spans carry.
    """
    return tuple(_read(file, comment) for file, text in texts.items() for comment in comments(text, _MARKER))


def _read(file: str, comment: Comment) -> IgnoreComment:
    head = _MARKER.match(comment.text)
    assert head is not None  # the comment begins where the marker was found
    codes: dict[str, IgnoredCode] = {}
    end = head.end()
    for start, end in _codes(comment.text, head.end()):
        code = comment.text[start:end]
        codes.setdefault(code, IgnoredCode(code, _span(file, comment, start, end)))
    reason = comment.text[end:].strip(_SEPARATORS)
    return IgnoreComment(_span(file, comment, 0, len(comment.text)), tuple(codes.values()), reason)


def _codes(text: str, position: int) -> Iterator[tuple[int, int]]:
    """Yield start and end of every code; the first word behind the codes begins the reason."""
    start = position + len(text[position:]) - len(text[position:].lstrip())
    while match := _CODE.match(text, start):
        yield match.span()
        following = _NEXT.match(text, match.end())
        if following is None:
            return
        start = following.end()


def _span(file: str, comment: Comment, start: int, end: int) -> Span:
    return Span(file, comment.line, comment.column + start, comment.line, comment.column + end)


def apply_ignores(
    diagnostics: Iterable[Diagnostic], ignores: tuple[IgnoreComment, ...], known: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Return the findings that no comment excuses, and what is wrong with the comments; in no particular order.

    A comment counts for findings that begin or end on its line. One without reason, or for a code that cannot be
    ignored, has no effect.

    Args:
        diagnostics: what all stages and rules found.
        known: the severity of every code that cellc can report.
    """
    found = tuple(diagnostics)
    reported = {diagnostic.code for diagnostic in found}
    on_line: dict[tuple[str, str, int], set[Diagnostic]] = {}
    for item in found:
        for line in (item.span.line, item.span.end_line):
            on_line.setdefault((item.code, item.span.file, line), set()).add(item)
    excused: set[Diagnostic] = set()
    unused: list[Diagnostic] = []
    for comment in ignores:
        for ignored in comment.codes if comment.reason else ():
            severity = known.get(ignored.code)
            if severity is None or _refusal_of(ignored.code, severity) is not None:
                continue
            matches = on_line.get((ignored.code, ignored.span.file, ignored.span.line), set())
            excused |= matches
            if not matches and not _may_be_hidden(ignored.code, reported):
                unused.append(_misuse("unused-ignore", _unused(ignored), ignored.span))
    return (*(item for item in found if item not in excused), *misused_ignores(ignores, known), *unused[:_MOST_SHOWN])


def may_be_ignored(code: str) -> bool:
    """Whether a comment may excuse what a rule of this code finds."""
    rule = _RULES.get(code)
    return rule is not None and _refusal_of(code, rule.severity) is None


def misused_ignores(ignores: tuple[IgnoreComment, ...], known: Mapping[str, Severity]) -> tuple[Diagnostic, ...]:
    """Return what is wrong with comments whatever the rules find: no code, no reason, or a code that stays."""
    return tuple(islice(_misused(ignores, known), _MOST_SHOWN))


def _misused(ignores: tuple[IgnoreComment, ...], known: Mapping[str, Severity]) -> Iterator[Diagnostic]:
    for comment in ignores:
        yield from _shape_problems(comment)
        yield from (refusal for ignored in comment.codes if (refusal := _refusal(ignored, known)) is not None)


def _shape_problems(comment: IgnoreComment) -> Iterator[Diagnostic]:
    if not comment.codes:
        yield _misuse("unknown-ignored-code", "the comment names no code to ignore", comment.span)
    elif not comment.reason:
        codes = ", ".join(f"`{ignored.code}`" for ignored in comment.codes[:_MOST_NAMED])
        yield _misuse("ignore-without-reason", f"{codes} is ignored without a reason", comment.span)


def _refusal(ignored: IgnoredCode, known: Mapping[str, Severity]) -> Diagnostic | None:
    severity = known.get(ignored.code)
    if severity is None:
        advice = meant_code(ignored.code, known, "codes that `cellc explain` lists")
        return _misuse("unknown-ignored-code", f"there is no code `{ignored.code}`", ignored.span, advice)
    reason = _refusal_of(ignored.code, severity)
    if reason is None:
        return None
    return _misuse("ignore-refused", f"`{ignored.code}` cannot be ignored: {reason}", ignored.span)


def _refusal_of(code: str, severity: Severity) -> str | None:
    """Return why a code may not be ignored; None where a comment may ignore it."""
    rule = _RULES.get(code)
    if (rule is None or code in STAGES["link"]) and severity is Severity.ERROR:
        return "without it the cell is not known"
    if rule is not None and rule.family in _PROTECTED_FAMILIES and rule.severity in _STOPPING:
        return f"it is {_article(rule.severity)} of family {rule.family}"
    return None


def _article(severity: Severity) -> str:
    return f"{'an' if severity is Severity.ERROR else 'a'} {severity.value}"


def _may_be_hidden(code: str, reported: set[str]) -> bool:
    """Whether the rule did not run because of something that is reported, so that its result is unknown."""
    return code in _RULES and not reported.isdisjoint(_RULES[code].assumes)


def _unused(ignored: IgnoredCode) -> str:
    return f"`{ignored.code}` is not reported on this line"


def _misuse(code: str, message: str, span: Span, advice: str = "") -> Diagnostic:
    return Diagnostic(code, STAGES["ignores"][code], message, span, help=advice or page_of(code).fix)
