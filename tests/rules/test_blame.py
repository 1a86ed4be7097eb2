"""What a finding computes from stated figures, it shows: the line of each that enters is its place or a related one.

A session takes one rule of twenty; with ``--long`` the example of every rule is read.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.rules.kit import Rule
from cellc.compiler.rules.run import ALL_RULES
from tests.rules.blame import Blame, is_named, lines_of
from tests.rules.examples import diagnose_example, examples
from tests.sample import sample

_SHARE = 20
_MOST_FINDINGS = 2
NOT_SHOWN: dict[str, str] = {
    "camera-sees-nothing": "the angle is to the nearest of all things of the cell, and any of them would do",
    "infeasible-approach": "where the search began enters by how near it came, not by whether there is a way",
    "unreachable-goal": "where the search began enters by how near it came, not by whether there is a way",
}
"""Code → why a figure of its message is not led back to every line that enters."""


def _not_shown(rule: Rule, folder: Path) -> list[str]:
    blame = Blame(rule, folder / "cell.yaml")
    lines = lines_of(folder / "cell.yaml")
    return [
        f"{rule.code}: {'.'.join(map(str, figure.path))} enters {finding.message!r}"
        for index, finding in enumerate(blame.findings[:_MOST_FINDINGS])
        for figure in blame.entering(index)
        if not is_named(figure, finding, lines)
    ]


def test_what_enters_a_figure_is_shown(folder: Path, request: pytest.FixtureRequest) -> None:
    silent = []
    shown = [rule for rule in ALL_RULES if rule.code not in NOT_SHOWN]
    for rule in sample(request, shown, _SHARE, lambda rule: rule.code):
        reported, _ = examples(rule)
        if reported.language == "yaml":
            diagnose_example(reported, folder)
            silent += _not_shown(rule, folder)
    assert silent == []


def test_a_line_that_is_not_shown_is_missed(folder: Path) -> None:
    rule = next(rule for rule in ALL_RULES if rule.code == "first-motion-cannot-end")
    diagnose_example(examples(rule)[0], folder)
    blame, lines = Blame(rule, folder / "cell.yaml"), lines_of(folder / "cell.yaml")
    (finding,) = blame.findings
    figures = list(blame.entering(0))
    assert {figure.path[-1] for figure in figures} == {"max_delta", "velocity", "timeout"}
    hidden = type(finding)(finding.message, finding.span, finding.path)
    assert [figure.path[-1] for figure in figures if not is_named(figure, hidden, lines)] == ["max_delta", "velocity"]


def test_every_exception_is_a_rule_with_a_reason() -> None:
    assert set(NOT_SHOWN) <= {rule.code for rule in ALL_RULES}
    assert all(len(reason) > len("it is far") for reason in NOT_SHOWN.values())
