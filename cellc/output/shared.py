"""Two specs of one call that would make the same folder."""

from __future__ import annotations

from pathlib import Path

from cellc.diagnostics import Diagnostic, Related, Severity, Span


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
