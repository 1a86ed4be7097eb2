"""The mock backend: executes a generated folder, and knows nothing of the compiler that wrote it."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from cellc.contract.attempt import AttemptRecord
    from cellc.mock.cell import MockCell, load, run_all
    from cellc.mock.errors import MockError
    from cellc.mock.result import RehearsalResult, to_json_lines

__all__ = ["AttemptRecord", "MockCell", "MockError", "RehearsalResult", "load", "run_all", "to_json_lines"]

_HOMES = {
    "AttemptRecord": "cellc.contract.attempt",
    "MockCell": "cellc.mock.cell",
    "MockError": "cellc.mock.errors",
    "RehearsalResult": "cellc.mock.result",
    "load": "cellc.mock.cell",
    "run_all": "cellc.mock.cell",
    "to_json_lines": "cellc.mock.result",
}


def __getattr__(name: str) -> object:
    """Load what is asked for: `python -m cellc.mock` passes here before it can answer Ctrl-C in words."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
