"""Rules on quality of service."""

from __future__ import annotations

from cellc.rules.qos import (
    backlog_of_newest,
    deadline_below_period,
    deadline_mismatch,
    durability_mismatch,
    lease_mismatch,
    lifespan_below_max_age,
    liveliness_mismatch,
    lossy_every_sample,
    qos_ignored_by_rmw,
    reliability_mismatch,
    shallow_queue_for_every_sample,
)

RULES = (
    backlog_of_newest.RULE,
    deadline_below_period.RULE,
    deadline_mismatch.RULE,
    durability_mismatch.RULE,
    lease_mismatch.RULE,
    lifespan_below_max_age.RULE,
    liveliness_mismatch.RULE,
    lossy_every_sample.RULE,
    qos_ignored_by_rmw.RULE,
    reliability_mismatch.RULE,
    shallow_queue_for_every_sample.RULE,
)
