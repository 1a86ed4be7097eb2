"""Cells beside each other: chapter 4, sections 8 and 9."""

from __future__ import annotations

import re
from pathlib import Path

from cellc.tools.report.comparison import Comparison, Row, compare
from cellc.tools.report.comparison_text import comparison_markdown
from tests.cells import ROOT, linked, spec_of, spec_text
from tests.cli.run import run

# Chapter 4, the rows of the tables of sections 8 and 9.
_CONTRACT = ("start command", "timing", "safety", "versions", "what the mock cannot prove")
_DUTIES = ("discovery and types", "frames", "time and records", "command ownership", "servo deadline", "safety")


def _compared() -> Comparison:
    return compare({name: linked(spec_of(name)) for name in ("ur5e_pick", "fr3_hand")})


def _row(compared: Comparison, question: str) -> Row:
    return next(row for row in (*compared.motion, *compared.duties) if row.question == question)


def test_the_questions_are_those_of_the_chapter() -> None:
    compared = _compared()
    assert tuple(row.question for row in compared.motion) == _CONTRACT
    assert tuple(row.question for row in compared.duties) == _DUTIES
    assert all(answer for row in (*compared.motion, *compared.duties) for answer in row.answers)


def test_who_is_responsible_is_said_at_frames_and_records() -> None:
    compared = _compared()
    responsible = linked(spec_of("ur5e_pick")).owners.responsibilities
    assert f"owner {responsible.frames}" in _row(compared, "frames").answers[0]
    assert f"owner {responsible.logging}" in _row(compared, "time and records").answers[0]


def test_only_the_arm_whose_program_starts_with_old_set_points_jumps() -> None:
    ur, franka = _row(_compared(), "start command").answers
    # Universal_Robots_ROS2_Driver, issues 1084, 279, 515.
    assert any(text.startswith("arm: program_start: jumps") for text in ur)
    assert not any("jumps" in text for text in franka)


def test_rates_and_silences_are_those_of_the_vendors() -> None:
    ur, franka = _row(_compared(), "timing").answers
    assert any("500 Hz" in text for text in ur)
    assert any("slowed down by arm_speed_scaling/speed_scaling_factor" in text for text in ur)
    assert any("1000 Hz" in text for text in franka)
    assert "arm: trajectories run as planned or are aborted" in franka


def test_what_a_node_moves_past_the_controllers_is_claimed_by_none() -> None:
    _, franka = _row(_compared(), "command ownership").answers
    assert "arm_trajectory: claims 7 command interfaces, commanded by move_group" in franka
    assert any(text.startswith("hand: no controller claims it") for text in franka)


def test_a_direct_library_takes_duties_back(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("architecture: hybrid", "architecture: direct_sdk")
    file = tmp_path / "cell.yaml"
    file.write_text(text, encoding="utf-8")
    compared = compare({"ros2": linked(spec_of("ur5e_pick")), "sdk": linked(file)})
    before, after = _row(compared, "discovery and types").answers
    assert set(after) - set(before) == {
        "arm: the application knows the address 192.168.56.101; no graph shows it",
    }
    assert "the application's own process must provide deadline" in str(_row(compared, "servo deadline").answers[1])
    assert _row(compared, "safety").same


def test_two_cells_stand_beside_each_other_with_what_both_answer_said_once() -> None:
    out = run("compare", spec_of("ur5e_pick").as_posix(), spec_of("rail_arm").as_posix()).out
    timing = out.partition("\ntiming\n")[2].partition("  common evidence")[0].splitlines()
    assert timing[0] == "  both"
    assert out.count("arm: stops its motion after 0.04 s without commands") == 1
    head = next(number for number, line in enumerate(timing) if line.startswith("  ur5e_pick "))
    assert timing[head].split() == ["ur5e_pick", "|", "rail_arm"]
    assert timing[head + 1].partition("|")[0].strip().startswith("gripper: any link")
    assert timing[head + 1].partition("|")[2].strip() == "nothing else"
    assert max(map(len, out.splitlines())) <= 100


def test_three_cells_stand_below_each_other() -> None:
    out = run("compare", *(spec_of(name).as_posix() for name in ("ur5e_pick", "rail_arm", "minimal"))).out
    assert " | " not in out
    assert "\n  all\n" in out


def test_what_all_answer_alike_stands_once() -> None:
    out = run("compare", spec_of("minimal").as_posix(), spec_of("minimal").as_posix()).out
    assert out.count("the same in all") == len(_CONTRACT) + len(_DUTIES)
    assert out.count("common evidence: measured rate, jitter and missed cycles") == 1


def test_each_row_of_the_tables_has_a_column_for_each_cell() -> None:
    rows = re.findall(r"^\|.*\|$", comparison_markdown(_compared()), re.MULTILINE)
    assert len(rows) == len(_CONTRACT) + len(_DUTIES) + 4
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {5}


def test_two_states_of_one_cell_are_told_apart_by_their_files(tmp_path: Path) -> None:
    (tmp_path / "after.yaml").write_text(spec_text("minimal").replace("500 Hz", "250 Hz"), encoding="utf-8")
    before, after = spec_of("minimal").relative_to(ROOT).as_posix(), (tmp_path / "after.yaml").as_posix()
    out = run("compare", before, after, "--format", "markdown").out
    assert f"| question | {before} |" in out.replace("\\", "")


def test_one_cell_is_compared_with_nothing() -> None:
    ran = run("compare", spec_of("minimal").as_posix())
    assert ran.code == 2
    assert "expected two cells or more, got one" in ran.err


def test_cell_that_does_not_link_is_a_finding(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(spec_text("minimal").replace("model: ", "model: no_"), encoding="utf-8")
    ran = run("compare", spec_of("minimal").as_posix(), file.as_posix())
    assert ran.code == 1
    assert "unknown-model" in ran.out
