"""Rules on what an attempt leaves behind."""

from __future__ import annotations

from cellc.rules.evidence import (
    kpi_beyond_contract,
    kpi_without_target,
    merged_failure_layers,
    removed_attempt_field,
    tolerated_wrong_owner,
    unknown_recorded_topic,
    unrehearsed_failure,
)

RULES = (
    kpi_beyond_contract.RULE,
    kpi_without_target.RULE,
    merged_failure_layers.RULE,
    removed_attempt_field.RULE,
    tolerated_wrong_owner.RULE,
    unknown_recorded_topic.RULE,
    unrehearsed_failure.RULE,
)
