"""Runs the examples of `docs/python.md` in one session: what each prints stands below it.

After a message has changed, `python -m tests.docs.python_page` writes what is printed now into the page.
"""

from __future__ import annotations

import io
import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path

from tests.cells import ROOT

PAGE = ROOT / "docs/python.md"
_EXAMPLE = re.compile(r"```python\n(.*?)```\n\n```text\n(.*?)```", re.DOTALL)


def snippets(page: str) -> list[str]:
    """Return the code of every example."""
    return [match[1] for match in _EXAMPLE.finditer(page)]


def rerun(page: str, folder: Path) -> str:
    """Return the page with what its examples print in a folder with the smallest cell; none may end in an exception."""
    shutil.copy(ROOT / "cells/minimal/cell.yaml", folder)
    session: dict[str, object] = {}

    def run(match: re.Match[str]) -> str:
        printed = io.StringIO()
        with redirect_stdout(printed):
            exec(compile(match[1], PAGE.name, "exec"), session)
        return f"```python\n{match[1]}```\n\n```text\n{printed.getvalue()}```"

    with _inside(folder):
        return _EXAMPLE.sub(run, page)


@contextmanager
def _inside(folder: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        PAGE.write_text(rerun(PAGE.read_text(encoding="utf-8"), Path(place)), encoding="utf-8")
