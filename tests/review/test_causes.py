"""A person in a hurry reads the first lines: what causes the changes, how far they reach, and who is asked."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.printing import as_text
from cellc.contract.review import Review, ReviewFinding
from cellc.tools.review.groups import groups_of
from cellc.tools.review.markdown import render_markdown
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import package_of
from tests.cells import spec_of, spec_text
from tests.review.edits import package_before, review_of, review_of_text
from tests.review.revisions import Edit


def _renamed(cell: str, names: Mapping[str, str]) -> Review:
    text = spec_text(cell)
    for old, new in names.items():
        text = re.sub(rf"(?<![\w-]){re.escape(old)}(?![\w-])", new, text)
    return review_of_text(cell, text)


def _lines(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


def _titles(found: Review) -> list[str]:
    return [f"{group.grade} {group.title}" for group in groups_of(found)]


def _unfolded(text: str) -> list[str]:
    """Return the lines of a comment that are seen before anybody unfolds anything."""
    depth, seen = 0, []
    for line in text.splitlines():
        if depth == 0 and line:
            seen.append(line)
        depth += line.count("<details") - line.count("</details>")
    return seen


def test_another_model_of_a_robot_is_one_group_whose_first_line_says_what_it_means() -> None:
    found = review_of("ur5e_pick", ("model: ur5e", "model: ur10e"))
    assert len(found.changes) > 20
    lines = _lines(found)
    at = lines.index(next(line for line in lines if line.startswith("dangerous")))
    assert lines[at].startswith("dangerous  devices.arm.model: ur5e -> ur10e (cell.yaml:")
    # docs.universal-robots.com, technical specifications: UR5e 850 mm and 5 kg, UR10e 1300 mm and 12.5 kg.
    assert lines[at + 1] == "  hand_eye (revision 4), tcp_2f (revision 1) have no new revision"
    assert lines[at + 2].startswith("  reach 850 mm -> 1300 mm (+450 mm); largest payload 5 kg -> 12.5 kg (+7.5 kg);")
    assert sum(line.startswith(("dangerous", "review", "safe")) for line in lines) == 1
    assert len(lines) <= MOST_LINES
    assert len(_unfolded(render_markdown(found))) <= MOST_LINES


@pytest.mark.parametrize(
    ("cell", "noun", "old", "new"),
    [
        ("ur5e_pick", "device", "arm", "robot"),
        ("ur5e_pick", "controller", "arm_trajectory", "motion_ctl"),
        ("ur5e_pick", "calibration", "hand_eye", "wrist_eye"),
        ("ur5e_pick", "TF frame", "fixture_A", "fixture_B"),
        ("ur5e_pick", "host", "control_pc", "ipc"),
        ("ur5e_pick", "goal", "place", "place_part"),  # the new name begins with the old one
        ("dual_ur", "device", "loader", "feeder"),
        ("dual_ur", "namespace", "/loading", "/intake"),
        ("dual_ur", "shared area", "over_nest", "nest_room"),
        ("hybrid_sdk", "device", "arm", "manip"),
    ],
)
def test_another_name_is_one_line_with_what_it_names(cell: str, noun: str, old: str, new: str) -> None:
    found = _renamed(cell, {old: new})
    (title,) = _titles(found)
    assert title.startswith(f"review renamed: {noun} {old} -> {new}")
    assert len(found.changes) == 1
    assert not found.new_findings
    assert not found.gone_findings


def test_what_else_changed_is_told_beside_another_name() -> None:
    text = spec_text("dual_ur").replace("put: {group: load, frame: nest, rpy: 180 0 0 deg, xyz: 0 0 20 mm", "PUT", 1)
    text = re.sub(r"(?<![\w-])loader(?![\w-])", "feeder", text)
    text = text.replace("PUT", "put: {group: load, frame: nest, rpy: 180 0 0 deg, xyz: 0 0 30 mm")
    renamed, moved = _titles(review_of_text("dual_ur", text))
    assert renamed.startswith("review renamed: device loader -> feeder (27 names follow)")
    assert moved.startswith("review motion.goals.put.xyz: 0 0 20 mm -> 0 0 30 mm (cell.yaml:")


def test_names_that_others_hold_are_found_with_them() -> None:
    # Of the pose nothing else is left by which to know it: its one key is the name of the group.
    found = _renamed("ur5e_pick", {"manipulator": "arm6", "home": "start", "hand_eye": "wrist_eye"})
    assert sorted(re.sub(r" \(.*", "", title) for title in _titles(found)) == [
        "review renamed: calibration hand_eye -> wrist_eye",
        "review renamed: named pose home -> start",
        "review renamed: planning group manipulator -> arm6",
    ]


def test_a_new_measurement_is_one_cause_with_what_it_measured() -> None:
    found = review_of(
        "ur5e_pick",
        ("xyz: 0 -70 30 mm, rpy: 0 -75 -90 deg", "xyz: 1 -71 30.5 mm, rpy: 0.2 -75.1 -90 deg"),
        (
            "hand_eye: {revision: 4, measured: 2026-07-01, method: charuco, samples: 40",
            "hand_eye: {revision: 5, measured: 2026-11-20, method: charuco, samples: 45",
        ),
    )
    (group,) = groups_of(found)
    # By hand: sqrt(1 + 1 + 0.25) mm, and of two turns of 0.2 and 0.1 deg about axes at right angles 0.224 deg.
    assert group.title.startswith("devices.camera.mount moved 1.5 mm, turned 0.224 deg: 0 -70 30 mm -> 1 -71 30.5 mm, ")
    assert "(cell.yaml:50, 59), calibration hand_eye revision 4 -> 5, " in group.title
    assert {change.area.value for change in group.changes} == {"frames", "calibration"}


def test_place_and_turn_without_a_measurement_are_one_cause() -> None:
    edit = ("xyz: 0 0 11 mm, rpy: 0 0 90 deg", "xyz: 0 0 12 mm, rpy: 0 0 91 deg")
    (group,) = groups_of(review_of("ur5e_pick", edit))
    assert group.title.startswith("devices.gripper.mount (cell.yaml:42): rpy 0 0 90 deg -> 0 0 91 deg, xyz ")


def test_what_an_adapter_is_given_is_told_once() -> None:
    for old, new, told in (
        ("command_timeout: 20 ms", "command_timeout: 40 ms", "watchdog"),
        ("stop_time: 200 ms", "stop_time: 300 ms", "time to stop"),
        ("path_tolerance: 0.1 rad", "path_tolerance: 0.2 rad", "path tolerance"),
    ):
        assert [change.quantity for change in review_of("hybrid_sdk", (old, new)).changes] == [told]


def test_what_a_sweep_draws_is_asked_of_who_owns_data() -> None:
    found = review_of("fr3_hand", ("box: 4 4 0 mm, yaw: 4 deg", "box: 1 1 0 mm, yaw: 1 deg"))
    assert {(change.area.value, change.owner) for change in found.changes} == {("rehearsals", "data")}


def test_consumers_of_names_that_changed_break() -> None:
    (change,) = _renamed("ur5e_pick", {"arm_trajectory": "motion_ctl"}).changes
    assert change.breaking
    assert "/arm_trajectory/follow_joint_trajectory" in change.why


def test_each_change_stands_under_its_own_line_the_worst_first_and_safety_before_others() -> None:
    found = review_of(
        "ur5e_pick",
        ("xyz: 450 100 850 mm", "xyz: 450 100 860 mm"),
        ("path: hardwired", "path: safety_bus"),
        ("plan_to_execute: 500 ms", "plan_to_execute: 600 ms"),
        ("goal_time: 1 s", "goal_time: 2 s"),
    )
    assert [re.sub(r" \(.*", "", title) for title in _titles(found)] == [
        "dangerous safety.stop.path: hardwired -> safety_bus",
        "dangerous frames.fixture_A.xyz: 450 100 850 mm -> 450 100 860 mm",
        "dangerous control.controllers.arm_trajectory.goal_time: 1 s -> 2 s",
        "review kpis.plan_to_execute: 500 ms -> 600 ms",
    ]
    assert len(_lines(found)) <= MOST_LINES


def test_what_a_comment_excuses_is_not_caused_by_the_line_that_changed_beside_it() -> None:
    rollback = "rollback: {image: UNKNOWN, configuration: UNKNOWN}"
    found = review_of(
        "ur5e_pick",
        (rollback, f"{rollback}  # cellc: ignore missing-rollback no image yet"),
        ("plan_to_execute: 500 ms", "plan_to_execute: 600 ms"),
    )
    assert [re.sub(r" \(.*", "", title) for title in _titles(found)] == [
        "dangerous gates",
        "review kpis.plan_to_execute: 500 ms -> 600 ms",
    ]


def test_many_lines_of_a_spec_still_fit_on_a_screen() -> None:
    text = re.sub(r"(\d+) mm", lambda found: f"{int(found[1]) + 1} mm", spec_text("ur5e_pick"))
    found = review_of_text("ur5e_pick", text.replace("500 ms", "600 ms").replace("goal_time: 1 s", "goal_time: 2 s"))
    assert len(groups_of(found)) > 6
    assert len(_lines(found)) <= MOST_LINES
    assert all(len(line) <= 80 for line in _lines(found)[3:])
    assert len(_unfolded(render_markdown(found))) <= MOST_LINES


def test_an_arm_whose_base_moved_and_a_new_arm_are_asked_of_safety() -> None:
    moved = review_of("ur5e_pick", ("xyz: 0 0 0.8 m", "xyz: 0 0.3 0.8 m"))
    told = {(change.quantity, str(change.grade), change.approval) for change in moved.changes}
    assert ("pose in its parent", "dangerous", "safety") in told
    back = review(package_of("one", check(spec_of("ur5e_pick"))), package_before("dual_ur"))
    new = [change for change in back.changes if change.quantity == "device added"]
    assert {(str(change.grade), change.approval) for change in new} == {("dangerous", "safety")}


@pytest.mark.parametrize(("tolerance", "grade"), [("0.0101 rad", "review"), ("0.02 rad", "dangerous")])
def test_a_tolerance_is_dangerous_where_it_is_another(tolerance: str, grade: str) -> None:
    (change,) = review_of("ur5e_pick", ("goal_tolerance: 0.01 rad", f"goal_tolerance: {tolerance}")).changes
    assert change.grade == grade


def test_a_fresh_calibration_is_not_dangerous() -> None:
    found = review_of(
        "ur5e_pick",
        ("fixture_a: {revision: 2, measured: 2026-07-02", "fixture_a: {revision: 3, measured: 2026-09-02"),
        ("residual: 0.3 mm", "residual: 0.4 mm"),
        ("xyz: 450 100 850 mm", "xyz: 450.2 99.9 850.1 mm"),
    )
    assert {str(change.grade) for change in found.changes} == {"review"}
    assert [re.sub(r" \(.*", "", title) for title in _titles(found)] == [
        "review frames.fixture_A moved 0.245 mm: 450 100 850 mm -> 450.2 99.9 850.1 mm"
    ]
    assert [cause.after for cause in found.causes] == ["frames.fixture_A.xyz, revision, measured, residual"]


@pytest.mark.parametrize(
    ("edit", "again"),
    [
        (("frames: perception, time", "frames: controls, time"), False),
        (("summary: UR5e with", "summary: An UR5e with"), False),
        (("goal_time: 1 s", "goal_time: 2 s"), True),
    ],
)
def test_gates_are_repeated_where_the_configuration_is_another(edit: Edit, again: bool) -> None:
    found = review_of("ur5e_pick", edit)
    assert (found.before.configuration_id != found.after.configuration_id) is again
    assert bool(found.gates) is again


def test_nothing_breaks_that_was_not_there() -> None:
    found = review_of("ur5e_pick", ("frames:\n  tcp:", "frames:\n  spare: {parent: world, xyz: 1 0 0 m}\n  tcp:"))
    assert found.changes
    assert not [change for change in found.changes if change.breaking]


def test_a_pin_is_told_once_with_what_the_matrix_says() -> None:
    found = review_of("ur5e_pick", ("ur_robot_driver 3.8.0", "ur_robot_driver 3.7.0"))
    (change,) = [change for change in found.changes if change.area == "versions"]
    assert (str(change.grade), change.after) == ("review", "ur_robot_driver 3.7.0")
    assert change.why.startswith("the compatibility matrix says UNKNOWN")


def _finding(message: str, severity: str = "warning") -> ReviewFinding:
    return ReviewFinding(code="a-code", severity=severity, message=message, place="cell.yaml:1:1")


def test_a_finding_that_says_another_figure_is_neither_new_nor_gone() -> None:
    was = (_finding("`a` lies 57 deg to the side"), _finding("`tip` must be near, got `far`"), _finding("`b` is slow"))
    now = (_finding("`a` lies 58.5 deg to the side"), _finding("`tip` must be near, got 3 m"), _finding("`c` is slow"))
    before, after = (replace(package_before("minimal"), findings=each) for each in (was, now))
    found = review(before, after)
    assert [[each.message for each in side] for side in (found.new_findings, found.gone_findings)] == [
        ["`c` is slow"],
        ["`b` is slow"],
    ]


def test_new_findings_that_fail_stand_first_and_others_below() -> None:
    severities = ("audit", "warning", "blocker", "error")
    new = tuple(_finding(f"`{severity}` came", severity) for severity in severities)
    found = review(package_before("minimal"), replace(package_before("minimal"), findings=new))
    assert [each.severity for each in found.new_findings] == list(reversed(severities))
    assert _lines(found)[3:5] == ["new findings: 1", "  new error[a-code]: `error` came"]
    assert _lines(found)[5] == "  new blocker[a-code]: `blocker` came"
    seen = _unfolded(render_markdown(found))
    assert seen[3:5] == ["**New findings that fail: 1**", "- error `a-code`: `error` came"]
    assert seen[5:7] == ["**New findings: 3**", "- blocker `a-code`: `blocker` came"]
