"""What a rule that asks the kinematics takes for granted: findings that would only show up again as geometry."""

from __future__ import annotations

SOUND_MODEL = (
    "circular-mimic",
    "degrees-as-radians",
    "duplicate-model-name",
    "frame-cycle",
    "group-without-joints",
    "implausible-distance",
    "joint-of-unknown-link",
    "link-with-two-parents",
    "mimic-of-fixed-joint",
    "mimic-of-nothing",
    "missing-joint-limits",
    "missing-velocity-limit",
    "non-unit-axis",
    "reversed-limits",
    "several-root-links",
    "tip-off-the-tool-chain",
    "two-authorities",
    "zero-axis",
)

KNOWN_POSES = (*SOUND_MODEL, "pose-outside-limits", "wrong-pose-size")
"""Adds that named poses, one of which is where the cell begins, are joint positions that exist."""

KNOWN_GOALS = (*KNOWN_POSES, "goal-moves-with-tip", "goal-out-of-reach", "implausible-approach")
"""Adds that every goal is at a place worth a search."""
