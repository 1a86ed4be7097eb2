"""Who claims what: at every device that a controller commands, each with what is known of that device."""

from __future__ import annotations

from cellc.compiler.deploy.arrows import Arrow, drives
from tests.cells import built


def _claims(arrows: list[Arrow]) -> dict[tuple[str, str], tuple[str, ...]]:
    return {(arrow.starts[0], arrow.ends[0]): arrow.facts for arrow in arrows if arrow.kind == "claims"}


def test_controller_of_two_devices_claims_at_both_with_watchdog_plugin_and_architecture_of_each() -> None:
    """One controller moves the axis and the arm on it: the axis has no plugin of its drive and no watchdog."""
    claims = _claims(list(drives(built("rail_arm").graph.cell)))
    assert list(claims) == [("trajectory", "rail"), ("trajectory", "arm"), ("arm_io", "arm")]
    rail, arm = claims["trajectory", "rail"], claims["trajectory", "arm"]
    assert rail[0] == "rail_carriage_joint/position"
    assert "rail" not in arm[0]
    assert arm[0].count("/position") == 6
    assert rail[1].startswith("frame joints, unit m, ")
    assert arm[1].startswith("frame joints, unit rad, ")
    assert rail[2].endswith("watchdog: not stated")
    assert "0.04 s" in arm[2]
    assert rail[3].endswith("architecture: ros2")
    assert arm[3].endswith("architecture: hybrid")
