"""What integrators change in one pull request, with the grade that they expect by the definitions of docs/review.md."""

from __future__ import annotations

import re

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.printing import as_text
from cellc.contract.review import Review
from cellc.contract.vocabulary import Grade
from cellc.tools.review.groups import groups_of
from cellc.tools.review.leaves import Leaves
from cellc.tools.review.markdown import render_markdown
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import package_of
from cellc.tools.review.steps import with_step_names
from cellc.tools.review.text import render_review
from tests.cells import spec_of
from tests.review.edits import package_before, review_of
from tests.review.revisions import Edit, edited

_TO_CONTROL: tuple[Edit, ...] = (
    ("move_group, host: planner_pc", "move_group, host: control_pc"),
    ("tray_to_press, host: planner_pc", "tray_to_press, host: control_pc"),
)


def _both_ways(cell: str, *edits: Edit) -> tuple[Review, Review]:
    """Return the review of edits, and that of taking them back."""
    file = spec_of(cell).as_posix()
    other = package_of("edited", check(file, {file: edited(*edits, cell=cell)}))
    return review(package_before(cell), other), review(other, package_before(cell))


@pytest.mark.parametrize("moved", [_TO_CONTROL[:1], _TO_CONTROL])
def test_nodes_on_another_computer_are_compared_there(moved: tuple[Edit, ...]) -> None:
    there, back = _both_ways("fr3_hand", *moved)
    assert (there.worst(), back.worst()) == (Grade.REVIEW, Grade.REVIEW)
    assert not [change for change in (*there.changes, *back.changes) if "unnoticed" in change.why]


def test_a_version_that_no_computer_compares_any_more_is_dangerous() -> None:
    pinned, unknown = "moveit: 2.5.9", "moveit: UNKNOWN"
    found = review_of("fr3_hand", (pinned, unknown))
    assert [change.grade for change in found.changes if change.quantity == "versions that it compares"] == [
        Grade.DANGEROUS
    ]


def test_steps_with_no_proof_and_no_effect_are_equal_in_both() -> None:
    def comparing(name: str, *parts: str) -> Leaves:
        step = ("step", "real", name)
        return {(*step, "proof"): (), (*step, "effect"): (), (*step, "request", "parts"): parts}

    after = comparing("compare_versions", "os", "moveit")
    assert with_step_names(comparing("compare_versions_on_control_pc", "os"), after).keys() == after.keys()


def _screen(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


def _text(found: Review) -> str:
    return " ".join(line.strip() for line in _screen(found))


_FASTER: Edit = ("limits: {velocity: 50 %, acceleration: 50 %}", "limits: {velocity: 60 %, acceleration: 70 %}")
_TABLE: Edit = ("table: {parent: world, xyz: 350 0 780 mm", "table: {parent: world, xyz: 400 0 780 mm")
_TCP: Edit = ("tcp: {parent: gripper/base, xyz: 0 0 162 mm", "tcp: {parent: gripper/base, xyz: 0 0 168 mm")
_LOAD: Edit = ("payload: {mass: 1.0 kg, center", "payload: {mass: 1.9 kg, center")
_PATH: Edit = ("path: hardwired", "path: safety_bus")
_GOAL: Edit = ("goal_tolerance: 0.01 rad", "goal_tolerance: 0.03 rad")
_BOUND: Edit = (
    "when: moving}}, expect: claim_failure,\n     within: 300 ms",
    "when: moving}}, expect: claim_failure,\n     within: 600 ms",
)
_MANY: tuple[Edit, ...] = (
    *(_FASTER, _TABLE, _TCP, _LOAD, _PATH, _GOAL, _BOUND),
    ("discovery: localhost", "discovery: multicast"),
    ("  /object_pose:", "  /part_pose:"),
    ("limits: controls, watchdogs", "limits: integration, watchdogs"),
    ("exposure: 8 ms", "exposure: 6 ms"),
    ("buffer: 10 s", "buffer: 8 s"),
    ("samples: 40, residual: 0.8 mm", "samples: 44, residual: 0.8 mm"),
    ("plan_to_execute: 500 ms", "plan_to_execute: 400 ms"),
)


def test_of_many_causes_each_danger_keeps_its_reason_and_who_is_broken_is_named() -> None:
    found = review_of("ur5e_pick", *_MANY)
    screen, text = _screen(found), _text(found)
    assert len(screen) <= MOST_LINES
    dangers = [group for group in groups_of(found) if group.grade is Grade.DANGEROUS]
    assert len(dangers) == 7
    for group in dangers:
        assert any((change.why or "").replace("`", "") in text for change in group.changes if change.why), group.title
    assert text.count("dangerous  ") == len(dangers)
    assert "may break consumers of /object_pose" in text
    assert "network.discovery" in text
    assert not [line for line in screen if line.endswith("...") or "words more" in line]


def test_what_two_ends_offer_and_request_is_whole() -> None:
    found = review_of_any(
        "ur5e_pick",
        ("from: {perception: {reliability: reliable", "from: {perception: {reliability: best_effort"),
        *_MANY[:4],
    )
    assert "offered best_effort, requested reliable" in _text(found)
    assert "words more" not in _text(found)


def test_a_finding_of_several_places_is_printed_once() -> None:
    found = review_of("fr3_hand", ("states: [protective_stop, user_stop,", "states: [protective_stop,"))
    (blocker,) = found.new_findings
    again = blocker.model_copy(update={"place": "cell.yaml:1:1"})
    twice = found.model_copy(update={"new_findings": (blocker, again)})
    assert _text(twice).count("new blocker[") == 1


@pytest.mark.parametrize(
    ("cell", "edit", "told"),
    [
        (
            "fr3_hand",
            (
                "  canceled: {use",
                "  stuck: {use: tray_to_press, inject: {stick: arm/fr3_joint4, at: 2 s}, "
                "expect: tolerance_violation}\n  canceled: {use",
            ),
            "use tray_to_press, inject {stick: arm/fr3_joint4, at: 2 s}, expect tolerance_violation",
        ),
        (
            "ur5e_pick",
            (
                "calibrations:\n",
                "calibrations:\n  spare: {revision: 1, measured: 2026-07-21, method: charuco, "
                "samples: 30, residual: 1.1 mm, owner: perception}\n",
            ),
            "revision 1, measured 2026-07-21, residual 1.1 mm, method charuco, samples 30, owner perception",
        ),
        (
            "ur5e_pick",
            (
                "  object:\n    parent: camera",
                "  shelf: {parent: world, xyz: 100 0 900 mm, rpy: 0 0 30 deg}\n  object:\n    parent: camera",
            ),
            "parent world, xyz 100 0 900 mm, rpy 0 0 30 deg",
        ),
        (
            "ur5e_pick",
            (
                "  /move_action:",
                "  /part_image:\n    topic: sensor_msgs/msg/Image\n    from: perception\n    to: {task: {depth: 1}}\n"
                "    wants: newest\n    rate: 5 Hz\n    max_age: 400 ms\n    on_stale: reject_goal\n  /move_action:",
            ),
            "topic sensor_msgs/msg/Image, from perception, to {task: {depth: 1}}, rate 5 Hz, max_age 400 ms",
        ),
    ],
)
def test_what_is_new_is_listed_with_its_figures(cell: str, edit: Edit, told: str) -> None:
    (title,) = [group.title for group in groups_of(review_of(cell, edit))]
    assert " added (cell.yaml:" in title
    assert told in title


def test_an_obstacle_with_another_parent_that_stays_where_it_was_is_reviewed() -> None:
    # By hand: the nest is 700 mm above the world, and the table 320 mm below the nest.
    found = review_of("dual_ur", ("table: {parent: nest, xyz: 0 0 -320 mm", "table: {parent: world, xyz: 0 0 380 mm"))
    assert found.worst() is Grade.REVIEW
    (placed,) = [change for change in found.changes if change.quantity == "pose in its parent"]
    assert placed.delta == "stays on world"
    moved = review_of("dual_ur", ("table: {parent: nest, xyz: 0 0 -320 mm", "table: {parent: world, xyz: 0 0 350 mm"))
    assert moved.worst() is Grade.DANGEROUS


def test_a_moved_obstacle_says_what_is_free_now_and_how_far_it_is_from_what_it_touched() -> None:
    # By hand: the table ends at 660 mm, the pedestal at 700 mm: put on it, a box of 100 mm stands from 700 mm.
    box = "  box: {parent: world, xyz: 0 0 750 mm, box: 100 100 100 mm}\n  table:"
    higher = box.replace("750 mm", "780 mm").replace("xyz: 0 0", "xyz: 250 0")
    file = spec_of("fr3_hand").as_posix()
    before, after = (
        package_of(name, check(file, {file: edited(("  table:", text), cell="fr3_hand")}))
        for name, text in (("before", box), ("after", higher))
    )
    (change,) = [change for change in review(before, after).changes if change.quantity == "pose in its parent"]
    assert change.grade is Grade.DANGEROUS
    # The root of 250 and 30 squared; 150 mm are between two boxes of 100 mm at 250 mm; 50 mm aside and 30 mm above.
    assert change.delta == "moves 252 mm; 150 mm clear of where it was; 58.3 mm clear of `pedestal`, which it touched"


@pytest.mark.parametrize(
    ("cell", "edit", "asked"),
    [
        ("hybrid_sdk", ("command_timeout: 20 ms", "command_timeout: 60 ms"), "safety (safety), controller (controls)"),
        ("hybrid_sdk", ("stop_time: 200 ms", "stop_time: 400 ms"), "safety (safety), controller (controls)"),
        (
            "hybrid_sdk",
            ("emergency_stop, within: 250 ms", "emergency_stop, within: 500 ms"),
            "safety (safety), data (data)",
        ),
        ("hybrid_sdk", ("goal_time: 1 s", "goal_time: 2 s"), "controller (controls)"),
    ],
)
def test_safety_is_asked_of_what_says_how_soon_motion_stops(cell: str, edit: Edit, asked: str) -> None:
    found = review_of(cell, edit)
    assert {group.asks for group in groups_of(found)} == {asked}


def test_a_new_owner_that_approves_nothing_is_named() -> None:
    new: Edit = (
        "  task: {run",
        "  logger: {run: cell_tasks/logger, host: control_pc, owner: telemetry_team}\n  task: {run",
    )
    assert "telemetry_team approves nothing in this cell" in _text(review_of_any("ur5e_pick", new))
    known = (new[0], new[1].replace("telemetry_team", "data"))
    assert "approves nothing" not in _text(review_of_any("ur5e_pick", known))


def review_of_any(cell: str, *edits: Edit) -> Review:
    """Return the review of a cell that may have errors."""
    file = spec_of(cell).as_posix()
    return review(package_before(cell), package_of("after", check(file, {file: edited(*edits, cell=cell)})))


def test_whoever_a_cause_asks_is_asked_in_the_head_and_in_the_whole_text() -> None:
    found = review_of("ur5e_pick", *_MANY)
    asked = {part.split(" (")[0] for group in groups_of(found) for part in group.asks.split(", ") if part}
    head = _text(found).partition("asks ")[2].partition(" may break")[0]
    assert asked == {part.split(" (")[0] for part in head.strip().split(", ")}
    whole = as_text(render_review(found), color=False)
    # By hand: what only follows, such as an inertia or a tip, has no line of an approval.
    assert {
        line.strip().partition("approval ")[2].partition(":")[0] for line in whole.splitlines() if "approval " in line
    } <= asked


def test_one_bound_in_several_places_and_the_limits_of_an_act_are_one_heading() -> None:
    bound = review_of(
        "ur5e_pick",
        ("cancel_within: 200 ms", "cancel_within: 300 ms"),
        ("expect: canceled, within: 200 ms", "expect: canceled, within: 300 ms"),
        ("cancel: 200 ms", "cancel: 300 ms"),
    )
    (group,) = groups_of(bound)
    told = "interfaces./move_action.cancel_within, rehearsals.canceled.within, kpis.cancel: 200 ms -> 300 ms (+50 %) ("
    assert group.title.startswith(told)
    (limits,) = groups_of(review_of("ur5e_pick", _FASTER))
    assert limits.title.startswith("devices.arm.limits (cell.yaml:")
    assert "velocity 50 % -> 60 % (+20 %), acceleration 50 % -> 70 % (+40 %)" in limits.title


def test_the_same_in_two_named_poses_is_one_heading_and_the_tip_is_told_once() -> None:
    found = review_of(
        "dual_ur",
        ("apart: {load: -90 -90 90", "apart: {load: -80 -90 90"),
        ("loader_away: {load: -90 -90", "loader_away: {load: -80 -90"),
    )
    (group,) = groups_of(found)
    assert group.title.startswith("motion.poses.{apart,loader_away}.load: -90 -90 90 -90 -90 0 deg -> -80 -90 90")
    assert [line for line in _screen(found) if "tip" in line] == [
        "  tip in apart, loader_away moves 124 mm, turns 10 deg"
    ]


@pytest.mark.parametrize(
    ("cell", "edit"),
    [
        ("ur5e_pick", ("configuration: UNKNOWN}", "configuration: cfg-fc1f400b5f3d}")),
        ("ur5e_pick", ("serial: UNKNOWN", "serial: U20215500")),
        ("ur5e_pick", ("firmware: UNKNOWN\n    driver: robotiq", "firmware: 1.2.3\n    driver: robotiq")),
    ],
)
def test_what_only_becomes_known_is_safe_and_the_way_back_is_not(cell: str, edit: Edit) -> None:
    there, back = _both_ways(cell, edit)
    assert (there.worst(), back.worst()) == (Grade.SAFE, Grade.DANGEROUS)


def test_a_new_name_of_a_frame_says_that_consumers_look_it_up() -> None:
    found = review_of(
        "ur5e_pick",
        ("fixture_A: {parent: world", "nest_A: {parent: world"),
        ("{parent: fixture_A, xyz", "{parent: nest_A, xyz"),
        ("place: {frame: fixture_A", "place: {frame: nest_A"),
    )
    (group,) = groups_of(found)
    assert group.title.startswith("renamed: TF frame fixture_A -> nest_A (")
    assert "consumers that look up fixture_A" in _text(found)


def test_figures_that_are_round_in_radians_are_told_in_radians() -> None:
    # The vendor's MoveIt configuration has 5 rad/s^2 for each joint, and 180 deg/s.
    changes = {change.quantity: change for change in review_of("ur5e_pick", _FASTER).changes}
    assert (changes["acceleration"].before, changes["acceleration"].after) == ("2.5 rad/s^2", "3.5 rad/s^2")
    assert (changes["velocity"].before, changes["velocity"].after) == ("90 deg/s", "108 deg/s")


def test_nobody_is_asked_who_is_not_known() -> None:
    (group,) = groups_of(review_of("ur5e_pick", ("network: network,", "network: UNKNOWN,")))
    assert group.asks == "network (network), graph (integration)"


def test_a_comment_shows_each_danger_with_its_reason_and_who_is_broken_unfolded() -> None:
    found = review_of("ur5e_pick", *_MANY)
    unfolded = re.sub(r"<details>.*?</details>", "", render_markdown(found).replace("`", ""), flags=re.DOTALL)
    dangers = [group for group in groups_of(found) if group.grade is Grade.DANGEROUS]
    assert len(dangers) > 6
    assert len([line for line in unfolded.splitlines() if line]) <= MOST_LINES
    for group in dangers:
        assert group.name in unfolded
        assert all(why in unfolded for why in group.whys), group.title
    assert "may break consumers of /object_pose" in unfolded
    (summary,) = re.findall(r"<summary>(\d+ causes more with .*)</summary>", render_markdown(found))
    assert ": `network.discovery`, " in summary


def test_a_danger_that_is_in_its_heading_alone_has_its_reason() -> None:
    found = review_of("ur5e_pick", ("samples: 8, residual: 0.4 mm", "samples: 8, residual: 0.9 mm"))
    assert found.worst() is Grade.DANGEROUS
    assert "  because the same measurement is said to be less exact" in _screen(found)


def test_versions_that_do_not_work_together_are_not_said_to_be_unknown() -> None:
    whys = {change.why for change in review_of_any("ur5e_pick", ("ros: jazzy", "ros: kilted")).changes if change.why}
    assert "the matrix says that these versions do not work together" in whys
    assert not [why for why in whys if "nothing says any more" in why]


def test_another_prefix_of_every_link_fits_on_a_screen_with_its_reasons() -> None:
    found = review_of_any("gen3_2f", ('prefix: ""', "prefix: arm"))
    screen, text = _screen(found), _text(found)
    assert len(screen) <= MOST_LINES
    assert 'devices.arm.prefix: "" -> arm (' in text
    assert re.search(r"planning no longer avoids \w+, \w+, \w+, \w+ and \d+ more", text)
    assert re.search(r"frame removed of base_link, bracelet_link, .*shoulder_link", text)
