"""How sure a classification is: sentences of public threads in other words, and what earns certainty."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping

import pytest

from cellc.tools.diagnose.classify import Classified, classify
from cellc.tools.diagnose.symptoms import LAYERS, LayerKnowledge, knowledge, questions, synonyms
from tests.cells import ROOT
from tests.foreign_yaml import safe_load

THREADS: Mapping[str, Mapping[str, object]] = safe_load(
    (ROOT / "tests/diagnose/threads.yaml").read_text(encoding="utf-8")
)
HEARD = [
    (layer, thread, sentence)
    for layer in knowledge()
    for symptom in layer.symptoms
    for thread, sentence in symptom.heard.items()
]


def layers_of(classified: Classified) -> list[str]:
    return [match.layer.layer for match in classified.matches]


def is_certain(classified: Classified) -> bool:
    return classified.fits and classified.question is None


def test_sentences_of_users_are_led_to_the_layer_of_their_cause() -> None:
    found = {thread: classify(str(case["says"]), knowledge()) for thread, case in THREADS.items()}
    layers = {thread: safe_layers(case) for thread, case in THREADS.items()}
    missed = [str(THREADS[thread]["says"]) for thread in found if not layers[thread] & set(layers_of(found[thread]))]
    assert len(THREADS) >= 60
    assert len(missed) <= len(THREADS) // 10, missed
    assert [thread for thread, each in found.items() if is_certain(each)] == []  # words alone make nothing certain


def safe_layers(case: Mapping[str, object]) -> set[str]:
    layers = case["layers"]
    assert isinstance(layers, list)
    assert set(layers) <= set(LAYERS)
    return set(layers)


def test_no_sentence_of_the_other_threads_is_in_the_table() -> None:
    cited = {thread for _, thread, _ in HEARD}
    cited |= {
        thread for layer in knowledge() for each in layer.symptoms for thread in re.findall(r"https:\S+", each.source)
    }
    said = {sentence for _, _, sentence in HEARD}
    assert [thread for thread, case in THREADS.items() if case["says"] in said] == []
    assert len(HEARD) >= 60
    assert not {thread for _, thread, _ in HEARD} & set(THREADS)


def test_every_sentence_is_of_a_thread_of_its_own_and_finds_its_layer() -> None:
    threads = [thread for _, thread, _ in HEARD]
    assert len(set(threads)) == len(threads)
    assert [
        thread
        for thread in threads
        if not re.fullmatch(r"https://github\.com/[\w.-]+/[\w.-]+/(issues|pull)/\d+", thread)
    ] == []
    assert [said for layer, _, said in HEARD if layers_of(classify(said, knowledge()))[0] != layer.layer] == []


_EVERY = os.environ.get("CELLC_TEST_CELLS") == "every"
"""Else one phrase of three: each is compared with all that is known."""


@pytest.mark.parametrize("layer", knowledge(), ids=lambda layer: layer.layer)
def test_every_phrase_finds_its_own_layer_among_the_first_three(layer: LayerKnowledge) -> None:
    phrases = [phrase for symptom in layer.symptoms for phrase in symptom.said]
    lost = [
        phrase
        for phrase in phrases[:: 1 if _EVERY else 3]
        if layer.layer not in layers_of(classify(phrase, knowledge()))
    ]
    assert lost == []


def test_no_phrase_has_a_word_that_is_ignored() -> None:
    ignored = set(synonyms().ignored)
    phrases = [phrase for layer in knowledge() for symptom in layer.symptoms for phrase in symptom.said]
    assert [phrase for phrase in phrases if ignored & set(phrase.split())] == []


def test_nothing_is_said_of_a_text_without_a_known_word() -> None:
    assert classify("the coffee is cold", knowledge()) == Classified((), fits=False)


def test_one_common_word_is_no_likeness() -> None:
    assert not classify("robot", knowledge()).fits
    assert not classify("where do I buy a gripper", knowledge()).fits


def test_two_layers_that_fit_get_one_question_with_what_either_answer_means() -> None:
    classified = classify("protective stop after the gripper picks the part", knowledge())
    assert classified.question is not None
    assert "load set in the device" in classified.question.ask
    assert {match.layer.layer for match in classified.question.yes} == {"tool"}
    assert classified.question.no[0].layer.layer == "safety"


def test_short_text_of_a_source_is_a_proposal_and_a_long_one_is_certain() -> None:
    assert classify("open: Permission denied", knowledge()).question is not None
    assert is_certain(classify("symbol lookup error: x.so: undefined symbol: _ZN3ros", knowledge()))


def test_log_line_is_recognised_as_somebody_types_it() -> None:
    typed = classify("it says pipeline producer overflowed! <rtde data pipeline>", knowledge())
    assert typed.matches[0].symptom.name == "the driver cannot keep up with the data of the robot"


def test_where_three_proposals_would_be_of_one_layer_the_third_is_of_another() -> None:
    classified = classify("octomap is not refreshed after the obstacle is removed", knowledge())
    assert layers_of(classified)[:2] == ["planning", "planning"]
    assert layers_of(classified)[2] != "planning"
    # That one is far behind: the question is whether the first one's layer is right.
    assert classified.question is not None
    assert classified.question.confirms
    assert classified.question.yes == classified.matches[:2]


def test_every_layer_has_its_question_once_and_the_narrowing_one_leaves_each() -> None:
    assert sorted(question.layer for question in questions().deciding) == sorted(LAYERS)
    narrowing = questions().narrowing
    assert sorted((*narrowing.yes, *narrowing.no)) == sorted(LAYERS)


def test_layer_alone_is_not_certain_where_the_match_is_not_specific() -> None:
    classified = classify("it says Segmentation fault", knowledge())
    assert classified.question is not None
    assert (classified.question.yes, classified.question.no) == (classified.matches[:1], classified.matches[1:])


def test_proposal_far_behind_is_left_out_and_one_of_another_layer_is_kept() -> None:
    near = classify("the arm slowly rises in freedrive", knowledge())
    assert layers_of(near)[0] == "tool"
    assert len(set(layers_of(near))) == len(near.matches) == 2
