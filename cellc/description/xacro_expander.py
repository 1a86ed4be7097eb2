"""Expansion of a stranger's xacro file in a child process with bounded time, memory and output.

The interpreter and the confinement already refuse what reaches out; the process is the wall behind them, and what
ends an expansion that merely takes too long.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import cellc
from cellc.description.xacro_expansion import Expansion
from cellc.diagnostics import Diagnostic, Outcome, Severity, Span

WALL_SECONDS = 10.0


def expand_xacro(
    file: Path, arguments: Mapping[str, str], root: Path, wall_seconds: float = WALL_SECONDS
) -> Outcome[Expansion]:
    """Expand a xacro file that the compiler does not vouch for.

    Args:
        file: the xacro file, as the user named it.
        arguments: values of ``<xacro:arg>``.
        root: the folder that no file may lie outside of.
        wall_seconds: time after which the expansion is ended.

    Returns:
        The URDF text with the places of its links and joints, or diagnostics; never an exception.
    """
    request = {
        "file": file.as_posix(),
        "arguments": dict(arguments),
        "root": root.as_posix(),
        "folder": os.getcwd(),
    }
    start = Span(file.as_posix(), 1, 1, 1, 1)
    try:
        answer = subprocess.run(
            [sys.executable, "-m", "cellc.description.xacro_child"],
            input=json.dumps(request).encode(),
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            # `-m` puts the current folder first on the import path: it must not be one that a stranger filled.
            cwd=Path(cellc.__file__).resolve().parents[1],
            env={**os.environ, "PYTHONHASHSEED": "0"},
            timeout=wall_seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return _ended(f"the expansion takes longer than {wall_seconds:g} s", start)
    if answer.returncode != 0:
        return _ended("the expansion takes more time or memory than it may use", start)
    return _decoded(json.loads(answer.stdout))


def _ended(message: str, start: Span) -> Outcome[Expansion]:
    help_text = "look for a macro or an include that calls itself"
    return Outcome(None, (Diagnostic("xacro-too-large", Severity.ERROR, message, start, help=help_text),))


def encode(outcome: Outcome[Expansion]) -> dict[str, Any]:
    """Write an outcome as JSON values, for the way from the child to the parent."""
    expansion = outcome.value
    return {
        "text": None if expansion is None else expansion.text,
        "origins": [] if expansion is None else [[*key, _span_list(span)] for key, span in expansion.origins.items()],
        "diagnostics": [
            [found.code, found.severity.value, found.message, _span_list(found.span), found.help]
            for found in outcome.diagnostics
        ],
    }


def _span_list(span: Span) -> list[str | int]:
    return [span.file, span.line, span.column, span.end_line, span.end_column]


def _decoded(answer: dict[str, Any]) -> Outcome[Expansion]:
    diagnostics = tuple(
        Diagnostic(code, Severity(severity), message, Span(*span), help=help_text)
        for code, severity, message, span, help_text in answer["diagnostics"]
    )
    if answer["text"] is None:
        return Outcome(None, diagnostics)
    origins = {(tag, name): Span(*span) for tag, name, span in answer["origins"]}
    return Outcome(Expansion(answer["text"], origins), diagnostics)
