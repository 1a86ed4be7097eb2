"""What a run of rehearsals says: lines for people and JSON for programs, written down by hand."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.command.rehearsals import TimedResult, to_lines, to_summary_json
from cellc.mock.result import RehearsalResult, StageEvidence

_DONE = RehearsalResult(
    name="pick",
    outcome=AttemptOutcome.SUCCEEDED,
    expected=AttemptOutcome.SUCCEEDED,
    sim_time_s=12.0,
    response_s=None,
    within_s=None,
    attempts=(),
    bringup=(),
    findings=(),
)
_STOPPED = replace(
    _DONE,
    name="stop",
    outcome=AttemptOutcome.PROTECTIVE_STOP,
    expected=AttemptOutcome.PROTECTIVE_STOP,
    response_s=0.04,
    within_s=0.1,
    findings=("one", "other"),
    edited=True,
)
_REFUSED = StageEvidence(stage="claim", facts=(), problems=("no claim", "no watch"))


@pytest.mark.parametrize(
    ("result", "wall_time_s", "lines"),
    [
        (
            _DONE,
            0.5,
            ["passed  pick: succeeded (expected succeeded), 12.00 s simulated in 0.50 s (24 x real time)"],
        ),
        (  # a clock that is too coarse to see the run
            _DONE,
            0.0,
            ["passed  pick: succeeded (expected succeeded), 12.00 s simulated in 0.00 s (0 x real time)"],
        ),
        (
            _STOPPED,
            3.0,
            [
                "passed  stop of an edited folder: protective_stop (expected protective_stop), "
                "12.00 s simulated in 3.00 s (4 x real time)",
                "        bound: 40 ms of 100 ms",
                "        finding: one",
                "        finding: other",
            ],
        ),
        (
            replace(_STOPPED, edited=False, response_s=0.2, findings=()),
            3.0,
            [
                "FAILED  stop: protective_stop (expected protective_stop), 12.00 s simulated in 3.00 s (4 x real time)",
                "        bound: 200 ms of 100 ms",
            ],
        ),
        (
            replace(_DONE, within_s=0.1, sim_time_s=0.0, bringup=(_REFUSED,)),
            1.0,
            [
                "FAILED  pick: succeeded (expected succeeded), 0.00 s simulated in 1.00 s (0 x real time)",
                "        reason: bring-up, claim: no claim; no watch",
            ],
        ),
    ],
)
def test_lines_of_a_rehearsal(result: RehearsalResult, wall_time_s: float, lines: list[str]) -> None:
    assert list(to_lines([TimedResult(result, wall_time_s)], [])) == lines


def test_notes_come_first_and_nothing_is_told_to_be_nothing() -> None:
    assert list(to_lines([], ["edited"])) == [
        "note: edited",
        "note: no rehearsal is declared; nothing was run, and nothing is shown",
    ]


def test_summary_as_json() -> None:
    text = to_summary_json("0123", [TimedResult(_DONE, 0.123456), TimedResult(_STOPPED, 2.0)], ["edited"])
    assert text.startswith('{\n  "configuration_id": "0123",\n  "rehearsals": [\n    {\n      "name": "pick",\n')
    told = json.loads(text)
    assert (told["configuration_id"], told["notes"]) == ("0123", ["edited"])
    plain, stopped = told["rehearsals"]
    assert plain == {
        "name": "pick",
        "outcome": "succeeded",
        "expected": "succeeded",
        "passed": True,
        "sim_time_s": 12.0,
        "wall_time_s": 0.1235,
        "response_s": None,
        "within_s": None,
        "reason": "",
        "edited": False,
        "violations": [],
        "findings": [],
        "contacts": [],
    }
    assert (stopped["response_s"], stopped["within_s"], stopped["edited"]) == (0.04, 0.1, True)
