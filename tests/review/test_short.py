"""What stands first and how it reads: what moves before what is noted, exchanged lines, shapes, units and approvers."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from cellc.compiler.pipeline import check
from cellc.contract.printing import as_text
from cellc.contract.review import Review
from cellc.tools.review.compare import _unexplained, change_of
from cellc.tools.review.cutting import cut
from cellc.tools.review.groups import groups_of
from cellc.tools.review.leaves import Delta
from cellc.tools.review.markdown import render_markdown
from cellc.tools.review.review import review
from cellc.tools.review.short import MOST_LINES, render_short
from cellc.tools.review.sides import package_of
from tests.cells import spec_of
from tests.review.edits import package_before, review_of
from tests.review.revisions import Edit


def _lines(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


def test_a_faster_arm_stands_before_a_patch_of_its_library_and_both_say_their_values() -> None:
    text = spec_of("fr3_hand").read_text(encoding="utf-8")
    assert text.count("libfranka 0.20.4") == 2
    file = spec_of("fr3_hand").as_posix()
    text = text.replace("libfranka 0.20.4", "libfranka 0.20.5").replace("velocity: 35 %", "velocity: 60 %")
    found = review(package_before("fr3_hand"), package_of("after", check(file, {file: text})))
    first, second = (group.title for group in groups_of(found))
    assert first.startswith("devices.arm.limits.velocity: 35 % -> 60 % (cell.yaml:")
    assert second.startswith("devices.{arm,hand}.sdk: libfranka 0.20.4 -> 0.20.5 (cell.yaml:")
    assert "**review** `devices.{arm,hand}.sdk`: `libfranka 0.20.4` -> `0.20.5`" in render_markdown(found)
    # What only follows is no change to look at, and nobody is asked for it.
    (limits,) = [group for group in groups_of(found) if group.title == first]
    assert limits.asks == "controller (controls)"
    assert not [line for line in _lines(found) if "documents" in line]


def test_a_narrow_heading_has_no_figure_of_what_only_follows() -> None:
    found = review_of("ur5e_pick", ("model: realsense_d435i", "model: realsense_d455"))
    assert any(change.delta.endswith("%") for change in groups_of(found)[0].changes)  # of a mass, and of the view
    assert groups_of(found)[0].fitting(60) == "devices.camera.model: realsense_d435i -> realsense_d455"
    moved = review_of("ur5e_pick", ("velocity: 50 %", "velocity: 60 %"))
    assert groups_of(moved)[0].fitting(50) == "devices.arm.limits.velocity: 50 % -> 60 % (+20 %)"


def test_the_largest_of_what_is_equally_bad_stands_first() -> None:
    found = review_of("ur5e_pick", ("velocity: 50 %", "velocity: 60 %"), ("max_age: 200 ms", "max_age: 2 s"))
    dangerous = [group.title.partition(":")[0] for group in groups_of(found) if group.grade == "dangerous"]
    assert dangerous == ["interfaces./object_pose.max_age", "devices.arm.limits.velocity"]


def test_ports_that_were_exchanged_are_told_as_that() -> None:
    found = review_of(
        "openarm_bimanual", ("port: can1", "port: canX"), ("port: can0", "port: can1"), ("port: canX", "port: can0")
    )
    told = r"exchanged: left can1 -> can0, right can0 -> can1 \(cell\.yaml:\d+, \d+\)"
    (group,) = groups_of(found)
    assert re.fullmatch(rf"devices\.{{left,right}}\.connection\.port {told}", group.title)
    assert re.search(told, " ".join(line.strip() for line in _lines(found)))
    assert "exchanged: left `can1` -> `can0`, right `can0` -> `can1`" in render_markdown(found)


@pytest.mark.parametrize(
    ("cell", "edit", "grade"),
    [
        ("ur5e_pick", ("box: 900 1200 40 mm", "box: 900 800 40 mm"), "dangerous"),
        ("ur5e_pick", ("box: 900 1200 40 mm", "box: 900 1400 40 mm"), "review"),
        ("ur5e_pick", ("xyz: 350 0 780 mm, box", "xyz: 450 0 780 mm, box"), "dangerous"),
    ],
)
def test_an_obstacle_that_is_no_longer_where_it_was_is_dangerous(cell: str, edit: Edit, grade: str) -> None:
    found = review_of(cell, edit)
    assert str(groups_of(found)[0].grade) == grade
    assert {(str(change.area), change.approval) for change in found.changes if change.grade == grade} == {
        ("model", "controller")
    }


def test_what_was_measured_with_it_stands_under_the_heading() -> None:
    found = review_of("hybrid_sdk", ("xyz: 0 0 11 mm", "xyz: 0 0 14 mm"))
    lines = _lines(found)
    at = next(number for number, line in enumerate(lines) if line.startswith("dangerous"))
    assert lines[at + 1] == "  tcp_2f (revision 1) has no new revision"
    assert "; **`tcp_2f` (revision 1) has no new revision**" in render_markdown(found)


def test_a_moved_base_is_asked_of_safety_and_of_who_measures_and_no_line_is_cut() -> None:
    found = review_of("dual_ur", ("xyz: 0 -900 600 mm", "xyz: 0 -600 600 mm"))
    lines = _lines(found)
    assert "  asks safety (safety), controller (controls), time_tf (metrology)" in lines
    assert not [line for line in lines if line.endswith("...")]
    assert len(lines) <= MOST_LINES


def test_a_state_that_recovery_lost_is_told_without_the_cell_and_a_value_is_one_piece_of_code() -> None:
    left = "[protective_stop, emergency_stop, fault]"
    was = "[protective_stop, user_stop, emergency_stop, fault]"
    found = review_of("fr3_hand", (f"states: {was}", f"states: {left}"))
    assert "  safety  states that need recovery lost user_stop" in _lines(found)
    assert f": `{was}` -> `{left}`" in render_markdown(found)


def test_efforts_and_centers_of_mass_have_units() -> None:
    facts = package_before("ur5e_pick").facts
    path = ("real", "joint", "arm_elbow_joint", "limit", "effort")
    change = change_of(Delta(path, 150.0, 433.0), facts, facts)
    assert change is not None
    assert (change.before, change.after) == ("150 N m", "433 N m")
    of_payload = ("device", "arm", "payload", "center_of_mass")
    change = change_of(Delta(of_payload, (0.0, 0.0, 0.06), (0.0, 0.0, 0.11)), facts, facts)
    assert change is not None
    assert (change.before, change.after) == ("0 0 60 mm", "0 0 110 mm")


def test_pairs_of_links_read_as_what_can_meet() -> None:
    before = package_before("dual_ur")
    pairs = [path for path, leaf in before.facts.leaves.items() if path[0] == "pair" and leaf == "Never"][:3]
    leaves = {path: leaf for path, leaf in before.facts.leaves.items() if path not in pairs}
    after = replace(before, document=None, facts=replace(before.facts, leaves=leaves))
    found = review(replace(before, document=None), after)
    (change,) = found.changes
    assert (change.quantity, change.before, change.after) == ("can now meet", "not checked (Never)", "checked")
    first = pairs[0][1].replace(" and ", " with ")
    assert [line for line in _lines(found) if line.startswith(f"  model  3 pairs can now meet: {first}")]


def test_a_value_that_two_folders_do_not_hold_is_dangerous() -> None:
    facts = replace(package_before("rail_arm").facts, cell=None)
    inputs = facts.manifest.configuration_inputs.model_copy(update={"cell_sha256": "0" * 64})
    other = replace(facts, manifest=facts.manifest.model_copy(update={"configuration_inputs": inputs}))
    (change,) = _unexplained(facts, other)
    assert str(change.grade) == "dangerous"
    assert change.quantity == "value that these folders do not hold; compare the specs"


@pytest.mark.parametrize(
    ("area", "before", "asked"),
    [
        ("vendor", "robot", "vendor (robot and metrology), graph (integration)"),
        ("graph", "integration", "graph (integration and metrology)"),
        ("safety", "safety", "safety (safety and metrology)"),
    ],
)
def test_who_takes_an_approval_over_is_asked_with_who_had_it(area: str, before: str, asked: str) -> None:
    (group,) = groups_of(review_of("ur5e_pick", (f"{area}: {before},", f"{area}: metrology,")))
    assert group.asks == asked


@pytest.mark.parametrize(
    ("cell", "edit"),
    [
        ("openarm_bimanual", ("joint: 230 230 190 190", "joint: 230 190 230 190")),
        ("hybrid_sdk", ("stiffness: 600 600 600 600 250", "stiffness: 600 600 600 250 600")),
    ],
)
def test_stiffness_of_a_joint_is_dangerous_and_both_safety_and_control_are_asked(cell: str, edit: Edit) -> None:
    found = review_of(cell, edit)
    assert "stiffness of the joint" in {change.quantity for change in found.changes if change.grade == "dangerous"}
    assert {group.asks for group in groups_of(found)} == {"safety (safety), controller (controls)"}
    assert not [change.quantity for change in found.changes if "law." in change.quantity]


def test_a_danger_has_its_reason_where_lines_are_cut() -> None:
    found = review_of(
        "ur5e_pick",
        ("rate: 30 Hz\n    max_age: 100 ms", "rate: 15 Hz\n    max_age: 150 ms"),
        ("{reliability: best_effort, depth: 1}", "{reliability: reliable, depth: 5}"),
    )
    lines = as_text(render_short(found), color=False).splitlines()
    at = lines.index("dangerous  interfaces./camera/color/image_raw.max_age: 100 ms -> 150 ms (+50 %)")
    assert lines[at + 1 : at + 3] == ["  (cell.yaml:96)", "  because older data may be used"]
    assert len(lines) <= MOST_LINES


def test_what_is_cut_says_how_much_is_left() -> None:
    assert cut("a b c") == "a b c"
    assert cut("one two three four five six", 24) == "one two ... 4 words more"
    found = review_of("ur5e_pick", ("model: robotiq_2f_85", "model: franka_hand"))
    lines = as_text(render_short(found), color=False).splitlines()
    assert not [line for line in lines if line.endswith("...")]


def test_who_is_asked_is_never_cut_and_the_head_counts_as_every_other_form_does() -> None:
    slower = ("cancel_within: 200", "cancel_within: 204"), ("cancel: 200 ms", "cancel: 204 ms")
    found = review_of("ur5e_pick", ("exposure: 8 ms", "exposure: 12 ms"), *slower)
    lines = _lines(found)
    assert lines[0].partition(": ")[2] == "2 causes (2 review), 5 changes"
    assert len([line for line in lines if line.startswith("review  ")]) == 2
    assert len(found.changes) == 5
    owners = "data: metrology and calibration"
    long = found.model_copy(
        update={
            "changes": tuple(
                change.model_copy(update={"owner": owners, "beside": dict.fromkeys(change.beside, owners)})
                for change in found.changes
            )
        }
    )
    text = " ".join(line.strip() for line in _lines(long))
    assert f"asks safety ({owners}), controller ({owners}), graph ({owners})" in text
