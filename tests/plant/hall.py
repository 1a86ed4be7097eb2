"""The plant of the tests: two lines that hand parts over, changed line by line."""

from __future__ import annotations

import shutil
from pathlib import Path

from cellc.compiler.pipeline import Checked, judge
from tests.cells import there

HALL = Path(__file__).parent / "hall"


def hall(folder: Path, *edits: tuple[str, str, str]) -> Path:
    """Copy the plant with texts replaced: file, what it holds once, and what is there then; return its spec."""
    top = folder / "hall"
    shutil.copytree(HALL, top)
    for name, before, after in edits:
        file = top / name
        text = file.read_text(encoding="utf-8")
        assert text.count(before) == 1, (name, before)
        file.write_text(text.replace(before, after), encoding="utf-8")
    return top / "plant.yaml"


def found(folder: Path, *edits: tuple[str, str, str]) -> list[tuple[str, str, int]]:
    """Return code, file and line of each finding of the changed plant."""
    spec = hall(folder, *edits)
    top = spec.parent.as_posix()
    return [(each.code, each.span.file.removeprefix(f"{top}/"), each.span.line) for each in judge(spec).diagnostics]


def checked(folder: Path, *edits: tuple[str, str, str]) -> Checked:
    """Check the changed plant, which has no findings."""
    result = judge(hall(folder, *edits))
    assert result.diagnostics == ()
    return there(result)
