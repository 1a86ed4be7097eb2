"""How a generated folder differs from what its cell makes, for people."""

from __future__ import annotations

from pathlib import Path

from cellc.output.compare import Difference
from cellc.report.escape import escape

_WHY = {
    "missing": "is missing",
    "outdated": "is from an earlier build",
    "edited": "was edited by hand",
    "unexpected": "is no longer made by the cell",
}


def render_difference(difference: Difference, folder: Path) -> str:
    """Write one difference: the file, why it differs, and its first differing line."""
    path = (folder / difference.path).as_posix()
    text = f"{path}: {_WHY[difference.kind]}"
    if difference.line:
        text = f"{path}:{difference.line}: {_WHY[difference.kind]}"
        text += f"\n  - {_line(difference.found)}\n  + {_line(difference.due)}"
    return text


def _line(line: str | None) -> str:
    return "(end of file)" if line is None else escape(line)[:160]
