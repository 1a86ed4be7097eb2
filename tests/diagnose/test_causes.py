"""Answers to symptoms of public threads: how many have the layer and the cause that was found there."""

from __future__ import annotations

import re
from collections.abc import Mapping

import pytest

from cellc.tools.diagnose.diagnose import Answer, diagnose
from cellc.tools.diagnose.symptoms import LAYERS, knowledge
from tests.cells import ROOT
from tests.foreign_yaml import safe_load

CAUSES: Mapping[str, Mapping[str, str]] = safe_load((ROOT / "tests/diagnose/causes.yaml").read_text(encoding="utf-8"))
TITLES = {layer.layer: layer.title for layer in knowledge()}


def is_useful(answer: Answer, case: Mapping[str, str]) -> bool:
    """Tell that the layer is among the suspicions, and the cause among their hypotheses."""
    layers = {TITLES[layer] for layer in LAYERS if layer in case["layers"]}
    causes = [cause.text for suspicion in answer.suspicions for cause in suspicion.causes]
    return any(suspicion.layer in layers for suspicion in answer.suspicions) and any(
        re.search(case["cause"], cause) for cause in causes
    )


def test_nine_of_ten_answers_have_the_cause_and_none_is_certain_of_another_layer() -> None:
    answers = {thread: diagnose(case["says"], None) for thread, case in CAUSES.items()}
    missed = [CAUSES[thread]["says"] for thread, answer in answers.items() if not is_useful(answer, CAUSES[thread])]
    assert len(CAUSES) >= 60
    assert len(missed) <= len(CAUSES) // 10, missed
    certain = [thread for thread, answer in answers.items() if answer.fits and not answer.ask]
    assert certain
    wrong = [
        thread
        for thread in certain
        if answers[thread].suspicions[0].layer
        not in {TITLES[layer] for layer in LAYERS if layer in CAUSES[thread]["layers"]}
    ]
    assert wrong == []


@pytest.mark.parametrize(
    "line",
    [
        "terminate called after throwing an instance of 'std::runtime_error'",
        "[ERROR] [arm-1]: process has died [pid 12, exit code -6, cmd '/opt/ros/jazzy/lib/arm/arm']",
        "Segmentation fault (core dumped)",
        "[task]: goal was rejected by server",
        "connect: Connection refused",
    ],
)
def test_line_that_any_failure_leads_to_makes_nothing_certain(line: str) -> None:
    assert diagnose(line, None).ask


def test_line_that_names_the_cause_counts_more_than_what_it_leads_to() -> None:
    answer = diagnose(
        "[ERROR] [arm-1]: process has died [pid 12, exit code 127]\narm: symbol lookup error: undefined symbol: x", None
    )
    assert not answer.ask
    assert answer.suspicions[0].symptom == "a library of another release is loaded"


def test_warning_beside_an_error_makes_nothing_certain() -> None:
    warning = (
        "[WARN] [a]: New publisher discovered on topic '/t', offering incompatible QoS. No messages will be received."
    )
    assert not diagnose(warning, None).ask
    assert diagnose(f"{warning}\n[ERROR] [b]: octopus", None).ask


CROSSED: Mapping[str, Mapping[str, list[str]]] = safe_load(
    (ROOT / "tests/diagnose/crossed.yaml").read_text(encoding="utf-8")
)


@pytest.mark.parametrize("subject", CROSSED)
def test_what_users_say_of_an_object_leads_to_a_short_list_and_one_question(subject: str) -> None:
    for said, layers in CROSSED[subject].items():
        answer = diagnose(f"{subject} {said}", None)
        assert (answer.fits, bool(answer.ask)) == (True, True), said
        assert answer.suspicions[0].layer in {TITLES[layer] for layer in LAYERS if layer in layers}, said
