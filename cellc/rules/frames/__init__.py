"""Rules on frames and calibration."""

from __future__ import annotations

from cellc.rules.frames import (
    calibration_of_two_frames,
    calibration_without_evidence,
    calibration_without_owner,
    camera_data_in_body_frame,
    dynamic_frame_without_rate,
    frame_cycle,
    implausible_distance,
    latest_transform,
    pose_of_dynamic_frame,
    published_static_frame,
    short_transform_buffer,
    tip_off_the_tool_chain,
    too_few_reference_points,
    two_authorities,
    uncalibrated_frame,
    undated_calibration,
    unpublished_dynamic_frame,
    unused_calibration,
)

RULES = (
    calibration_of_two_frames.RULE,
    calibration_without_evidence.RULE,
    calibration_without_owner.RULE,
    camera_data_in_body_frame.RULE,
    dynamic_frame_without_rate.RULE,
    frame_cycle.RULE,
    implausible_distance.RULE,
    latest_transform.RULE,
    pose_of_dynamic_frame.RULE,
    published_static_frame.RULE,
    short_transform_buffer.RULE,
    tip_off_the_tool_chain.RULE,
    too_few_reference_points.RULE,
    two_authorities.RULE,
    uncalibrated_frame.RULE,
    undated_calibration.RULE,
    unpublished_dynamic_frame.RULE,
    unused_calibration.RULE,
)
