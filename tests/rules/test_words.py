"""The words of rules: sentences that say what must be, each help once, and suggestions that hold."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.compiler.rules.kit import Rule
from cellc.compiler.rules.run import ALL_RULES
from tests.rules.examples import Example, diagnose_example
from tests.rules.sources import lines_of, module_of

_REFUSED = re.compile(
    r"\b(?:is|are) (?:due|asked for|allowed)\b|\bnone can\b|(?<![Tt]here )\bis no [a-z]|\bha(?:s|ve) to be\b"
    r"|\bcatalogue|\bcancelled\b"
)
_WORDING = ("message", "advice", "allowed", "reason")
IMAGE = "the digest of the last image that ran"
CONFIGURATION = "the id of the last configuration that ran, such as `cfg-0123456789ab`"

_INTERFACE = """
interfaces:
  "{name}": {{topic: geometry_msgs/msg/PoseStamped, from: perception, to: {{task: {{depth: 1}}}}, frame: world,
             wants: newest, rate: 10 Hz, max_age: 200 ms, on_stale: reject_goal}}
"""


def texts(rule: Rule) -> Iterator[str]:
    """Yield what a rule says to people: its page without examples, and the texts of its messages and helps."""
    page = re.sub(r"```.*?```", "", rule.page.text, flags=re.DOTALL)
    yield re.sub(r"`[^`]*`", "", page)
    for call in calls_of(rule):
        yield from (
            node.value for node in ast.walk(call) if isinstance(node, ast.Constant) and isinstance(node.value, str)
        )


def calls_of(rule: Rule) -> Iterator[ast.AST]:
    """Yield the assignments of texts and the calls that report, in the source of a rule."""
    statements = [statement for statement in module_of(rule).body if statement.lineno in lines_of(rule)]
    for node in (node for statement in statements for node in ast.walk(statement)):
        named = isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) in _WORDING
        if named or (isinstance(node, ast.Call) and ast.unparse(node.func) in ("found", "Finding")):
            yield node


def test_words_are_those_of_the_style_sheet() -> None:
    found = [(rule.code, word[0]) for rule in ALL_RULES for text in texts(rule) for word in _REFUSED.finditer(text)]
    assert found == []


def test_fix_is_one_line_that_begins_with_a_verb() -> None:
    fixes = {rule.code: rule.page.fix for rule in ALL_RULES}
    assert {code: fix for code, fix in fixes.items() if not re.match(r"(?!(?:the|an?|no|it) )[a-z]+ ", fix)} == {}
    assert {code: fix for code, fix in fixes.items() if len(fix) > 140 or "\n" in fix} == {}


def test_help_that_is_always_the_same_is_the_fix_of_the_page() -> None:
    helps = {
        rule.code: {
            ast.unparse(call.args[3]) if len(call.args) > 3 else ""
            for call in calls_of(rule)
            if isinstance(call, ast.Call)
        }
        for rule in ALL_RULES
    }
    assert {code: one for code, one in helps.items() if len(one) == 1 and next(iter(one)).startswith(("'", '"'))} == {}


@pytest.mark.parametrize(
    ("rollback", "message", "help_"),
    [
        ("image: UNKNOWN, configuration: cfg-1", "the rollback `image` is UNKNOWN", f"write {IMAGE}"),
        (
            "image: sha256-1, configuration: UNKNOWN",
            "the rollback `configuration` is UNKNOWN",
            f"write {CONFIGURATION}",
        ),
        (
            "image: UNKNOWN, configuration: UNKNOWN",
            "the rollback `image` and `configuration` are UNKNOWN",
            f"write {IMAGE} and {CONFIGURATION}",
        ),
    ],
)
def test_words_fit_what_is_missing(rollback: str, message: str, help_: str, folder: Path) -> None:
    example = Example("yaml", f"versions: {{rollback: {{{rollback}}}}}")
    (found,) = [diagnostic for diagnostic in diagnose_example(example, folder) if diagnostic.code == "missing-rollback"]
    assert (found.message, found.help) == (message, help_)


@pytest.mark.parametrize(
    ("written", "suggested"),
    [
        ("/camera-markers", "/camera_markers"),
        ("markers", "/markers"),
        ("/2d/markers", "/_2d/markers"),
        ("/markers//left/", "/markers/left"),
        ("/(id)", "/id"),
        ("/-", "/name"),
    ],
)
def test_suggested_name_is_legal(written: str, suggested: str, folder: Path) -> None:
    def found(name: str) -> list[str]:
        example = Example("yaml", _INTERFACE.format(name=name))
        return [
            diagnostic.help for diagnostic in diagnose_example(example, folder) if diagnostic.code == "illegal-ros-name"
        ]

    assert found(written) == [f"write `{suggested}`, as the nodes do"]
    assert found(suggested) == []
