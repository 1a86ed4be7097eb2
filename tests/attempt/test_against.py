"""An attempt against a rehearsal: where they part, and what a bag measures, by messages of known times and values."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.attempt.hand_made import ABORTED, MS, SUCCEEDED, HandMade, attempted, moving
from tests.cells import ROOT, generated
from tests.cli.run import run
from tests.foreign_yaml import safe_load

PACKAGE = ("--package", generated("ur5e_pick").as_posix())


def driven(end_ns: int, status: int = SUCCEEDED, error: float = 0.01) -> HandMade:
    """Return a move that was accepted at 150 ms and ended at another time, with an error of the controller."""
    bag = HandMade()
    for at_ns in moving(bag, 1000 * MS, lambda at_ns: 0.0):
        if at_ns % (10 * MS) == 0:
            bag.follows(at_ns, 0.5, 0.5 - error, 1.0)
    bag.begin_move()
    bag.end_move(end_ns, status)
    return bag


def against(real: HandMade, rehearsed: HandMade, folder: Path) -> dict[str, Any]:
    """Return the comparison of two bags."""
    other = rehearsed.write(folder / "other")
    ran = run(
        "attempt", real.write(folder / "real").as_posix(), *PACKAGE, "--against", other.as_posix(), "--format", "json"
    )
    assert ran.err == ""
    return dict(json.loads(ran.out)["comparison"])


def measured(bag: HandMade, folder: Path) -> dict[tuple[str, str], Any]:
    """Return what a bag measures."""
    found = against(bag, driven(500 * MS), folder)["measures"]
    return {(each["real"]["name"], each["real"]["of"]): each["real"] for each in found}


def test_two_bags_of_the_same_part_nowhere(tmp_path: Path) -> None:
    assert against(driven(500 * MS), driven(500 * MS), tmp_path)["parted"] == []


def test_outcome_time_and_error_are_told_at_their_step(tmp_path: Path) -> None:
    found = against(driven(900 * MS, error=0.03), driven(500 * MS), tmp_path)
    step = "step 1 `goal of arm_trajectory`"
    # Accepted at 150 ms.
    assert found["parted"] == [
        f"{step}: time 0.750 s, rehearsed 0.350 s",
        f"{step}: error 30 mrad or mm, rehearsed 10 mrad or mm",
    ]
    failed = against(driven(500 * MS, ABORTED), driven(520 * MS), tmp_path / "failed")
    assert failed["parted"] == [f"{step}: outcome tolerance_violation at 0.500 s, rehearsed succeeded"]


def test_an_error_of_zero_is_known_and_one_that_was_not_recorded_is_not(tmp_path: Path) -> None:
    bare = driven(500 * MS)
    bare.messages = [each for each in bare.messages if not each[1].endswith("controller_state")]
    (step,) = against(driven(500 * MS, error=0.0), bare, tmp_path)["steps"]
    assert (step["real"]["error"], step["rehearsed"]["error"]) == (0.0, None)
    words = (tmp_path / "real").as_posix(), *PACKAGE, "--against", (tmp_path / "other").as_posix()
    page = run("attempt", *words, "--format", "markdown").out
    assert "| succeeded | succeeded | 0.350 | 0.350 | 0 rad or m | UNKNOWN |" in page


def test_rate_age_and_error_are_those_of_the_messages(tmp_path: Path) -> None:
    bag = driven(500 * MS)
    states = [at for at, each in enumerate(bag.messages) if each[1] == "/joint_states"]
    arrived_ns, *message = bag.messages[states[-1]]
    bag.messages[states[-1]] = (arrived_ns + 30 * MS, *message)  # late
    del bag.messages[states[100]]  # lost
    found = measured(bag, tmp_path)
    rate, age = found["rate", "/joint_states"], found["age at arrival", "/joint_states"]
    assert (rate["median"], rate["worst"], rate["count"]) == pytest.approx((500.0, 250.0, 498))
    assert (age["median"], age["worst"], age["count"]) == pytest.approx((0.0, 0.03, 499))
    assert (rate["stated"], age["stated"]) == ("500 Hz", "100 ms")
    error = found["following error", "arm_trajectory"]
    assert (error["median"], error["worst"], error["count"]) == pytest.approx((0.01, 0.01, 100))


def test_settling_is_from_the_end_of_the_reference_to_standstill(tmp_path: Path) -> None:
    bag = HandMade()
    bag.begin_move()
    for _ in moving(bag, 1000 * MS, lambda at_ns: 0.0):
        pass
    for at_ms in range(0, 1000, 10):
        # The reference rises up to 400 ms, the joints follow 30 ms later.
        bag.follows(at_ms * MS, min(at_ms, 400) * 1e-3, min(max(at_ms - 30, 0), 400) * 1e-3, 1.0)
    bag.end_move(500 * MS, SUCCEEDED)
    settling = measured(bag, tmp_path)["settling time", "arm_trajectory"]
    assert (settling["worst"], settling["count"]) == pytest.approx((0.03, 1))


def test_a_clock_that_is_ahead_is_measured_and_one_that_may_be_is_unknown(tmp_path: Path) -> None:
    bag = driven(500 * MS)
    bag.messages = [
        (at - 20 * MS if topic == "/joint_states" else at, topic, *rest) for at, topic, *rest in bag.messages
    ]
    offset = measured(bag, tmp_path)["clock offset", "/joint_states"]
    assert offset["worst"] == pytest.approx(0.02)
    unknown = measured(driven(500 * MS), tmp_path / "even")["clock offset", "/joint_states"]
    assert unknown["worst"] is None
    assert "chrony or PTP" in unknown["source"]


def test_what_a_bag_lacks_is_unknown_with_what_to_record(tmp_path: Path) -> None:
    bag = driven(500 * MS)
    bag.messages = [each for each in bag.messages if not each[1].endswith("controller_state")]
    error = measured(bag, tmp_path)["following error", "arm_trajectory"]
    assert (error["worst"], error["count"]) == (None, 0)
    assert "controller_state" in error["source"]


@pytest.fixture(name="rehearsed", scope="module")
def rehearsed_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of evidence of two rehearsals."""
    folder = tmp_path_factory.mktemp("rehearsed") / "evidence"
    names = ("--rehearsal", "pick_and_place", "--rehearsal", "no_part")
    ran = run("mock", generated("ur5e_pick").as_posix(), *names, "--evidence", folder.as_posix())
    assert ran.code == 0, ran.err
    return folder


def texts(value: object) -> Iterator[str]:
    """Yield the texts in a part of a spec."""
    if isinstance(value, dict):
        for key, each in value.items():
            if key == "width":
                yield str(each)
            yield from texts(each)


def test_a_rehearsal_by_name_is_run_and_parts_nowhere_from_its_own_bag(rehearsed: Path) -> None:
    bag = rehearsed / "pick_and_place.mcap"
    ran = run("attempt", bag.as_posix(), *PACKAGE, "--against", "pick_and_place", "--format", "json")
    assert (ran.code, ran.err) == (0, "")
    found = json.loads(ran.out)["comparison"]
    assert found["parted"] == []
    assert [each for each in found["measures"] if each["real"] != each["rehearsed"]] == []
    (grip,) = (each["real"] for each in found["measures"] if each["real"]["name"] == "grip width")
    spec = safe_load((ROOT / "cells/ur5e_pick/cell.yaml").read_text(encoding="utf-8"))
    (width,) = texts(spec["frames"])
    assert width == f"{grip['worst'] * 1000:.0f} mm"
    assert grip["count"] == 1


def test_every_form_has_the_comparison(rehearsed: Path) -> None:
    bag = (rehearsed / "no_part.mcap").as_posix()
    for form in ("text", "markdown", "html", "json"):
        ran = run("attempt", bag, *PACKAGE, "--against", "pick_and_place", "--format", form)
        assert ran.code == 1
        assert "rehearsed succeeded" in ran.out
        assert "outcome grip_failure at " in ran.out


def test_what_is_no_rehearsal_and_no_bag_is_refused(tmp_path: Path) -> None:
    bag = driven(500 * MS).write(tmp_path / "real")
    ran = run("attempt", bag.as_posix(), *PACKAGE, "--against", "nothing")
    assert ran.code == 2
    assert (
        "`nothing` must be a bag, a file of records or a rehearsal of the package; it has `pick_and_place`" in ran.err
    )
    assert "comparison" not in json.loads(attempted(bag).out)


def records_of(folder: Path, name: str) -> Path:
    """Return the records that the mock wrote of a rehearsal."""
    return folder / f"{name}.records.jsonl"


def parted(bag: Path, other: Path, *words: str) -> list[str]:
    """Return where a bag and something else part."""
    ran = run("attempt", bag.as_posix(), *PACKAGE, "--against", other.as_posix(), *words, "--format", "json")
    assert ran.err == ""
    return list(json.loads(ran.out)["comparison"]["parted"])


def test_records_say_of_each_step_what_their_bag_says(rehearsed: Path, tmp_path: Path) -> None:
    bag = rehearsed / "no_part.mcap"
    expected = parted(bag, rehearsed / "pick_and_place.mcap")
    assert len(expected) == 5  # grip: outcome and time; three steps that were not made
    assert parted(bag, records_of(rehearsed, "pick_and_place")) == expected
    assert parted(bag, records_of(rehearsed, "no_part")) == []
    # What this command wrote of another bag has them too.
    written = run("attempt", (rehearsed / "pick_and_place.mcap").as_posix(), *PACKAGE, "-o", tmp_path.as_posix())
    assert written.code == 0
    assert parted(bag, tmp_path / "pick_and_place.attempt.json") == expected


def test_of_records_of_several_rehearsals_those_of_the_task_are_taken(rehearsed: Path, tmp_path: Path) -> None:
    both = tmp_path / "all.jsonl"
    texts = (records_of(rehearsed, name).read_text(encoding="utf-8") for name in ("no_part", "pick_and_place"))
    both.write_text("".join(texts), encoding="utf-8")
    assert parted(rehearsed / "no_part.mcap", both) == []
    bag = driven(500 * MS).write(tmp_path / "real")
    ran = run("attempt", bag.as_posix(), *PACKAGE, "--against", both.as_posix())
    assert (ran.code, ran.err) == (2, f"error: {both.as_posix()}: has records of 2 rehearsals; name one with --task\n")


def test_records_have_no_errors_and_what_is_unknown_stays_unknown(rehearsed: Path, tmp_path: Path) -> None:
    first = json.loads(records_of(rehearsed, "pick_and_place").read_text(encoding="utf-8").splitlines()[0])
    end = {**first, "step": "end"}
    lines = ({**first, "outcome": "UNKNOWN", "started_ns": "UNKNOWN", "ended_ns": "UNKNOWN", "trace": []}, end)
    records = tmp_path / "own.jsonl"
    records.write_text("".join(f"{json.dumps(line)}\n" for line in lines), encoding="utf-8")
    bag = driven(500 * MS).write(tmp_path / "real").as_posix()
    page = run("attempt", bag, *PACKAGE, "--against", records.as_posix(), "--format", "markdown").out
    assert "| succeeded | UNKNOWN | 0.350 | UNKNOWN | 10 mrad or mm | UNKNOWN |" in page
    assert re.search(r"\| rate of /joint_states \| median 500 Hz[^|]*\| UNKNOWN \|", page)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda _: "", "has no records"),
        (lambda text: text[: len(text) // 2], "is no file of records: is not JSON: "),
        (lambda text: text.replace('"step"', '"stop"'), "is no file of records: `step`: field required"),
        (
            lambda text: text.replace("cfg-", "cfg-f"),
            "has no records of this package: its configuration_id must be cfg-",
        ),
        (lambda text: text.replace('"succeeded"', '"went well"'), "is no file of records: `outcome"),
    ],
)
def test_a_file_of_records_that_is_none_is_refused(
    change: Callable[[str], str], said: str, rehearsed: Path, tmp_path: Path
) -> None:
    records = tmp_path / "own.jsonl"
    records.write_text(change(records_of(rehearsed, "pick_and_place").read_text(encoding="utf-8")), encoding="utf-8")
    bag = (rehearsed / "no_part.mcap").as_posix()
    ran = run("attempt", bag, *PACKAGE, "--against", records.as_posix())
    assert ran.code == 2
    assert ran.err.startswith(f"error: {records.as_posix()}: {said}")
    assert ran.err.count("\n") == 1


def test_texts_of_records_stay_on_their_line(rehearsed: Path, tmp_path: Path) -> None:
    hostile = "x\x1b[2J\r\n::error::| `a` <script>alert(1)</script>\u202e"
    lines = records_of(rehearsed, "pick_and_place").read_text(encoding="utf-8").splitlines()
    records = tmp_path / "own.jsonl"
    changed = ({**json.loads(line), "step": hostile} for line in lines)
    records.write_text("".join(f"{json.dumps(line)}\n" for line in changed), encoding="utf-8")
    bag = (rehearsed / "no_part.mcap").as_posix()
    for form in ("text", "markdown", "html", "json"):
        ran = run("attempt", bag, *PACKAGE, "--against", records.as_posix(), "--format", form)
        assert ran.code == 1
        assert not set("\x1b\r\u202e") & set(ran.out)
        assert not any(line.startswith("::") for line in ran.out.splitlines())
        assert form != "html" or "<script" not in ran.out
