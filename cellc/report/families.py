"""The groups of codes that a person may name together: families of rules, and stages."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.catalog.codes import CODES as CATALOG_CODES
from cellc.diagnostics.page import CodePage
from cellc.link.codes import CODES as LINK_CODES
from cellc.output.codes import CODES as OUTPUT_CODES
from cellc.rules.ignores import CODES as IGNORE_CODES
from cellc.rules.kit import FAMILIES
from cellc.rules.run import ALL_RULES
from cellc.rules.shared_domain import CODES as FLEET_CODES
from cellc.source.codes import CODES as SOURCE_CODES
from cellc.spec.codes import CODES as SPEC_CODES
from cellc.verify.codes import CODES as VERIFY_CODES

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


def codes_by_family() -> dict[str, frozenset[str]]:
    """Return the codes of every family under short name (``FRM``) and folder (``frames``), and of every stage."""
    return dict(_families())


def family_of(code: str) -> str:
    """Return the folder of a rule's family, or the stage that reports the code; empty for no code of cellc."""
    return next((name for name, codes in _families() if not name.isupper() and code in codes), "")


def _families() -> Iterator[tuple[str, frozenset[str]]]:
    for folder, family in FAMILIES.items():
        codes = frozenset(rule.code for rule in ALL_RULES if rule.family == family)
        yield folder, codes
        yield family, codes
    for stage, pages in STAGES.items():
        yield stage, frozenset(page.code for page in pages)
