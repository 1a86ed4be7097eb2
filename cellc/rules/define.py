"""How a rule file declares its rule: the page says the title, the folder says the family."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding, Rule

FAMILIES = {
    "model": "MOD",
    "frames": "FRM",
    "clocks": "TIM",
    "interfaces": "INT",
    "qos": "QOS",
    "ownership": "OWN",
    "versions": "VER",
    "control": "CTL",
    "motion": "MOT",
    "network": "NET",
    "bringup": "LIF",
    "safety": "SAF",
    "evidence": "LOG",
}
"""Folder under ``cellc.rules`` → family in the list of checks; MOD is what a robot description can get wrong."""


def define(
    code: str,
    severity: Severity,
    check: Callable[[CellGraph], Iterator[Finding]],
    page: str,
    assumes: tuple[str, ...] = (),
) -> Rule:
    """Make the rule of a file from its docstring and its check."""
    folder = check.__module__.split(".")[-2]
    title = page.partition("\n")[0].rstrip(".")
    return Rule(code, FAMILIES[folder], title, severity, page, check, assumes)
