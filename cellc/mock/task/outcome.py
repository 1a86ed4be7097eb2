"""How an attempt ends."""

from __future__ import annotations

from enum import Enum


class Outcome(str, Enum):
    """The outcomes of an attempt; each failure is told apart from every other (chapter 4, section 10)."""

    SUCCEEDED = "succeeded"
    CANCELLED = "cancelled"
    STALE_STATE = "stale_state"
    TF_FAILURE = "tf_failure"
    PLANNING_FAILURE = "planning_failure"
    GOAL_REJECTION = "goal_rejection"
    TOLERANCE_VIOLATION = "tolerance_violation"
    MISSED_CYCLE = "missed_cycle"
    PROTECTIVE_STOP = "protective_stop"
    EMERGENCY_STOP = "emergency_stop"
    HARDWARE_FAULT = "hardware_fault"
    WRONG_OWNER = "wrong_owner"
    TIMEOUT = "timeout"


class AttemptError(Exception):
    """Ends the attempt that is running; raised anywhere inside a step and caught by the task alone.

    Args:
        outcome: how the attempt ends.
        fault_code: the reason, in the words of whoever failed.
    """

    def __init__(self, outcome: Outcome, fault_code: str) -> None:
        super().__init__(f"{outcome.value}: {fault_code}")
        self.outcome = outcome
        self.fault_code = fault_code
