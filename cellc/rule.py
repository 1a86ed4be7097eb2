"""What a rule is: a code, a page, and a check that yields findings on the graph."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from cellc.diagnostics import Related, Severity, Span, YamlPath
from cellc.graph.cell_graph import CellGraph


@dataclass(frozen=True, slots=True)
class Finding:
    """What a check yields; the rule adds code and severity."""

    message: str
    span: Span
    path: YamlPath = ()
    help: str = ""
    related: tuple[Related, ...] = ()


@dataclass(frozen=True, slots=True)
class Rule:
    """One defect that cellc knows.

    Args:
        code: names the defect in kebab case and reads well after "allow".
        family: FRM, TIM, INT, QOS, OWN, VER, CTL, MOT, NET, LIF, SAF or LOG, as in the list of checks.
        title: one line.
        page: documentation in Markdown, the docstring of the rule's file.
        assumes: codes whose absence this rule builds on; it is skipped where one of them was reported.
    """

    code: str
    family: str
    title: str
    severity: Severity
    page: str
    check: Callable[[CellGraph], Iterator[Finding]]
    assumes: tuple[str, ...] = ()
