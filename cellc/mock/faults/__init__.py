"""Faults as data: one small type for each kind, begun and ended at their times."""
