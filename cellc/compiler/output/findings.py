"""The diagnostics of writing the generated folder."""

from __future__ import annotations

from pathlib import Path

from cellc.contract.code_page import page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Diagnostic, Related, Severity, Span


def finding(code: str, message: str, file: Path, advice: str = "") -> Diagnostic:
    """Return the diagnostic; it marks the first line of the file or folder that it is about.

    Raises:
        KeyError: there is no such code.
    """
    place = Span(file.as_posix(), 1, 1, 1, 1)
    return Diagnostic(code, STAGES["output"][code], message, place, (), advice or page_of(code).fix)


def shared_output(name: str, here: Span, first: Span) -> Diagnostic | None:
    """Report that another spec of the call has made the folder already; the same file named twice is no fault.

    Args:
        name: of the cell, and so of its folder.
        here: where the later spec names its cell.
        first: where the earlier one does.
    """
    if Path(here.file).resolve() == Path(first.file).resolve():
        return None
    return Diagnostic(
        "output-shared",
        Severity.ERROR,
        f"two specs of this call are called `{name}` and would replace each other's folder",
        here,
        ("cell",),
        "rename one of the cells, or build them with different `--output` folders",
        (Related("the other cell of this name", first),),
    )
