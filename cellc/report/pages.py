"""The documentation page of every code that cellc can report, rules and stages alike."""

from __future__ import annotations

from cellc.catalog.codes import CODES as CATALOG_CODES
from cellc.diagnostics.page import CodePage
from cellc.link.codes import CODES as LINK_CODES
from cellc.output.codes import CODES as OUTPUT_CODES
from cellc.rules.all_rules import ALL_RULES
from cellc.rules.ignore_codes import CODES as IGNORE_CODES
from cellc.source.codes import CODES as SOURCE_CODES
from cellc.spec.codes import CODES as SPEC_CODES
from cellc.verify.codes import CODES as VERIFY_CODES

STAGES: tuple[tuple[CodePage, ...], ...] = (
    SOURCE_CODES,
    SPEC_CODES,
    CATALOG_CODES,
    LINK_CODES,
    IGNORE_CODES,
    VERIFY_CODES,
    OUTPUT_CODES,
)


def all_pages() -> dict[str, CodePage]:
    """Return the pages by code, in alphabetical order."""
    pages = [page for stage in STAGES for page in stage]
    pages += [CodePage(rule.code, rule.severity, rule.title, _body(rule.page), "") for rule in ALL_RULES]
    return {page.code: page for page in sorted(pages, key=lambda page: page.code)}


def render_page(page: CodePage) -> str:
    """Write a page as Markdown."""
    title = page.title[0].upper() + page.title[1:]
    fix = f"\nFix: {page.fix}.\n" if page.fix else ""
    return f"# {page.code} ({page.severity.value})\n\n{title}.\n\n{page.why.strip()}\n{fix}"


def _body(page: str) -> str:
    """Return a rule's docstring without its title line."""
    return page.partition("\n")[2]
