"""The documentation page of every code that cellc can report, rules and stages alike."""

from __future__ import annotations

import re

from cellc.diagnostics.page import CodePage
from cellc.report.families import STAGES
from cellc.rules.run import ALL_RULES

_MARK = re.compile(r"^(?:#|<!--) expect.*\n|  (?:#|<!--) expect.*$", re.MULTILINE)


def all_pages() -> dict[str, CodePage]:
    """Return the pages by code, in alphabetical order."""
    pages = [page for stage in STAGES.values() for page in stage]
    pages += [CodePage(rule.code, rule.severity, rule.title, _body(rule.page), "") for rule in ALL_RULES]
    return {page.code: page for page in sorted(pages, key=lambda page: page.code)}


def render_page(page: CodePage) -> str:
    """Write a page as Markdown."""
    title = page.title[0].upper() + page.title[1:]
    fix = f"\nFix: {page.fix}.\n" if page.fix else ""
    return f"# {page.code} ({page.severity.value})\n\n{title}.\n\n{page.why.strip()}\n{fix}"


def _body(page: str) -> str:
    """Return a rule's docstring without its title line, and without the marks by which the tests know what is found."""
    return _MARK.sub("", page.partition("\n")[2])
