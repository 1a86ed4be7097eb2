"""Rules on geometry and motion."""

from __future__ import annotations

from cellc.rules.motion import (
    detected_static_frame,
    empty_rehearsal,
    goal_moves_with_tip,
    goal_out_of_reach,
    gripper_without_controller,
    group_without_joints,
    implausible_approach,
    pose_outside_limits,
    undetected_goal,
    unprovoked_failure,
    unsimulated_object,
    wrong_pose_size,
)

RULES = (
    detected_static_frame.RULE,
    empty_rehearsal.RULE,
    goal_moves_with_tip.RULE,
    goal_out_of_reach.RULE,
    gripper_without_controller.RULE,
    group_without_joints.RULE,
    implausible_approach.RULE,
    pose_outside_limits.RULE,
    undetected_goal.RULE,
    unprovoked_failure.RULE,
    unsimulated_object.RULE,
    wrong_pose_size.RULE,
)
