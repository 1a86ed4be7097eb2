"""The page of a code: one Markdown file of ``docs/rules``, read when somebody asks for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from cellc.contract.diagnostics import did_you_mean
from cellc.contract.errors import CellcError
from cellc.contract.frozen import dataclass
from cellc.contract.store.regular_file import own_text

_PACKAGE = Path(__file__).resolve().parents[1]
_FOLDERS = (_PACKAGE / "docs" / "rules", _PACKAGE.parent / "docs" / "rules")
"""A wheel brings the pages in the package; in a checkout they lie beside it."""
RENAMED: Mapping[str, str] = {
    "call-without-timeout-behaviour": "call-without-timeout-behavior",
    "catalogue-entry-invalid": "catalog-entry-invalid",
    "misspelt-owner": "misspelled-owner",
    "payload-told-too-late": "payload-set-too-late",
    "unstated-stale-behaviour": "unstated-stale-behavior",
    "unsynchronised-hosts": "unsynchronized-hosts",
    "unsynchronised-sensor-clock": "unsynchronized-sensor-clock",
}
"""Former names of codes. They mean nothing any more, and messages name the new ones."""


class MissingPageError(CellcError):
    """The installation lacks the page of a code."""


@dataclass(frozen=True, slots=True)
class CodePage:
    """A page: heading, title, reason, examples, ``Fix:`` and ``Source:``, in this order.

    Args:
        code: stable kebab-case name of the defect, such as ``duplicate-key``.
        text: Markdown; the examples carry the marks that tests read.
    """

    code: str
    text: str

    @property
    def title(self) -> str:
        """What is wrong, without a full stop."""
        return _one_line(self.text.partition("\n\n")[2])

    @property
    def fix(self) -> str:
        """What to do: the help of every finding that says nothing more precise."""
        return _one_line(self.text.partition("\nFix: ")[2])


@cache
def page_of(code: str) -> CodePage:
    """Read the page of a code.

    Raises:
        MissingPageError: the installation is not complete.
    """
    for folder in _FOLDERS:
        file = folder / f"{code}.md"
        if file.is_file():
            return CodePage(code, own_text(file))
    raise MissingPageError(f"the page of `{code}` is missing from this installation: install cellc again")


def meant_code(code: str, known: Iterable[str], kind: str) -> str:
    """Return the advice on a code that does not exist: its new name, or the nearest codes."""
    return f"it was renamed to `{RENAMED[code]}`" if code in RENAMED else did_you_mean(code, known, kind)


def _one_line(text: str) -> str:
    """Return the first paragraph in one line, without its full stop."""
    return " ".join(text.partition("\n\n")[0].split()).rstrip(".")
