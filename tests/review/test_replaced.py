"""Another model: what counts of it first, its parts as one change, and what was left for the model before."""

from __future__ import annotations

import math

import pytest

from cellc.contract.printing import as_text
from cellc.contract.review import Review, ReviewChange
from cellc.tools.review.effects import _of_measured
from cellc.tools.review.groups import groups_of
from cellc.tools.review.replaced import MASS, Measured
from cellc.tools.review.short import MOST_LINES, render_short
from tests.review.edits import review_of

_GRIPPER = ("model: robotiq_2f_85", "model: robotiq_2f_140")


def _change(found: Review, quantity: str, subject: str = "") -> ReviewChange:
    (change,) = [
        each for each in found.changes if each.quantity == quantity and (not subject or subject in each.subjects)
    ]
    return change


def test_a_larger_gripper_begins_with_stroke_force_and_length() -> None:
    found = review_of("ur5e_pick", _GRIPPER)
    lines = as_text(render_short(found), color=False).splitlines()
    assert len(lines) <= MOST_LINES
    at = next(number for number, line in enumerate(lines) if line.startswith("dangerous"))
    told = " ".join(line.strip() for line in lines[at:])
    # Robotiq instruction manuals of 2F-85 and 2F-140: stroke 85 and 140 mm, grip force up to 235 and 125 N.
    assert "stroke 85 mm -> 140 mm (+64.7 %); grip force 235 N -> 125 N (-46.8 %); least grip force" in told
    assert told.index("stroke") < told.index("left as it was: devices.arm.payload {mass: 1.0 kg")
    for kept in ("frames.tcp.xyz 0 0 162 mm", "frames.object.grasp.width 77 mm", "devices.gripper.mount.xyz 0 0 11 mm"):
        assert kept in told


def test_another_camera_begins_with_what_it_sees() -> None:
    found = review_of("ur5e_pick", ("model: realsense_d435i", "model: realsense_d455"))
    (group,) = groups_of(found)
    # Intel 337029: the D455 measures from 0.52 m on, and its color sensor sees 90 by 65 deg, the D435i 69 by 42 deg.
    assert group.figures[:3] == (
        "range of depth 0.1 to 10 m -> 0.52 to 6 m",
        "range of color 0.1 to 10 m -> 0.52 to 6 m",
        "field of view of color 69 x 42 deg -> 90 x 65 deg",
    )


def test_a_mass_without_the_inertia_of_a_link_has_no_difference() -> None:
    told = _of_measured(Measured("arm", MASS, 21.7, 8.571, ((7, 7), (4, 7))))
    assert (told.before, told.after, told.delta) == ("21.7 kg (7 of 7 links)", "8.571 kg (4 of 7 links)", "")
    assert _of_measured(Measured("arm", MASS, 20.0, 25.0)).delta == "+25 %"


def test_a_joint_that_turns_without_end_has_no_missing_limit() -> None:
    found = review_of(
        "gen3_2f",
        ("model: kinova_gen3_2f_85", "model: kinova_gen3_6dof_2f_85"),
        ("0 15 180 -130 0 55 90 deg", "0 15 -130 0 55 90 deg"),
        ("arm/joint_7", "arm/joint_6"),
    )
    lower = _change(found, "lower position", "joint_4")
    assert lower.after == "no end (continuous)"
    assert (lower.before or "").endswith(" deg")
    first, *_ = groups_of(found)
    assert first.title.startswith("devices.arm.model: ")  # and not the first motion that follows from it


def test_each_value_has_the_unit_in_which_it_is_written() -> None:
    found = review_of("rail_arm", ("path_tolerance: 0.2 rad 20 mm", "path_tolerance: 0.3 rad 3 cm"))
    told = {(change.before, change.after, change.delta) for change in found.changes}
    assert told == {("0.2 rad", "0.3 rad", "+50 %"), ("20 mm", "3 cm", "+50 %")}


def test_positions_of_fingers_that_turn_and_that_slide_have_each_their_unit() -> None:
    found = review_of("ur5e_pick", ("model: robotiq_2f_85", "model: franka_hand"))
    told = _change(found, "least joint position that holds it")
    assert [(text or "").split()[-1] for text in (told.before, told.after)] == ["deg", "mm"]
    assert told.delta == ""


def test_joints_and_links_of_a_model_are_one_change_that_breaks_consumers_of_the_frames() -> None:
    found = review_of("ur5e_pick", _GRIPPER)
    assert len(found.changes) < 20
    told = [
        change
        for change in found.changes
        if any("robotiq_85" in text for text in (*change.subjects, change.quantity, change.before or ""))
        and change.quantity != "model"
    ]
    assert [(change.quantity, str(change.grade), change.breaking) for change in told] == [
        ("links and joints", "review", True)
    ]
    assert not {change.quantity for change in found.changes} & {"limits removed", "collision shapes removed"}


def test_another_client_of_the_new_joint_is_still_dangerous() -> None:
    found = review_of(
        "ur5e_pick",
        _GRIPPER,
        (
            "gripper_action: {type: parallel_gripper, device: gripper, client: task}",
            "gripper_action: {type: parallel_gripper, device: gripper, client: perception}",
        ),
    )
    assert _change(found, "permitted client", "gripper_action").grade == "dangerous"


def test_what_another_arm_leaves_is_listed() -> None:
    (group,) = groups_of(review_of("ur5e_pick", ("model: ur5e", "model: ur10e")))
    assert group.kept.startswith("left as it was: devices.arm.payload {mass: 1.0 kg, center_of_mass: 0 0 58 mm}; ")
    # Sums of the links in ur_description 3.5.1: 4 + 3.761 + 8.058 + 2.846 + 1.37 + 1.3 + 0.365 kg of a UR5e.
    assert f"mass in the description {4 + 3.761 + 8.058 + 2.846 + 1.37 + 1.3 + 0.365:.5g} kg -> " in "; ".join(
        group.figures
    )


def test_a_value_that_changed_with_the_model_is_not_among_what_was_left() -> None:
    found = review_of("ur5e_pick", _GRIPPER, ("xyz: 0 0 162 mm", "xyz: 0 0 230 mm"))
    (group,) = [each for each in groups_of(found) if each.kept]
    assert "frames.tcp" not in group.kept


def test_how_far_a_frame_moves_is_told_on_what_carries_it() -> None:
    found = review_of("ur5e_pick", ("model: realsense_d435i", "model: realsense_d455"))
    change = _change(found, "pose in its parent", "camera_color_frame")
    # On the flange by hand: the link goes from (10.6 17.5 12.5) to (11.15 47.5 14.5) on the mount, and the color frame
    # in it from 15 to -59 mm in y: 32.5 to -11.5 across, and (0.55, 2) mm along the other axes.
    across = math.hypot((47.5 - 59) - (17.5 + 15), 11.15 - 10.6, 14.5 - 12.5)
    assert change.delta == f"moves {across:.3g} mm on arm_wrist_3_link; in its parent moves 74 mm"


def test_a_shape_that_moved_with_its_link_and_takes_up_the_same_room_is_not_dangerous() -> None:
    found = review_of("ur5e_pick", ("model: realsense_d435i", "model: realsense_d455"))
    # On the mount: x -10.1 to 14.9, y -45 to 45, z 0 to 25 mm lie in x -10.2 to 15.8, y -62 to 62, z 0 to 29 mm.
    assert _change(found, "collision shapes", "camera_link").grade == "review"


@pytest.mark.parametrize(("force", "grade"), [("1 N", "review"), ("19 N", "review"), ("60 N", "dangerous")])
def test_less_grip_force_is_looked_at_too(force: str, grade: str) -> None:
    found = review_of("fr3_hand", ("force: 20 N", f"force: {force}"))
    change = _change(found, "grip force", "hand")
    assert (str(change.grade), change.before) == (grade, "20 N")
    (group,) = groups_of(found)
    assert group.asks == "controller (controls)"


def test_a_lighter_part_is_no_other_part() -> None:
    assert (
        _change(review_of("ur5e_pick", ("mass: 0.2 kg", "mass: 0.1 kg")), "mass of the part to grip").grade == "review"
    )
    heavier = _change(review_of("fr3_hand", ("mass: 0.1 kg", "mass: 0.25 kg")), "mass of the part to grip")
    assert heavier.grade == "dangerous"
    assert heavier.why == "force, payload and motion were chosen for a lighter part"


def test_a_lower_limit_asks_who_answers_for_limits_and_nobody_for_the_lines_of_a_document() -> None:
    found = review_of("fr3_hand", ("velocity: 35 %", "velocity: 20 %"))
    (group,) = groups_of(found)
    assert (str(group.grade), group.asks) == ("safe", "controller (controls)")
    assert {str(change.grade) for change in found.changes} == {"safe"}
