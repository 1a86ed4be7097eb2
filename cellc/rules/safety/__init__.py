"""Rules on the safety boundary."""

from __future__ import annotations

from cellc.rules.safety import (
    automatic_recovery,
    dependent_stop,
    procedure_without_owner,
    replayed_goal,
    software_as_safety_evidence,
    software_stop_path,
    stop_authority_in_the_cell,
    stop_independent_of_nothing,
    stop_owned_by_software,
    stop_without_evidence,
    unknown_stop_authority,
    unnamed_recovery_state,
)

RULES = (
    automatic_recovery.RULE,
    dependent_stop.RULE,
    procedure_without_owner.RULE,
    replayed_goal.RULE,
    software_as_safety_evidence.RULE,
    software_stop_path.RULE,
    stop_authority_in_the_cell.RULE,
    stop_independent_of_nothing.RULE,
    stop_owned_by_software.RULE,
    stop_without_evidence.RULE,
    unknown_stop_authority.RULE,
    unnamed_recovery_state.RULE,
)
