"""Every symptom is found by what users and programs say of it, and its neighbours are not taken for it.

A session takes one symptom of four; with ``--long`` every one is taken.
"""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from pydantic import TypeAdapter, ValidationError

from cellc.compiler.cell.cell import Cell
from cellc.compiler.pipeline import check
from cellc.tools.diagnose.classify import classify
from cellc.tools.diagnose.diagnose import diagnose
from cellc.tools.diagnose.log_lines import length
from cellc.tools.diagnose.symptoms import Phrase, Symptom, Template, knowledge
from tests.cells import ROOT
from tests.foreign_yaml import safe_load
from tests.sample import sample

_SHARE = 4
FILE = ROOT / "tests/diagnose/symptoms.yaml"
CASES: Mapping[str, Mapping[str, str]] = safe_load(FILE.read_text(encoding="utf-8"))
SYMPTOMS = {symptom.name: symptom for layer in knowledge() for symptom in layer.symptoms}


def best(text: str) -> str:
    found = classify(text, knowledge())
    return found.matches[0].symptom.name if found.fits else ""


@pytest.fixture(scope="module")
def hand() -> Cell:
    graph = check(ROOT / "cells/fr3_hand/cell.yaml").graph
    assert graph is not None
    return graph.cell


def test_symptom_comes_first_for_its_own_words_their_synonyms_and_its_log_line(request: pytest.FixtureRequest) -> None:
    expected = {text: name for name in sample(request, SYMPTOMS, _SHARE) for text in CASES[name].values()}
    assert {text: best(text) for text in expected} == expected


@pytest.mark.parametrize("name", SYMPTOMS)
def test_every_symptom_that_a_program_logs_has_a_line_of_it(name: str) -> None:
    assert ("logs" in CASES[name]) == bool(SYMPTOMS[name].logged)


def test_there_is_no_case_of_a_symptom_that_is_not_known() -> None:
    assert set(CASES) == set(SYMPTOMS)
    assert len(SYMPTOMS) >= 60


def test_text_of_a_source_is_recognised_as_nothing_else(request: pytest.FixtureRequest) -> None:
    expected = {
        f"[a-1] [ERROR] [1700000000.5] [b]: {template.replace('{', 'some_').replace('}', '')} (at c.cpp:1)": name
        for name in sample(request, SYMPTOMS, _SHARE)
        for template in SYMPTOMS[name].logged
    }
    assert {line: best(line) for line in expected} == expected


def test_no_text_of_a_source_is_so_short_that_it_stands_in_other_words() -> None:
    texts = [template for symptom in SYMPTOMS.values() for template in symptom.logged]
    assert [text for text in texts if length(text) < 12] == []


def test_name_of_a_symptom_finds_it_however_it_is_spelt() -> None:
    assert [name for name in SYMPTOMS if best(f" {name.upper()} ") != name] == []


def test_lines_of_a_launch_with_colours_and_breaks_are_read_as_one() -> None:
    pasted = (
        "\x1b[33m[ros2_control_node-1] [WARN] [1700000000.123] [resource_manager]: Unable to activate controller\n"
        "    'arm' since the command interface\r\n'joint1/position' is currently claimed by another.\x1b[0m\n"
        "[spawner-2] [INFO] [1700000000.456] [spawner_arm]: bye"
    )
    (match, *_) = classify(pasted, knowledge()).matches
    assert match.symptom.name == "a command interface has another owner"
    assert match.named == (("controller", "arm"), ("interface", "joint1/position"))


def test_reason_at_the_end_of_a_line_ends_before_the_next_line() -> None:
    pasted = "[a]: Error importing joint limiters: no tag found\n[spawner-2] [INFO] [1.2] [spawner]: waiting"
    assert classify(pasted, knowledge()).matches[0].named == (("reason", "no tag found"),)


def test_name_that_is_too_long_for_a_name_is_none() -> None:
    texts = [f"Could not initialize the controller named '{'a' * number}'" for number in (200, 201)]
    assert [bool(classify(text, knowledge()).matches[0].template) for text in texts] == [True, False]


def test_symptom_of_a_driver_that_the_cell_does_not_have_is_not_guessed(hand: Cell) -> None:
    words = "the kinova session times out"
    assert "the session with the arm times out" in [diagnosis.symptom for diagnosis in diagnose(words, None).suspicions]
    assert "the session with the arm times out" not in [
        diagnosis.symptom for diagnosis in diagnose(words, hand).suspicions
    ]
    assert (
        diagnose(CASES["the session with the arm times out"]["logs"], hand)
        .suspicions[0]
        .symptom.startswith("the session")
    )


def test_causes_with_something_to_look_at_in_the_cell_come_first(hand: Cell) -> None:
    name = "the robot reaches beside the object"
    written = [hypothesis.cause for hypothesis in SYMPTOMS[name].hypotheses]
    of_camera = [
        hypothesis.cause
        for hypothesis in SYMPTOMS[name].hypotheses
        if {each.of for each in hypothesis.observations} == {"camera"}
    ]
    shown = [cause.text for cause in diagnose(name, hand).suspicions[0].causes]
    assert of_camera
    assert shown == [cause for cause in written if cause not in of_camera] + of_camera


@pytest.mark.parametrize(
    ("kind", "longest"), [(Phrase, 100), (Template, 300)], ids=["a phrase", "a text of a log line"]
)
def test_a_text_of_a_symptom_is_no_longer_than(kind: type[str], longest: int) -> None:
    adapter = TypeAdapter(kind, config=Symptom.model_config)
    assert adapter.validate_python("a" * longest) == "a" * longest
    with pytest.raises(ValidationError, match=f"at most {longest} characters"):
        adapter.validate_python("a" * (longest + 1))
