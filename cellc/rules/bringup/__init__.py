"""Rules on start-up, promotion and recovery."""

from __future__ import annotations

from cellc.rules.bringup import (
    credential_in_text,
    first_motion_cannot_end,
    first_motion_of_unknown_joint,
    first_motion_too_large,
    missing_first_motion,
    removed_gate,
    respawned_commander,
    secret_in_spec,
    startup_cycle,
    unproven_readiness,
)

RULES = (
    credential_in_text.RULE,
    first_motion_cannot_end.RULE,
    first_motion_of_unknown_joint.RULE,
    first_motion_too_large.RULE,
    missing_first_motion.RULE,
    removed_gate.RULE,
    respawned_commander.RULE,
    secret_in_spec.RULE,
    startup_cycle.RULE,
    unproven_readiness.RULE,
)
