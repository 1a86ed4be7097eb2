"""Edits of a generated folder by hand, what a run of each shows, and the table of them in docs/mock.md.

`python -m tests.mock.edits` writes the table again.
"""

from __future__ import annotations

from dataclasses import dataclass

from tests.cells import ROOT
from tests.foreign_yaml import safe_load

PAGE = ROOT / "docs" / "mock.md"
BEGIN, END = "<!-- begin of what `python -m tests.mock.edits` writes -->\n", "<!-- end -->\n"


@dataclass(frozen=True)
class Edit:
    """A row of edits.yaml."""

    what: str
    file: str
    before: str
    after: str
    runs: str = ""
    outcome: str = ""
    stuck: str = ""
    refused: bool = False
    not_shown: str = ""


EDITS = tuple(Edit(**row) for row in safe_load((ROOT / "tests" / "mock" / "edits.yaml").read_text(encoding="utf-8")))


def table() -> str:
    """Return what stands in docs/mock.md between its marks."""
    rows = "".join(f"| `{edit.file}` | {edit.what} | {_then(edit)} |\n" for edit in EDITS)
    return f"{len(EDITS)} edits, each of them tried:\n\n| file | edit by hand | `--edited` |\n|---|---|---|\n{rows}"


def _then(edit: Edit) -> str:
    if edit.runs:
        stuck = f" with `{edit.stuck}` stuck" if edit.stuck else ""
        return f"executed: `{edit.runs}`{stuck} differs, and ends as `{edit.outcome}`"
    return "refused" if edit.refused else f"runs, with a note: {edit.not_shown}"


if __name__ == "__main__":
    text = PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(BEGIN)
    PAGE.write_text(f"{head}{BEGIN}\n{table()}\n{END}{rest.partition(END)[2]}", encoding="utf-8")
