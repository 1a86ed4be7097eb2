"""Rules on what a robot description can get wrong."""

from __future__ import annotations

from cellc.rules.model import (
    circular_mimic,
    degrees_as_radians,
    duplicate_model_name,
    impossible_inertia,
    joint_of_unknown_link,
    link_with_two_parents,
    mimic_of_fixed_joint,
    mimic_of_nothing,
    missing_joint_limits,
    negative_mass,
    non_unit_axis,
    reversed_limits,
    several_root_links,
    zero_axis,
)

RULES = (
    circular_mimic.RULE,
    degrees_as_radians.RULE,
    duplicate_model_name.RULE,
    impossible_inertia.RULE,
    joint_of_unknown_link.RULE,
    link_with_two_parents.RULE,
    mimic_of_fixed_joint.RULE,
    mimic_of_nothing.RULE,
    missing_joint_limits.RULE,
    negative_mass.RULE,
    non_unit_axis.RULE,
    reversed_limits.RULE,
    several_root_links.RULE,
    zero_axis.RULE,
)
