"""Every code that comparing the cells of one call can report, with its documentation page."""

from __future__ import annotations

from cellc.diagnostics import Severity
from cellc.diagnostics.page import CodePage

CODES: tuple[CodePage, ...] = (
    CodePage(
        "shared-domain-id",
        Severity.ERROR,
        "two cells of one call share a domain on one network",
        "Nodes of one domain that can reach each other are one graph: topics, transforms and action servers of both "
        "cells meet under the same names, and a goal for one robot may be accepted by the other. Cells are compared "
        "where they are named in one call, such as `cellc check cells/*/cell.yaml`; cells whose hosts share an address "
        "are taken for variants of one cell. A domain is a partition against accidents, no protection.",
        "give each cell a domain id of its own; 0 to 101 are safe on every platform",
    ),
)
