"""All that a rule file imports: the decorator that makes its check a rule, and the words in which it reports.

A file ``cellc/compiler/rules/<family>/<code>.py`` holds one rule. Its name says the code, its folder the family, and
its docstring is the page that ``cellc explain`` prints: title, reason, two examples, fix, source.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.diagnostics import Related, Severity, Span, YamlPath, did_you_mean

__all__ = [
    "CellGraph",
    "Finding",
    "Findings",
    "Related",
    "Rule",
    "Severity",
    "YamlPath",
    "did_you_mean",
    "found",
    "rule",
]

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
"""Folder under ``cellc.compiler.rules`` → short name of the family, in the order in which pages list them."""


@dataclass(frozen=True, slots=True)
class Finding:
    """What a check yields; the rule adds code and severity, and its fix where ``help`` is empty."""

    message: str
    span: Span
    path: YamlPath = ()
    help: str = ""
    related: tuple[Related, ...] = ()


Findings = Iterator[Finding]
Check = Callable[[CellGraph], Findings]


@dataclass(frozen=True, slots=True)
class Rule:
    """One defect that cellc knows.

    Args:
        code: names the defect in kebab case and reads well after "allow".
        family: short name, such as FRM.
        page: documentation in Markdown, the docstring of the rule's file.
        assumes: codes whose absence this rule builds on; it is skipped where one of them was reported.
    """

    code: str
    family: str
    severity: Severity
    check: Check
    page: str
    assumes: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """The first line of the page, without its full stop."""
        return self.page.partition("\n")[0].rstrip(".")

    @property
    def fix(self) -> str:
        """What to do, in one line: the help of every finding that says nothing more precise."""
        text = self.page.partition("\nFix: ")[2].partition("\n\n")[0]
        return " ".join(text.split()).rstrip(".")


def rule(severity: Severity, assumes: tuple[str, ...] = ()) -> Callable[[Check], Rule]:
    """Make the check of a file its rule."""

    def make(check: Check) -> Rule:
        folder, file = check.__module__.split(".")[-2:]
        page = sys.modules[check.__module__].__doc__
        if page is None:
            raise RuntimeError(f"`{check.__module__}` must have a docstring, its page; `python -OO` leaves none")
        return Rule(file.replace("_", "-"), FAMILIES[folder], severity, check, page, assumes)

    return make


def found(
    graph: CellGraph, path: YamlPath, message: str, help_text: str = "", related: tuple[Related, ...] = ()
) -> Finding:
    """Report something at a path, or at its nearest ancestor where the path is what is missing."""
    return Finding(message, graph.cell.locate(*path), path, help_text, related)
