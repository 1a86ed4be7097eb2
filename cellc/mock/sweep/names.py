"""How a run of a sweep is named."""

SWEPT = "sweep:"
"""Before its number."""
