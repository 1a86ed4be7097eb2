"""Rules on the version tuple."""

from __future__ import annotations

from cellc.rules.versions import (
    firmware_outside_matrix,
    floating_version,
    missing_rollback,
    os_of_third_tier,
    os_ros_mismatch,
    package_of_another_distribution,
    rollback_without_digest,
    ros_past_end_of_life,
    unknown_rmw,
    unknown_version,
    version_not_in_matrix,
    version_outside_matrix,
    version_without_number,
)

RULES = (
    firmware_outside_matrix.RULE,
    floating_version.RULE,
    missing_rollback.RULE,
    os_of_third_tier.RULE,
    os_ros_mismatch.RULE,
    package_of_another_distribution.RULE,
    rollback_without_digest.RULE,
    ros_past_end_of_life.RULE,
    unknown_rmw.RULE,
    unknown_version.RULE,
    version_not_in_matrix.RULE,
    version_outside_matrix.RULE,
    version_without_number.RULE,
)
