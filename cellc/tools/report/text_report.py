"""Findings, differences and diagnoses as lines for people."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from cellc.contract.diagnostics import Diagnostic, Severity, Span
from cellc.contract.printing import Line, Style, Styled
from cellc.tools.report.snippet import Texts, render_snippet

if TYPE_CHECKING:
    from cellc.compiler.output.compare import Difference

_SHOWN = 100
"""Findings of one code; `--format json` has all."""
SEVERITY_STYLES: Mapping[Severity, Style] = {
    Severity.ERROR: Style.RED,
    Severity.BLOCKER: Style.MAGENTA,
    Severity.WARNING: Style.YELLOW,
    Severity.AUDIT: Style.CYAN,
}


def render_text(diagnostics: Iterable[Diagnostic], texts: Mapping[str, str]) -> list[Line]:
    """Return every finding with its place, the worst first, those alike by place, separated by empty lines.

    Args:
        texts: the text of every file that was read, by the name that spans carry, with line breaks as ``\\n``.
    """
    lines: Texts = {file: text.split("\n") for file, text in texts.items()}
    shown: list[Line] = []
    for diagnostic in _first_of_each_code(sorted(diagnostics, key=_worst_first)):
        shown += ["", *_render(diagnostic, lines)]
    return shown[1:]


def _first_of_each_code(diagnostics: Sequence[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield as many findings of each code as a person reads; the last of a code says how many more there are."""
    left = Counter(diagnostic.code for diagnostic in diagnostics)
    number: Counter[str] = Counter()
    for diagnostic in diagnostics:
        number[diagnostic.code] += 1
        left[diagnostic.code] -= 1
        if number[diagnostic.code] == _SHOWN and left[diagnostic.code]:
            more = f"not shown: {left[diagnostic.code]} more `{diagnostic.code}`"
            yield replace(diagnostic, help="; ".join(filter(None, (diagnostic.help, more))))
        elif number[diagnostic.code] <= _SHOWN:
            yield diagnostic


def _worst_first(diagnostic: Diagnostic) -> tuple[int, tuple[Span, str, str]]:
    return diagnostic.severity.rank, diagnostic.sort_key()


def _render(diagnostic: Diagnostic, texts: Texts) -> Iterator[Line]:
    style = SEVERITY_STYLES[diagnostic.severity]
    gutter = _gutter(diagnostic)
    head = Styled(f"{diagnostic.severity.value}[{diagnostic.code}]", style)
    yield head, Styled(f": {diagnostic.message}", Style.BOLD)
    yield from render_snippet(diagnostic.span, texts, gutter=gutter, mark="^", style=style)
    for related in diagnostic.related:
        yield Styled("note", Style.BLUE), f": {related.message}"
        yield from render_snippet(related.span, texts, gutter=gutter, mark="-", style=Style.BLUE)
    if diagnostic.help:
        yield Styled("help", Style.GREEN), f": {diagnostic.help}"


def _gutter(diagnostic: Diagnostic) -> int:
    numbers = [diagnostic.span.line, *(related.span.line for related in diagnostic.related)]
    return len(str(max(numbers)))


def counts(diagnostics: Iterable[Diagnostic]) -> dict[str, int]:
    """Return the number of findings of every severity, the worst first, zeros included."""
    counter = Counter(diagnostic.severity for diagnostic in diagnostics)
    return {severity.value: counter[severity] for severity in Severity}


def summary(diagnostics: Iterable[Diagnostic], files: Sequence[str]) -> Line:
    """Return such as ``2 errors, 1 blocker in cells/a.yaml``, or that nothing was found.

    Args:
        files: the specs that were checked, as the user named them.
    """
    by_severity = counts(diagnostics)
    parts = [_part(severity, by_severity[severity.value]) for severity in Severity if by_severity[severity.value]]
    place = files[0] if len(files) == 1 else f"{len(files)} files"
    pieces = parts or [Styled("no findings", Style.GREEN)]
    listed = (piece for part in pieces for piece in (", ", part))
    return (*tuple(listed)[1:], f" in {place}")


def summed_blockers(diagnostics: Iterable[Diagnostic], file: str) -> list[Line]:
    """Return in two lines how many blockers of which code keep the real target closed, and who shows each of them."""
    by_code = Counter(diagnostic.code for diagnostic in diagnostics if diagnostic.severity is Severity.BLOCKER)
    if not by_code:
        return []
    codes = ", ".join(f"{number} {code}" for code, number in sorted(by_code.items(), key=lambda one: (-one[1], one[0])))
    command = shlex.quote(file)
    return [
        f"not cleared for hardware: {codes}",
        f"`cellc check {command}` lists them, `cellc audit {command}` names the person who can answer",
    ]


def summed_errors(diagnostics: Iterable[Diagnostic], file: str) -> list[Line]:
    """Return in two lines how many errors there are and where the first is, and who shows each of them."""
    errors = sorted(
        (diagnostic for diagnostic in diagnostics if diagnostic.severity is Severity.ERROR), key=Diagnostic.sort_key
    )
    if not errors:
        return []
    first = errors[0]
    which = "" if len(errors) == 1 else ", the first"
    return [
        (_part(Severity.ERROR, len(errors)), f"{which} at {first.span}: {first.message}"),
        f"`cellc check {shlex.quote(file)}` shows {'it' if len(errors) == 1 else 'each'}",
    ]


def _part(severity: Severity, number: int) -> Styled:
    return Styled(severity.counted(number), SEVERITY_STYLES[severity])


_WHY = {
    "missing": "is missing",
    "outdated": "is from an earlier build",
    "edited": "was edited by hand",
    "unexpected": "is no longer part of the cell",
}


def render_difference(difference: Difference, folder: Path) -> list[Line]:
    """Return one difference: the file, why it differs, and its first differing line."""
    path = (folder / difference.path).as_posix()
    if not difference.line:
        return [f"{path}: {_WHY[difference.kind]}"]
    head = f"{path}:{difference.line}: {_WHY[difference.kind]}"
    return [head, f"  - {_cut(difference.found)}", f"  + {_cut(difference.expected)}"]


def _cut(line: str | None) -> str:
    return "(end of file)" if line is None else line[:160]
