"""Rules on the version tuple."""
