"""All pages as one Markdown document: ``docs/rules.md``."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics.page import CodePage
from cellc.report.families import STAGES, codes_by_family
from cellc.report.pages import all_pages, render_page
from cellc.rules.kit import FAMILIES

_HEAD = """# Every code of cellc

Written by `cellc explain --all -o docs/rules.md`; not to be edited. `cellc explain CODE` prints one of these pages.
"""


def render_handbook() -> str:
    """Return an index by family and stage, and then every page in alphabetical order."""
    pages = all_pages()
    blocks = [_HEAD, *_index(pages), *(_page(page) for page in pages.values())]
    return "\n".join(blocks)


def _index(pages: dict[str, CodePage]) -> Iterator[str]:
    families = codes_by_family()
    for folder, family in FAMILIES.items():
        yield f"## {family}: {folder}\n"
        yield from _rows(pages, families[family])
    for stage in STAGES:
        yield f"## Stage: {stage}\n"
        yield from _rows(pages, families[stage])


def _rows(pages: dict[str, CodePage], codes: frozenset[str]) -> Iterator[str]:
    yield "| code | severity | what is wrong |\n|---|---|---|"
    for code in sorted(codes):
        severity, title = pages[code].severity.value, pages[code].title
        yield f"| [{code}](#{code}-{severity}) | {severity} | {title} |"
    yield ""


def _page(page: CodePage) -> str:
    # One level below the title of the document.
    return f"#{render_page(page)}"
