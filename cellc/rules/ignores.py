"""Takes out the findings that the author of a cell excuses on their line, and judges the excuses."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.diagnostics import Diagnostic, Severity, Span, did_you_mean
from cellc.diagnostics.page import CodePage
from cellc.link.codes import CODES as LINK_CODES
from cellc.rules.all_rules import ALL_RULES
from cellc.rules.ignore_codes import CODES
from cellc.rules.ignore_comment import IgnoreComment, IgnoredCode

# Who, where and what stops it: no comment justifies motion without these answers.
_PROTECTED_FAMILIES = ("SAF", "OWN", "FRM")
_STOPPING = (Severity.ERROR, Severity.BLOCKER)
_RULES = {rule.code: rule for rule in ALL_RULES}
_PAGES = {page.code: page for page in CODES}
# A code of a stage and of a rule stops the stage, whatever the family of the rule.
_LINK_CODES = frozenset(page.code for page in LINK_CODES)


def apply_ignores(
    diagnostics: Iterable[Diagnostic], ignores: tuple[IgnoreComment, ...], pages: Mapping[str, CodePage]
) -> tuple[Diagnostic, ...]:
    """Return the findings that no comment excuses, and what is wrong with the comments; in no particular order.

    A comment counts for findings that begin or end on its line. One without reason, or for a code that cannot be
    ignored, has no effect.

    Args:
        diagnostics: what all stages and rules found.
        pages: the page of every code that cellc can report.
    """
    found = tuple(diagnostics)
    reported = {diagnostic.code for diagnostic in found}
    excused: set[Diagnostic] = set()
    unused: list[Diagnostic] = []
    for comment in ignores:
        for ignored in comment.codes if comment.reason else ():
            if _refusal(ignored, pages) is not None:
                continue
            matches = {one for one in found if one.code == ignored.code and _is_on_line(one.span, comment.span)}
            excused |= matches
            if not matches and not _may_be_hidden(ignored.code, reported):
                unused.append(_complaint("unused-ignore", _unused(ignored), ignored.span))
    return (*(one for one in found if one not in excused), *misused_ignores(ignores, pages), *unused)


def misused_ignores(ignores: tuple[IgnoreComment, ...], pages: Mapping[str, CodePage]) -> tuple[Diagnostic, ...]:
    """Return what is wrong with comments whatever the rules find: no code, no reason, or a code that stays."""
    complaints: list[Diagnostic] = []
    for comment in ignores:
        complaints += _shape_complaints(comment)
        complaints += (refusal for ignored in comment.codes if (refusal := _refusal(ignored, pages)) is not None)
    return tuple(complaints)


def _shape_complaints(comment: IgnoreComment) -> Iterator[Diagnostic]:
    if not comment.codes:
        yield _complaint("unknown-ignored-code", "the comment names no code to ignore", comment.span)
    elif not comment.reason:
        codes = ", ".join(f"`{ignored.code}`" for ignored in comment.codes)
        yield _complaint("ignore-without-reason", f"{codes} is ignored without a reason", comment.span)


def _refusal(ignored: IgnoredCode, pages: Mapping[str, CodePage]) -> Diagnostic | None:
    page, rule = pages.get(ignored.code), _RULES.get(ignored.code)
    if page is None:
        known = did_you_mean(ignored.code, pages, "codes that `cellc explain` lists")
        return _complaint("unknown-ignored-code", f"there is no code `{ignored.code}`", ignored.span, known)
    if (rule is None or ignored.code in _LINK_CODES) and page.severity is Severity.ERROR:
        reason = "without it the cell is not known"
    elif rule is not None and rule.family in _PROTECTED_FAMILIES and rule.severity in _STOPPING:
        reason = f"it is {_article(rule.severity)} of family {rule.family}"
    else:
        return None
    return _complaint("ignore-refused", f"`{ignored.code}` cannot be ignored: {reason}", ignored.span)


def _article(severity: Severity) -> str:
    return f"{'an' if severity is Severity.ERROR else 'a'} {severity.value}"


def _is_on_line(place: Span, comment: Span) -> bool:
    return place.file == comment.file and comment.line in (place.line, place.end_line)


def _may_be_hidden(code: str, reported: set[str]) -> bool:
    """Whether the rule did not run because of something that is reported, so that nobody knows."""
    return code in _RULES and not reported.isdisjoint(_RULES[code].assumes)


def _unused(ignored: IgnoredCode) -> str:
    return f"`{ignored.code}` is not reported on this line"


def _complaint(code: str, message: str, span: Span, advice: str = "") -> Diagnostic:
    page = _PAGES[code]
    return Diagnostic(code, page.severity, message, span, help=advice or page.fix)
