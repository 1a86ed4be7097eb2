"""The SROS2 policy, part by part."""
