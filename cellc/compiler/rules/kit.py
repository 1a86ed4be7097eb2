"""All that a module of rules imports: the decorator that makes a check a rule, and the words in which it reports.

A module ``cellc/compiler/rules/<family>/<topic>.py`` holds checks that are read together. The name of a check says its
code, the folder its family, and ``docs/rules/<code>.md`` is its page: title, reason, two examples, fix, source.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import wraps

from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.code_page import CodePage, page_of
from cellc.contract.diagnostics import Related, Severity, Span, YamlPath, did_you_mean, meant, write
from cellc.contract.frozen import dataclass

__all__ = [
    "CellGraph",
    "Finding",
    "Findings",
    "Related",
    "Rule",
    "Severity",
    "YamlPath",
    "did_you_mean",
    "enters",
    "found",
    "meant",
    "rule",
    "rules",
    "write",
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
        assumes: codes whose absence this rule builds on; it is skipped where one of them was reported.
        gives_way: what it finds is left out where another rule reports the same value.
    """

    code: str
    family: str
    severity: Severity
    check: Check
    assumes: tuple[str, ...] = ()
    gives_way: bool = False

    @property
    def page(self) -> CodePage:
        """What ``cellc explain`` prints, read now."""
        return page_of(self.code)


def rule(severity: Severity, assumes: tuple[str, ...] = (), *, gives_way: bool = False) -> Callable[[Check], Rule]:
    """Make a check the rule of its name, in the family of its folder."""

    def make(check: Check) -> Rule:
        return Rule(check.__name__.replace("_", "-"), _family(check), severity, check, assumes, gives_way)

    return make


def rules(
    severity: Severity, check: Callable[[CellGraph, str], Findings], words: Mapping[str, str]
) -> tuple[Rule, ...]:
    """Make rules that differ by a word: a row has a code, and what its check is called with."""

    def made(code: str, word: str) -> Rule:
        @wraps(check)
        def row(graph: CellGraph) -> Findings:
            return check(graph, word)

        return Rule(code, _family(check), severity, row)

    return tuple(made(code, word) for code, word in words.items())


def _family(check: Callable[..., Findings]) -> str:
    return FAMILIES[check.__module__.split(".")[-2]]


def enters(graph: CellGraph, text: str, *paths: YamlPath) -> tuple[Related, ...]:
    """Name the places that a figure of a message comes from, as far as the spec states them."""
    return tuple(Related(text, graph.cell.locate(*path)) for path in paths if graph.cell.states(*path))


def found(
    graph: CellGraph, path: YamlPath, message: str, help_text: str = "", related: tuple[Related, ...] = ()
) -> Finding:
    """Report something at a path, or at its nearest ancestor where the path is what is missing.

    What is found at the model of a device that the user brings is corrected in its file, which is named beside it.
    """
    return Finding(message, graph.cell.locate(*path), path, help_text, related or graph.once(_own_files).get(path, ()))


def _own_files(graph: CellGraph) -> Mapping[YamlPath, tuple[Related, ...]]:
    return {
        (*device.path, "model"): (Related("its `device.yaml` is here", places.locate(("model",))),)
        for device in graph.cell.devices
        if (places := device.body.places) is not None
    }
