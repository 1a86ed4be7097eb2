"""Say in our words what the YAML parser complains about."""

from __future__ import annotations

import re

import yaml

from cellc.compiler.source.events import last_written
from cellc.compiler.source.findings import finding
from cellc.contract.diagnostics import Diagnostic, Related, Span
from cellc.contract.limits import limits

# Fragments of the problems that libyaml and PyYAML report, with what they mean to the author of the file.
_MEANINGS: tuple[tuple[str, str, str], ...] = (
    ("values are not allowed", "a second `: ` on one line", "quote the text if the colon belongs to it"),
    ("entries are not allowed", "a list item cannot begin here", "begin the list on a line of its own"),
    ("could not find expected ':'", "a key without a colon", "write `key: value` or indent the line"),
    ("expected ',' or ']'", "the list in brackets is not closed", "add the missing `,` or `]`"),
    ("expected ',' or '}'", "the mapping in braces is not closed", "add the missing `,` or `}`"),
    ("did not find expected key", "the indentation fits no section above", "align the line with its siblings"),
    ("expected <block end>", "the indentation fits no section above", "align the line with its siblings"),
    ("did not find expected '-'", "the indentation fits no list above", "align the dash with its siblings"),
    ("unexpected end of stream", "the quote is not closed", "add the missing quote"),
    ("document separator", "the quote is not closed", "add the missing quote"),
    ("unknown escape character", "an unknown escape after `\\`", "use single quotes, where `\\` is text"),
    ("cannot start any token", "text cannot begin with this character", "put the text in quotes"),
    ("expected node content", "a value is missing here", "write the value, or quote text that begins with it"),
    ("expected the node content", "a value is missing here", "write the value, or quote text that begins with it"),
)

_NESTING = "maximum nesting depth"
"""What the parser says of 1,000 open brackets (libyaml 0.2.6, in PyYAML 6.0.4), which it reads ahead of ours."""
_TOO_DEEP = "the line is indented deeper than the one above, and so continues its value"
_ALIGN = "align the line with its siblings"


def syntax_finding(error: yaml.YAMLError | ValueError, file: str, text: str) -> Diagnostic:
    """Return the finding for an exception of the YAML parser."""
    problem = str(getattr(error, "problem", None) or "the text has no YAML structure")
    span = _problem_span(getattr(error, "problem_mark", None), file, text)
    if _NESTING in problem:
        depth = limits().spec_depth
        return finding("too-deep", f"values are nested more than {depth} deep", span)
    tab = _tab_near(span, text)
    if tab is not None:
        return tab_finding(tab)
    if _continues(problem, span, text):
        return finding("not-yaml", f"not valid YAML: {_TOO_DEEP}", _begin_of(span, text), advice=_ALIGN)
    meaning, advice = _explain(problem)
    start = _span(getattr(error, "context_mark", None), file)
    related = (Related("the part began here", start),) if start.line != span.line and meaning else ()
    message = meaning or problem.replace("\n", " ")
    return finding("not-yaml", f"not valid YAML: {message}", span, advice=advice, related=related)


def tab_finding(span: Span) -> Diagnostic:
    """Return the finding for a tab in the indentation of a line."""
    return finding("tab-indentation", "the line is indented with a tab", span)


def leading_tab(line: str) -> int | None:
    """Return the index of the first tab in the indentation of a line."""
    indentation = line[: len(line) - len(line.lstrip(" \t"))]
    index = indentation.find("\t")
    return index if index >= 0 else None


def _continues(problem: str, span: Span, text: str) -> bool:
    """Whether the first `: ` of a line is one too many, because the line hangs on the value of one above."""
    before = text.split("\n")[span.line - 1][: span.column - 1]
    return "values are not allowed" in problem and re.search(r":\s", before) is None


def _begin_of(span: Span, text: str) -> Span:
    """Return the first character of a line that is not its indentation."""
    line = text.split("\n")[span.line - 1]
    column = len(line) - len(line.lstrip(" ")) + 1
    return Span(span.file, span.line, column, span.line, column + 1)


def _explain(problem: str) -> tuple[str, str]:
    for fragment, meaning, advice in _MEANINGS:
        if fragment in problem:
            return meaning, advice
    return "", ""


def _problem_span(mark: yaml.Mark | None, file: str, text: str) -> Span:
    """Return the marked character, or where the text ends if the parser complains about its end."""
    span = _span(mark, file)
    lines = text.split("\n")
    if any(line.strip() for line in lines[span.line - 1 :]):
        return span
    line, column = last_written(lines, span.line - 1, 0)
    return Span(file, line + 1, column + 1, line + 1, column + 2)


def _span(mark: yaml.Mark | None, file: str) -> Span:
    if mark is None:
        return Span(file, 1, 1, 1, 1)
    return Span(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2)


def _tab_near(span: Span, text: str) -> Span | None:
    """Find a tab in the indentation of the marked line or the one before, where parsers notice it late."""
    lines = text.split("\n")
    for number in (span.line, span.line - 1):
        index = leading_tab(lines[number - 1]) if 1 <= number <= len(lines) else None
        if index is not None:
            return Span(span.file, number, index + 1, number, index + 2)
    return None
