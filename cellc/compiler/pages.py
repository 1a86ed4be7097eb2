"""Every code that cellc can report, the families and stages that group them, and their pages as a handbook."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from importlib import import_module

from cellc.compiler.rules.kit import FAMILIES
from cellc.compiler.rules.run import ALL_RULES
from cellc.contract.code_page import CodePage, page_of
from cellc.contract.codes import STAGES
from cellc.contract.diagnostics import Severity

_MARK = re.compile(r"^(?:#|<!--) expect.*\n|  (?:#|<!--) expect.*$", re.MULTILINE)
"""In the examples of a page, what tells the tests where the finding is expected."""
_LINK = re.compile(r"\[([\w.#-]+)\]\(\.\./\1\)")
"""To another page of ``docs``; on a terminal it is its path."""
_WRITTEN = "Written by `cellc explain --all -o docs/rules`; the pages that it lists are written by hand."


def all_codes() -> dict[str, Severity]:
    """Return the severity of every code, in alphabetical order."""
    severities = {code: severity for codes in STAGES.values() for code, severity in codes.items()}
    severities.update((rule.code, rule.severity) for rule in ALL_RULES)
    return dict(sorted(severities.items()))


def render_page(page: CodePage) -> str:
    """Return a page without what only its tests and its folder need."""
    return _LINK.sub(r"docs/\1", _MARK.sub("", page.text))


def codes_by_family() -> dict[str, frozenset[str]]:
    """Return the codes of every family under short name (``FRM``) and folder (``frames``), and of every stage."""
    return dict(_families())


def family_of(code: str) -> str:
    """Return the folder of a rule's family, or the stage that reports the code; empty for no code of cellc."""
    return next((name for name, codes in _families() if not name.isupper() and code in codes), "")


def render_handbook() -> dict[str, str]:
    """Return the files of ``docs/rules``: an index, and the page of every code as it is written."""
    families, index = codes_by_family(), ["# Every code of cellc\n", f"{_WRITTEN}\n"]
    for folder, family in FAMILIES.items():
        index += [f"## {family}: {_about(folder)}\n", *_rows(families[family])]
    index += ["## Codes of the stages around the rules\n", *_rows(code for codes in STAGES.values() for code in codes)]
    return {"README.md": "\n".join(index), **{f"{code}.md": page_of(code).text for code in all_codes()}}


def _families() -> Iterator[tuple[str, frozenset[str]]]:
    for folder, family in FAMILIES.items():
        codes = frozenset(rule.code for rule in ALL_RULES if rule.family == family)
        yield folder, codes
        yield family, codes
    for stage, severities in STAGES.items():
        yield stage, frozenset(severities)


def _about(folder: str) -> str:
    """Return what the rules of a family are on, as its package says."""
    text = import_module(f"cellc.compiler.rules.{folder}").__doc__ or ""
    return text.strip().removeprefix("Rules on ").rstrip(".")


def _rows(codes: Iterable[str]) -> Iterator[str]:
    severities = all_codes()
    yield "| code | severity | what is wrong |\n|---|---|---|"
    for code in sorted(codes):
        yield f"| [{code}]({code}.md) | {severities[code].value} | {page_of(code).title} |"
    yield ""
