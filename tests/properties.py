"""Properties that hold for any value: ``@given(st.integers())``, on a machine that may be as slow as it likes."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

__all__ = ["given", "settings", "st"]

_CHECKS = [HealthCheck.too_slow, HealthCheck.function_scoped_fixture]
settings.register_profile("any speed", deadline=None, suppress_health_check=_CHECKS)
settings.load_profile("any speed")
