"""Rules on the safety boundary."""
