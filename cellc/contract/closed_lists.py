"""The closed lists of a rehearsal: how an attempt may end, and what may fail."""

from __future__ import annotations

from typing import Literal

OutcomeName = Literal[
    "succeeded",
    "cancelled",
    "stale_state",
    "tf_failure",
    "planning_failure",
    "goal_rejection",
    "tolerance_violation",
    "missed_cycle",
    "protective_stop",
    "emergency_stop",
    "hardware_fault",
    "wrong_owner",
    "timeout",
]

FaultKind = Literal[
    "freeze",
    "delay",
    "drop_frame",
    "double_frame",
    "jump_clock",
    "mismatch_qos",
    "unresponsive",
    "unreachable",
    "reject",
    "cancel",
    "second_commander",
    "switch",
    "stick",
    "slow",
    "displace",
    "scale_speed",
    "skip_cycles",
    "wrong_payload",
    "protective_stop",
    "emergency_stop",
    "restart_driver",
    "cut_network",
]
