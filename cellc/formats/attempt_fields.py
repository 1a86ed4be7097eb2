"""The fields of an attempt record, as the checkpoint of chapter 4 names them."""

from __future__ import annotations

from cellc.cell.cell import Cell

STANDARD = (
    "attempt_id",
    "version_tuple",
    "calibration_id",
    "goal_frame",
    "goal_stamp",
    "joint_state_age",
    "tf_lookup_age",
    "plan_result",
    "controller_name",
    "action_goal_id",
    "speed_scaling",
    "safety_state",
    "fault_code",
    "cancel/result",
    "operator_intervention",
)


def attempt_fields(cell: Cell) -> tuple[str, ...]:
    """Return the fields that every attempt of the cell records."""
    written = cell.spec.recording.attempt_fields
    return STANDARD if written == "standard" else tuple(written)
