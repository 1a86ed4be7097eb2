"""Faults as data: one small type for each kind, started and ended at their times."""
