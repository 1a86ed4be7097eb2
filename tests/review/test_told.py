"""What a review names: topics, pairs, joints, shapes and masses with their units; nothing is cut or counted wrong."""

from __future__ import annotations

import re

import pytest

from cellc.contract.printing import as_text
from cellc.contract.review import Review, ReviewFinding
from cellc.tools.review.acts import shortened
from cellc.tools.review.groups import groups_of
from cellc.tools.review.short import render_short
from tests.review.edits import review_of
from tests.review.revisions import Edit

_SENSOR = """
  sensor:
    model: ati_axia80
    mount: {parent: arm/flange}
    revision: UNKNOWN
    firmware: UNKNOWN
    driver: net_ft_driver 6520a2a
    description: net_ft_description 6520a2a
    connection: {host: control_pc, nic: robot, address: 172.16.0.10}

calibrations:"""
_BOTH_NEARER = (("xyz: 0 650 700 mm", "xyz: 0 600 700 mm"), ("xyz: 0 -900 600 mm", "xyz: 0 -850 600 mm"))


def _screen(found: Review) -> list[str]:
    return as_text(render_short(found), color=False).splitlines()


@pytest.mark.parametrize(
    ("cell", "edits", "told"),
    [
        (
            "hybrid_sdk",
            (
                (
                    "clock: {domain: ros, synchronized_by: chrony, max_offset: 1 ms}\n    nics:\n",
                    "clock: {domain: ros, synchronized_by: chrony, max_offset: 30 ms}\n    nics:\n",
                ),
            ),
            "because its stamps may be further off, and ages are limited: of /joint_states to 100 ms",
        ),
        # docs of the Robotiq 2F-85 and 2F-140: 20 to 235 N, and 10 to 125 N.
        ("ur5e_pick", (("model: robotiq_2f_85", "model: robotiq_2f_140"),), "least grip force 20 N -> 10 N (-50 %)"),
        (
            "ur5e_pick",
            (("model: robotiq_2f_85", "model: robotiq_2f_140"),),
            "shapes 9 boxes and 1 cylinder -> 12 boxes",
        ),
        ("hybrid_sdk", (("\ncalibrations:", _SENSOR),), "shapes 1 cylinder; mass in the description 0.28 kg"),
        # 1.1 kg without the gripper of 0.921 kg.
        (
            "hybrid_sdk",
            ((", mass: 0.3 kg}", "}"),),
            "because no part states another: it is what the payload of 1.1 kg has beyond tools of 0.921 kg",
        ),
        (
            "ur5e_pick",
            (("by: 1.5 deg, at: {step: 2, after: 1 s}", "by: 3 deg, at: {step: 2, after: 1 s}"),),
            "lost jog arm_wrist_3_joint at step 2 started after 1 s by 1.5 deg; new jog arm_wrist_3_joint",
        ),
        ("ur5e_pick", (("by: -6 mm,", "by: -9 mm,"),), "wrong_part object at step 4 started by -9 mm: wrong_part"),
        ("ur5e_pick", (("yaw: 60 deg", "yaw: 40 deg"),), "sweep quantity spread 30 deg -> 20 deg (-33.3 %): object rz"),
        ("ur5e_pick", (("box: 80 80 0 mm", "box: 60 60 0 mm"),), "spread 40 mm -> 30 mm (-25 %): object x, object y"),
        ("rail_arm", (("max_delta: 20 mm", "max_delta: 50 mm"),), "first_motion.rail/carriage_joint.max_delta: 20 mm"),
        ("dual_ur", _BOTH_NEARER, "1 pair can no longer meet: loader_wrist_1_link with unloader_wrist_1_link"),
        (
            "dual_ur",
            (("box: 500 400 500 mm", "box: 400 400 500 mm"),),
            "arms may meet where they were kept apart; safety_plc, which grants access, must be set to the same box",
        ),
    ],
)
def test_what_counts_is_named_with_its_unit(cell: str, edits: tuple[Edit, ...], told: str) -> None:
    assert told in " ".join(line.strip() for line in _screen(review_of(cell, *edits)))


def test_what_several_lines_cause_together_has_no_heading_of_an_area() -> None:
    found = review_of("dual_ur", *_BOTH_NEARER)
    assert [group.cause is None for group in groups_of(found)] == [False, False]


def test_positions_of_a_group_with_an_axis_have_both_units() -> None:
    found = review_of("rail_arm", ("at_press: {rail_and_arm: 0 mm 90", "at_press: {rail_and_arm: 100 mm 90"))
    (change,) = [change for change in found.changes if change.quantity == "joint positions"]
    assert (change.before, change.after) == ("0 mm 90 -90 90 -90 -90 0 deg", "100 mm 90 -90 90 -90 -90 0 deg")


def test_resolved_findings_are_counted_one_by_one() -> None:
    found = review_of("ur5e_pick", ("goal_time: 1 s", "goal_time: 2 s"))
    codes = ("x" * 50, "y", "y")
    gone = tuple(ReviewFinding(code=code, severity="warning", message=code, place="cell.yaml:1:1") for code in codes)
    lines = _screen(found.model_copy(update={"gone_findings": gone}))
    assert f"resolved findings: 3, warning[{codes[0]}] and 2 more" in lines


def test_a_long_first_line_is_broken() -> None:
    found = review_of("ur5e_pick", ("model: robotiq_2f_85", "model: robotiq_2f_140"))
    long = found.model_copy(update={"after": found.after.model_copy(update={"name": "cells/of/a/long/path/cell.yaml"})})
    assert max(map(len, _screen(long))) <= 80


def test_a_list_is_cut_between_its_entries() -> None:
    reasons = ["wrong direction", "overshoot", "unexpected sound", "a person near the arm"]
    assert shortened(f"[{', '.join(reasons)}]") == "[wrong direction, overshoot, unexpected sound, ..."
    found = review_of("ur5e_pick", ("unexpected sound]", f"unexpected sound, {reasons[-1]}, smell of smoke]"))
    assert re.match(r".*: \[\.\.\., unexpected sound\] -> \[\.\.\., unexpected sound, ", groups_of(found)[0].title)
