"""Why planning did not give a path: values, never exceptions, so that the task can record them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class FailureReason(str, Enum):
    """The distinct reasons of a planning failure; the value is the word written to the attempt record."""

    NO_IK_SOLUTION = "no_ik_solution"
    GOAL_IN_COLLISION = "goal_in_collision"
    START_IN_COLLISION = "start_in_collision"
    OUT_OF_LIMITS = "out_of_limits"
    NO_PATH = "no_path"
    SINGULAR = "singular"
    JOINT_JUMP = "joint_jump"


@dataclass(frozen=True, slots=True)
class IkFailure:
    """No configuration puts the tip at the target."""

    reason: FailureReason
    detail: str


@dataclass(frozen=True, slots=True)
class PlanFailure:
    """No path leads from the start to the goal."""

    reason: FailureReason
    detail: str


class ModelError(ValueError):
    """The robot description cannot be used; the message is one line and names the culprit."""


class LimitsError(ValueError):
    """A limit is zero, negative, not a number, or reversed; the message names the joint."""
