"""Finds all rules in their folders, and runs them over a cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache
from graphlib import TopologicalSorter
from importlib import import_module
from pkgutil import iter_modules

from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.rules.kit import FAMILIES, Rule
from cellc.contract.diagnostics import Diagnostic, Severity


def _rules_of(family: str) -> Iterator[Rule]:
    """Yield the rules of all modules in the folder of a family, in no particular order."""
    package = import_module(f"cellc.compiler.rules.{family}")
    for topic in iter_modules(package.__path__):
        yield from rules_in(vars(import_module(f"{package.__name__}.{topic.name}")))


def rules_in(names: Mapping[str, object]) -> Iterator[Rule]:
    """Yield the rules among the names of a module: checks, and the rows of tables."""
    for value in names.values():
        if isinstance(value, Rule):
            yield value
        elif isinstance(value, tuple):
            yield from (row for row in value if isinstance(row, Rule))


ALL_RULES: tuple[Rule, ...] = tuple(
    rule for family in FAMILIES for rule in sorted(_rules_of(family), key=lambda rule: rule.code)
)


def run_rules(graph: CellGraph, rules: tuple[Rule, ...] = ALL_RULES) -> tuple[Diagnostic, ...]:
    """Return what every rule finds, sorted by place.

    A rule is skipped where a code that it assumes absent was reported, so that one cause gives one finding. A rule that
    gives way says nothing of a value that another one reports.
    """
    diagnostics: list[Diagnostic] = []
    general: list[Diagnostic] = []
    reported: set[str] = set()
    for rule in _assumed_first(rules):
        if reported.isdisjoint(rule.assumes):
            found = list(_diagnostics(rule, graph))
            (general if rule.gives_way else diagnostics).extend(found)
            reported.update(diagnostic.code for diagnostic in found)
    if general:
        told = {(other.yaml_path, other.span) for other in diagnostics if other.severity is not Severity.AUDIT}
        diagnostics += (found for found in general if (found.yaml_path, found.span) not in told)
    return tuple(sorted(diagnostics, key=Diagnostic.sort_key))


@lru_cache(maxsize=1)
def _assumed_first(rules: tuple[Rule, ...]) -> tuple[Rule, ...]:
    """Return every rule after those whose codes it assumes absent."""
    by_code = {rule.code: rule for rule in rules}
    order = TopologicalSorter({rule.code: rule.assumes for rule in rules}).static_order()
    return tuple(by_code[code] for code in order if code in by_code)


def _diagnostics(rule: Rule, graph: CellGraph) -> Iterator[Diagnostic]:
    for found in rule.check(graph):
        yield Diagnostic(
            code=rule.code,
            severity=rule.severity,
            message=found.message,
            span=found.span,
            yaml_path=found.path,
            help=found.help or rule.page.fix,
            related=found.related,
        )
