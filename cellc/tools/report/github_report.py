"""Diagnostics as workflow commands of GitHub Actions, which shows them beside the lines of a pull request.

One line a finding: ``::error file=…,line=…,col=…,endLine=…,endColumn=…,title=CODE::message``. Columns are only
understood within one line.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import PurePath, PurePosixPath
from urllib.parse import quote

from cellc.contract.diagnostics import Diagnostic, Severity
from cellc.contract.printing import WorkflowCommand

_COMMANDS = {
    Severity.ERROR: "error",
    Severity.BLOCKER: "warning",
    Severity.WARNING: "warning",
    Severity.AUDIT: "notice",
}


def render_github(diagnostics: Iterable[Diagnostic], folder: PurePath) -> list[WorkflowCommand]:
    """Return one command a finding, ordered by place.

    Args:
        folder: absolute; the root of the checkout, from which GitHub counts paths.
    """
    return [_command(diagnostic, folder) for diagnostic in sorted(diagnostics, key=Diagnostic.sort_key)]


def _command(diagnostic: Diagnostic, folder: PurePath) -> WorkflowCommand:
    span = diagnostic.span
    properties: dict[str, str | int] = {"file": relative_file(span.file, folder), "line": span.line}
    if span.line == span.end_line:
        properties |= {"col": span.column, "endLine": span.end_line, "endColumn": span.end_column}
    else:
        properties["endLine"] = span.end_line
    properties["title"] = f"{diagnostic.severity.value}[{diagnostic.code}]"
    message = (diagnostic.message, *([f"help: {diagnostic.help}"] if diagnostic.help else []))
    return WorkflowCommand(_COMMANDS[diagnostic.severity], properties, message)


def relative_file(file: str, folder: PurePath) -> str:
    """Return a file relative to ``folder`` where it lies in it, else as it is named; with forward slashes.

    Args:
        file: as spans carry it.
        folder: absolute.
    """
    path = PurePath(file)
    if path.is_absolute() and path.is_relative_to(folder):
        path = path.relative_to(folder)
    return str(PurePosixPath(path.as_posix()))


def file_uri(file: str, folder: PurePath) -> str:
    """Return the URI reference of a file (RFC 3986): relative as by `relative_file`, or with the scheme ``file``."""
    path = PurePath(relative_file(file, folder))
    # A colon in the first segment would begin a scheme (section 4.2), so it is written as an escape like all others.
    return path.as_uri() if path.is_absolute() else quote(os.fsencode(path.as_posix()))
