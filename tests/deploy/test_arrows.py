"""Who claims what: at every device that a controller commands, each with what is known of that device."""

from __future__ import annotations

from cellc.compiler.deploy.arrows import Arrow, drives, helpers, stop, unknown_boxes
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


def test_node_of_a_driver_that_no_interface_names_helps_its_device() -> None:
    """The dashboard client and the state helper of an arm run on real hardware, and no node of the cell calls them."""
    found = {arrow.starts[0]: arrow for arrow in helpers(built("rail_arm").graph.cell)}
    assert {name: arrow.ends for name, arrow in found.items()} == {
        "arm_dashboard_client": ("arm",),
        "arm_state_helper": ("arm",),
    }
    assert found["arm_dashboard_client"].facts[0] == "ur_robot_driver/dashboard_client, on real hardware"
    assert "/arm_dashboard_client/brake_release" in found["arm_dashboard_client"].facts[1]
    assert not list(helpers(built("fr3_hand").graph.cell))  # its one node takes the goals of the hand


def test_what_is_unknown_is_told_from_what_is_known() -> None:
    rail, minimal = built("rail_arm").graph.cell, built("minimal").graph.cell
    unknown = {arrow.ends[0] for arrow in drives(rail) if arrow.is_unknown}
    assert unknown == {"rail"}  # its drive has no plugin
    assert {"rail", "arm"} <= unknown_boxes(rail)  # UNKNOWN revisions
    assert "task" not in unknown_boxes(rail)
    assert not any(arrow.is_unknown for arrow in stop(rail))
    assert all(arrow.is_unknown for arrow in stop(minimal))
    assert "robot_state_publisher" in unknown_boxes(minimal)
