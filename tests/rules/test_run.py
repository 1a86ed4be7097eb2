"""Rules run in an order that lets one cause give one finding, and turn at their bounds."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.rules.kit import Finding, Rule
from cellc.compiler.rules.run import ALL_RULES, run_rules
from cellc.contract.diagnostics import Severity, Span
from tests.cells import CORPUS, graph_of
from tests.rules.boundaries import BOUNDARIES
from tests.rules.examples import Example, diagnose_example


def rule(code: str, line: int | None, assumes: tuple[str, ...] = ()) -> Rule:
    def check(graph: CellGraph) -> Iterator[Finding]:
        if line is not None:
            yield Finding("found", Span("cell.yaml", line, 1, line, 2), help="do that")

    return Rule(code, "FRM", Severity.ERROR, check, assumes)


def codes(*rules: Rule) -> list[str]:
    graph = graph_of(CORPUS / "valid" / "complete.yaml")
    return [diagnostic.code for diagnostic in run_rules(graph, rules)]


def test_findings_are_sorted_by_place_whatever_the_order_of_rules() -> None:
    first, second = rule("b", 1), rule("a", 2)
    assert codes(second, first) == codes(first, second) == ["b", "a"]


def test_rule_is_skipped_where_what_it_assumes_absent_was_reported() -> None:
    assert codes(rule("effect", 1, ("cause",)), rule("cause", 2)) == ["cause"]


def test_rule_runs_where_what_it_assumes_absent_is_absent() -> None:
    assert codes(rule("effect", 1, ("cause",)), rule("cause", None)) == ["effect"]


def test_rule_that_gives_way_says_nothing_of_a_value_that_another_reports() -> None:
    def check(graph: CellGraph) -> Iterator[Finding]:
        for key in ("a", "b"):
            yield Finding("found", Span("cell.yaml", 1, 1, 1, 2), (key,), "do that")

    def of_one(graph: CellGraph) -> Iterator[Finding]:
        yield next(check(graph))

    general, special = Rule("general", "FRM", Severity.ERROR, check, (), True), Rule("b", "FRM", Severity.ERROR, of_one)
    assert codes(general) == ["general", "general"]
    assert codes(general, special) == codes(special, general) == ["b", "general"]


def test_assumptions_are_followed_through_chains() -> None:
    # `middle` is skipped, so `last` has nothing to hide it.
    chain = (rule("last", 3, ("middle",)), rule("middle", 2, ("cause",)), rule("cause", 1))
    assert codes(*chain) == ["cause", "last"]


def test_reversed_rules_say_the_same_of_a_broken_cell() -> None:
    graph = graph_of(CORPUS / "invalid" / "scripted-servo-loop-hundred.yaml")
    assert run_rules(graph, ALL_RULES) == run_rules(graph, tuple(reversed(ALL_RULES)))
    assert run_rules(graph)


@pytest.mark.parametrize(
    ("code", "fragment", "reported"),
    BOUNDARIES,
    ids=[f"{code}-{number}" for number, (code, *_) in enumerate(BOUNDARIES)],
)
def test_rule_turns_at_its_bound(code: str, fragment: Example, reported: bool, folder: Path) -> None:
    found = {diagnostic.code for diagnostic in diagnose_example(fragment, folder)}
    assert (code in found) is reported, found


TAGS = """
<link name="tool"/>
<ros2_control name="stage" type="system">
  <hardware><plugin>stage_driver/Hardware</plugin></hardware>
  <joint name="turn">
    <command_interface name="positon"/><state_interface name="position"/><state_interface name="position"/>
  </joint>
  <joint name="slide">
    <command_interface name="position"><param name="min">2</param><param name="max">1</param></command_interface>
    <state_interface name="velocity"><param name="initial_value">fast</param></state_interface>
  </joint>
</ros2_control>
<ros2_control name="second" type="system">
  <hardware><plugin>second_driver/Hardware</plugin></hardware>
  <joint name="turn"><command_interface name="effort"/></joint>
  <joint name="slide"/>
</ros2_control>
"""


def test_each_fault_of_a_tag_is_named(folder: Path) -> None:
    found = diagnose_example(Example("xml", TAGS), folder)
    assert sorted(finding.message for finding in found if finding.code == "unusable-ros2-control") == [
        "`position` of `slide` must have `min` at most `max`, got 2 and 1",
        "`slide` of `second` has no interface",
        "`turn` has the command interface `positon`, which is not `position`",
        "`turn` has the state interface `position` twice",
        "`turn` is commanded by `stage` and `second`",
        "`velocity` of `slide` must have a number in `initial_value`, got `fast`",
    ]
