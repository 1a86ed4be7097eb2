"""The documentation page of every code that cellc can report, and the families and stages that codes are grouped by."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import import_module

from cellc.compiler.catalog.codes import CODES as CATALOG_CODES
from cellc.compiler.link.codes import CODES as LINK_CODES
from cellc.compiler.output.codes import CODES as OUTPUT_CODES
from cellc.compiler.rules.ignores import CODES as IGNORE_CODES
from cellc.compiler.rules.kit import FAMILIES
from cellc.compiler.rules.run import ALL_RULES
from cellc.compiler.rules.shared_domain import CODES as FLEET_CODES
from cellc.compiler.source.codes import CODES as SOURCE_CODES
from cellc.compiler.spec.codes import CODES as SPEC_CODES
from cellc.compiler.verify.codes import CODES as VERIFY_CODES
from cellc.contract.diagnostics.diagnostic import CodePage

STAGES: dict[str, tuple[CodePage, ...]] = {
    "source": SOURCE_CODES,
    "spec": SPEC_CODES,
    "catalog": CATALOG_CODES,
    "link": LINK_CODES,
    "ignores": IGNORE_CODES,
    "fleet": FLEET_CODES,
    "verify": VERIFY_CODES,
    "output": OUTPUT_CODES,
}
"""Stage → its codes, in the order in which a cell passes the stages."""
_MARK = re.compile(r"^(?:#|<!--) expect.*\n|  (?:#|<!--) expect.*$", re.MULTILINE)
"""In the examples of a rule, what tells the tests where the finding is expected."""
_OWN_PAGE = re.compile(r"(?<!/)\bdocs/(\w+\.md)(#[\w-]+)?")  # not at the end of an address
_WRITTEN = (
    "Written by `cellc explain --all -o docs/rules`; not to be edited. `cellc explain CODE` prints one of these pages."
)


def all_pages() -> dict[str, CodePage]:
    """Return the pages by code, in alphabetical order."""
    pages = [page for stage in STAGES.values() for page in stage]
    pages += [CodePage(rule.code, rule.severity, rule.title, _body(rule.page), "") for rule in ALL_RULES]
    return {page.code: page for page in sorted(pages, key=lambda page: page.code)}


def render_page(page: CodePage) -> str:
    """Write a page as Markdown."""
    title = page.title[0].upper() + page.title[1:]
    shown = _MARK.sub("", page.example).strip()
    language = {"<": "xml", "$": "console"}.get(shown[:1], "yaml")
    example = f"\nExample that is reported:\n\n```{language}\n{shown}\n```\n" if shown else ""
    fix = f"\nFix: {page.fix}.\n" if page.fix else ""
    return f"# {page.code} ({page.severity.value})\n\n{title}.\n\n{page.why.strip()}\n{example}{fix}"


def codes_by_family() -> dict[str, frozenset[str]]:
    """Return the codes of every family under short name (``FRM``) and folder (``frames``), and of every stage."""
    return dict(_families())


def family_of(code: str) -> str:
    """Return the folder of a rule's family, or the stage that reports the code; empty for no code of cellc."""
    return next((name for name, codes in _families() if not name.isupper() and code in codes), "")


def render_handbook() -> dict[str, str]:
    """Return the files of ``docs/rules``: an index, one document for each family of rules, and one for the stages."""
    pages, families = all_pages(), codes_by_family()
    documents = {f"{folder}.md": [f"# {family}: {_about(folder)}", folder] for folder, family in FAMILIES.items()}
    documents["stages.md"] = ["# Codes of the stages around the rules", *STAGES]
    index = ["# Every code of cellc\n", f"{_WRITTEN}\n"]
    files = {}
    for name, (title, *groups) in documents.items():
        codes = sorted(code for group in groups for code in families[group])
        index += [f"#{title}\n", *_rows(name, [pages[code] for code in codes])]
        text = "\n".join([f"{title}\n", f"{_WRITTEN}\n", *(f"#{render_page(pages[code])}" for code in codes)])
        files[name] = _OWN_PAGE.sub(r"[\1\2](../\1\2)", text)
    return {"README.md": "\n".join(index), **files}


def _families() -> Iterator[tuple[str, frozenset[str]]]:
    for folder, family in FAMILIES.items():
        codes = frozenset(rule.code for rule in ALL_RULES if rule.family == family)
        yield folder, codes
        yield family, codes
    for stage, pages in STAGES.items():
        yield stage, frozenset(page.code for page in pages)


def _body(page: str) -> str:
    """Return a rule's docstring without its title line, and without the marks of its examples."""
    return _MARK.sub("", page.partition("\n")[2])


def _about(folder: str) -> str:
    """Return what the rules of a family are on, as its package says."""
    text = import_module(f"cellc.compiler.rules.{folder}").__doc__ or ""
    return text.strip().removeprefix("Rules on ").rstrip(".")


def _rows(file: str, pages: list[CodePage]) -> Iterator[str]:
    yield "| code | severity | what is wrong |\n|---|---|---|"
    for page in pages:
        severity = page.severity.value
        yield f"| [{page.code}]({file}#{page.code}-{severity}) | {severity} | {page.title} |"
    yield ""
