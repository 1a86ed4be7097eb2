"""A link of an arm that is longer: every joint position ends elsewhere, and the review says so with its names in mm."""

from __future__ import annotations

from dataclasses import replace

from cellc.contract.transforms import Pose
from cellc.tools.review.carried import longer_link
from cellc.tools.review.facts import Facts
from tests.review.edits import package_before


def _with_origin(facts: Facts, child: str, position: tuple[float, float, float]) -> Facts:
    joints = tuple(
        replace(joint, pose=Pose(position, joint.pose.quaternion)) if joint.child == child else joint
        for joint in facts.description.joints
    )
    return replace(facts, description=replace(facts.description, joints=joints))


def test_a_longer_upper_arm_is_told_by_its_link_its_joint_and_mm() -> None:
    facts = package_before("ur5e_pick").facts
    # Universal Robots publishes 425 mm from the shoulder to the elbow of a UR5e.
    told = longer_link("arm_forearm_link", facts, _with_origin(facts, "arm_forearm_link", (-0.475, 0.0, 0.0)))
    assert told.startswith("`arm_upper_arm_link` 50 mm longer, origin of joint `arm_elbow_joint` 425 mm -> 475 mm")
    told = longer_link("arm_forearm_link", facts, _with_origin(facts, "arm_forearm_link", (-0.4, 0.0, 0.0)))
    assert told.startswith("`arm_upper_arm_link` 25 mm shorter")


def test_what_carries_no_tip_of_an_arm_makes_no_link_longer() -> None:
    facts = package_before("ur5e_pick").facts
    for child in ("arm_base_link", "camera_link"):
        assert longer_link(child, facts, _with_origin(facts, child, (0.0, 0.0, 0.4))) == ""
