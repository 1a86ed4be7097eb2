"""Begins the evidence of a call, where the package that writes bags is installed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cellc.mock.cell import MockCell
from cellc.mock.errors import MockError

if TYPE_CHECKING:
    from cellc.mock.evidence.collect import EvidenceCollector


def begin_evidence(cell: MockCell, folder: Path, names: Sequence[str], seed: int) -> EvidenceCollector:
    """Return what runs rehearsals of a cell and writes their evidence to a folder.

    Raises:
        MockError: the package is missing, a name is unknown, or the folder cannot take the evidence.
    """
    try:
        from cellc.mock.evidence.collect import EvidenceCollector
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != "mcap":
            raise
        text = "evidence needs the package `mcap`; install it with `pip install 'cellc[evidence]'`"
        raise MockError("", text) from None
    for name in names:
        cell.entry(name)
    return EvidenceCollector(cell, folder, names, seed)
