"""Runs the command in this process and returns what a user would see."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass

from cellc.tools.cli.main import main
from tests.cells import ROOT

PICK = (ROOT / "cells/ur5e_pick/cell.yaml").as_posix()
MINIMAL = (ROOT / "cells/minimal/cell.yaml").as_posix()


@dataclass(frozen=True)
class Ran:
    """Exit code and what was printed."""

    code: int
    out: str
    err: str


def run(*arguments: str) -> Ran:
    """Run ``cellc`` with arguments."""
    out, err = io.StringIO(), io.StringIO()
    code = 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main(list(arguments))
        except SystemExit as end:
            code = end.code if isinstance(end.code, int) else 1
    return Ran(code, out.getvalue(), err.getvalue())
