"""The one canonical form of a file in YAML: order of keys, spacing, units; every comment and every value stays."""
