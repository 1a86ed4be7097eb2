"""Rules on clocks, stamps and ages."""

from __future__ import annotations

from cellc.rules.clocks import (
    age_budget_exceeded,
    clock_offset_beyond_age,
    continues_on_stale,
    continues_on_timeout,
    contradicting_time_source,
    max_age_beyond_timeout,
    max_age_too_short,
    missing_max_age,
    mixed_clocks,
    unknown_stamp_source,
    unstated_stale_behaviour,
    unsynchronised_hosts,
    unsynchronised_sensor_clock,
)

RULES = (
    age_budget_exceeded.RULE,
    clock_offset_beyond_age.RULE,
    continues_on_stale.RULE,
    continues_on_timeout.RULE,
    contradicting_time_source.RULE,
    max_age_beyond_timeout.RULE,
    max_age_too_short.RULE,
    missing_max_age.RULE,
    mixed_clocks.RULE,
    unknown_stamp_source.RULE,
    unstated_stale_behaviour.RULE,
    unsynchronised_hosts.RULE,
    unsynchronised_sensor_clock.RULE,
)
