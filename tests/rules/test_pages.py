"""Every rule is declared once, and its page says all it has to and proves itself."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.rules.kit import FAMILIES, Rule
from cellc.compiler.rules.run import ALL_RULES
from tests.rules.examples import Example, diagnose_example, examples, marks, matches, places

RULES = [pytest.param(rule, id=rule.code) for rule in ALL_RULES]
_PUBLIC = re.compile(r"https://\S+ \((?:[^()]*\d[^()]*|Jazzy)\)(?:: .+)?")
_OWN = re.compile(r"\[principles\.md#([\w-]+)\]\(\.\./principles\.md#\1\)")
FOLDER = Path(__file__).resolve().parents[2] / "cellc" / "compiler" / "rules"


def test_the_complete_cell_is_clean(folder: Path) -> None:
    assert diagnose_example(Example("yaml", "{}"), folder) == ()


def test_every_code_is_declared_once() -> None:
    codes = [rule.code for rule in ALL_RULES]
    assert len(codes) == len(set(codes))


def test_every_check_of_every_family_is_a_rule_that_runs() -> None:
    files = [path for path in FOLDER.glob("*/*.py") if path.stem != "__init__"]
    assert {path.parent.name for path in files} == set(FAMILIES)
    checks = [
        (FAMILIES[path.parent.name], name.replace("_", "-"))
        for path in files
        for name in re.findall(r"^def ([a-z]\w*)\(", path.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    rows = [rule for rule in ALL_RULES if rule.check.__name__.startswith("_")]
    assert sorted(checks) == sorted((rule.family, rule.code) for rule in ALL_RULES if rule not in rows)
    tables = sum(path.read_text(encoding="utf-8").count("= rules(") for path in files)
    assert len(rows) > tables


def test_families_and_their_rules_come_in_one_order_on_every_machine() -> None:
    families = list(FAMILIES.values())
    order = [(families.index(rule.family), rule.code) for rule in ALL_RULES]
    assert order == sorted(order)


def test_assumed_codes_exist_and_assume_nothing_themselves_that_runs_later() -> None:
    assumed = {code for rule in ALL_RULES for code in rule.assumes}
    assert assumed <= {rule.code for rule in ALL_RULES}


def test_page_has_title_reason_examples_fix_and_source() -> None:
    shape = (
        r"# .+\n\n.+\.\n\n(?s:.+)\n\nExample that is reported:\n\n```(yaml|xml)\n(?s:.+?)```"
        r"\n\nExample that is accepted:\n\n```\1\n(?s:.+?)```\n\nFix: (?s:.+?)\n\nSource:(?s:.+?)\n"
    )
    assert [rule.code for rule in ALL_RULES if not re.fullmatch(shape, rule.page.text)] == []


def test_source_is_a_public_page_with_version_or_date_or_a_section_of_the_principles() -> None:
    for rule in ALL_RULES:
        text = rule.page.text.partition("\nSource:")[2]
        sources = [" ".join(source.split()) for source in re.split(r"^- ", text, flags=re.MULTILINE)]
        for source in filter(None, sources):
            assert _PUBLIC.fullmatch(source) or _OWN.fullmatch(source), (rule.code, source)


def test_every_section_of_the_principles_is_the_source_of_a_rule() -> None:
    text = (FOLDER.parents[2] / "docs" / "principles.md").read_text(encoding="utf-8")
    sections = {title.lower().replace(" ", "-") for title in re.findall(r"^## ([\w -]+)$", text, re.MULTILINE)}
    assert sections == {section for rule in ALL_RULES for section in _OWN.findall(rule.page.text)}


@pytest.mark.parametrize("rule", RULES)
def test_reported_example_is_reported_where_it_is_marked_and_nowhere_else(rule: Rule, folder: Path) -> None:
    reported, _ = examples(rule)
    diagnosed = diagnose_example(reported, folder)
    for diagnosis in diagnosed:
        if diagnosis.code == rule.code:
            assert diagnosis.severity is rule.severity
            assert diagnosis.help
            assert "\n" not in diagnosis.message + diagnosis.help
    found = sorted(places(diagnosed, reported, folder), key=lambda place: (place.code, place.line))
    expected = sorted(marks(rule, reported), key=lambda place: (place.code, place.line))
    assert rule.code in {place.code for place in expected}
    assert len(found) == len(expected), found
    assert all(map(matches, found, expected)), found


@pytest.mark.parametrize("rule", RULES)
def test_accepted_example_is_accepted(rule: Rule, folder: Path) -> None:
    _, accepted = examples(rule)
    assert diagnose_example(accepted, folder) == ()
