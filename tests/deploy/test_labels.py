"""What the arrows of a cell's graph say: of interfaces built by hand, and of what a spec leaves unsaid."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from cellc.compiler.cell.interface import Endpoint, Interface
from cellc.compiler.deploy.labels import (
    driver_facts,
    folded,
    interface_facts,
    rates_of_controllers,
    unused,
    unused_title,
    watched_stream,
)
from cellc.contract.diagnostics import Span
from cellc.contract.qos import DEFAULT
from cellc.contract.vocabulary import InterfaceKind
from tests.cells import CORPUS, built, linked

_PLACE = Span("cell.yaml", 1, 1, 1, 2)
_LATCHED = replace(DEFAULT, durability="transient_local", depth=1)


def _interface(kind: str, type_: str, **changes: Any) -> Interface:
    qos = changes.pop("qos", DEFAULT)
    names = changes.pop("sources", ["driver"])
    ends = tuple(Endpoint(node=name, full_name=f"/{name}", qos=qos, path=(), span=_PLACE) for name in names)
    path = ("interfaces", "/it")
    changes = {"sources": ends, "sinks": (), **changes}
    return Interface(name="/it", path=path, span=_PLACE, kind=InterfaceKind(kind), type=type_, **changes)


@pytest.mark.parametrize(
    ("interface", "facts"),
    [
        (
            _interface("topic", "std_msgs/msg/Bool", qos=_LATCHED),
            [
                "topic std_msgs/msg/Bool, rate not stated, latched",
                "frame not stated, unit per message type, time none, unstamped",
                "owner not stated; missing: readers wait",
            ],
        ),
        (
            _interface("topic", "std_msgs/msg/String", rate_hz=2.5),
            [
                "topic std_msgs/msg/String, 2.5 Hz",
                "frame none, unit none, time none, unstamped",
                "owner not stated; failure not stated",
            ],
        ),
        (
            _interface("topic", "geometry_msgs/msg/WrenchStamped", frame="tool0", unit="N, N m", time_source="ros"),
            [
                "topic geometry_msgs/msg/WrenchStamped, rate not stated",
                "frame tool0, unit N, N m, time ros",
                "owner not stated; failure not stated",
            ],
        ),
        (
            _interface("topic", "tf2_msgs/msg/TFMessage", sources=["robot_state_publisher"]),
            [
                "topic tf2_msgs/msg/TFMessage, 20 Hz",
                "frame in each transform, unit per message type, time not stated",
                "owner not stated; failure not stated",
            ],
        ),
        (
            _interface("topic", "tf2_msgs/msg/TFMessage", sources=["robot_state_publisher", "perception"]),
            [
                "topic tf2_msgs/msg/TFMessage, 20 Hz, dynamic frames at their own rate",
                "frame in each transform, unit per message type, time not stated",
                "owner not stated; failure not stated",
            ],
        ),
        (
            _interface("topic", "sensor_msgs/msg/Image", owner="robot", on_stale="reject_goal", max_age_s=0.1),
            [
                "topic sensor_msgs/msg/Image, rate not stated",
                "frame header.frame_id, unit per message type, time not stated",
                "owner robot; stale after 0.1 s: reject_goal",
            ],
        ),
        (
            _interface(
                "action",
                "control_msgs/action/FollowJointTrajectory",
                goal_time_s=1.0,
                cancel_within_s=0.2,
                on_error="abort_and_hold",
            ),
            [
                "action control_msgs/action/FollowJointTrajectory, on request",
                "frame joints, unit per message type, time not stated",
                "owner not stated; no timeout stated, ends at most 1 s after its trajectory, "
                "cancel holds within 0.2 s, error: abort_and_hold",
            ],
        ),
        (
            _interface("service", "std_srvs/srv/Trigger", timeout_s=2.0, on_timeout="hold"),
            [
                "service std_srvs/srv/Trigger, on request",
                "frame not stated, unit per message type, time not stated",
                "owner not stated; timeout after 2 s: hold",
            ],
        ),
    ],
    ids=lambda value: f"{value.kind.value} {value.type}" if isinstance(value, Interface) else "",
)
def test_facts_of_an_interface(interface: Interface, facts: list[str]) -> None:
    assert list(interface_facts(interface, {})) == facts


def test_latched_topic_without_a_publisher_is_not_called_latched() -> None:
    assert "rate not stated" in next(
        interface_facts(_interface("topic", "std_msgs/msg/String", sources=[], derived=True), {})
    )


def test_topics_of_controllers_have_the_rate_of_their_parameter_of_their_cycle_or_change() -> None:
    """The driver publishes the speed at state_publish_rate, inputs in each cycle, and modes as they change."""
    cell = built("rail_arm").graph.cell
    rates = rates_of_controllers(cell)
    assert rates["/arm_speed/speed_scaling"] == "100 Hz"
    assert rates["/arm_io/io_states"] == "500 Hz"
    assert rates["/arm_io/robot_mode"] == "on change, latched"
    facts = {each.name: list(interface_facts(each, rates)) for each in cell.interfaces}
    assert facts["/arm_speed/speed_scaling"][0] == "topic std_msgs/msg/Float64, 100 Hz"
    assert facts["/arm_speed/speed_scaling"][2].endswith("failure not stated")
    assert facts["/arm_io/robot_mode"][2].endswith("missing: readers wait")
    assert facts["/tf_static"][0].endswith(", once, latched")


def test_watched_stream_is_that_of_the_adapter_of_the_device() -> None:
    """The adapter of the arm states 40 ms without commands and 100 ms to stop; the other is of another device."""
    cell = linked(CORPUS / "valid" / "direct_sdk_arm.yaml")
    (adapter,) = cell.adapters
    other = replace(adapter, device="other", command_timeout_s=0.5)
    for adapters in ((adapter, other), (other, adapter)):
        both = replace(cell, adapters=adapters)
        assert (
            watched_stream(both, cell.device("arm")) == "stops after 0.04 s without commands, standstill within 0.1 s"
        )
    assert watched_stream(replace(cell, adapters=(other,)), cell.device("arm")) is None


def test_driver_that_moves_a_hand_names_its_goals() -> None:
    """The catalog has the vendor's gripper node for the Franka Hand: no controller claims its fingers there."""
    cell = built("fr3_hand").graph.cell
    (device,) = (each for each in cell.devices if each.control.driver is not None and each.control.driver.actions)
    assert device.control.driver is not None
    program, goals, owner, architecture = driver_facts(cell, device, device.control.driver)
    assert program == "franka_gripper/franka_gripper_node, on real hardware; no controller claims anything there"
    assert goals == "goals: /hand_gripper/gripper_action; frame joints, on request, time of the driver"
    assert owner.startswith(f"owner {cell.owners.responsibilities.vendor_safety}; watchdog: ")
    assert architecture == f"architecture: {device.architecture}"


@pytest.mark.parametrize(
    ("names", "shown"),
    [
        (["output_0", "output_1", "output_2"], ["output_[0..2]"]),
        (["output_1", "output_2"], ["output_[1..2]"]),
        (["output_0", "output_2"], ["output_0", "output_2"]),
        (["output_0"], ["output_0"]),
        (["left", "right"], ["left", "right"]),
        (["a_0", "a_1", "b"], ["a_[0..1]", "b"]),
        (["a", "a1"], ["a", "a1"]),
    ],
)
def test_names_that_count_up_are_written_as_one(names: list[str], shown: list[str]) -> None:
    assert list(folded(names)) == shown


def test_interfaces_without_a_user_are_grouped_by_server_kind_and_owner() -> None:
    cell = built("ur5e_pick").graph.cell
    groups = unused(cell)
    alone = {interface.name for interface in cell.interfaces if interface.sources and not interface.sinks}
    assert {interface.name for group in groups for interface in group} == alone
    for group in groups:
        assert len({(frozenset(end.full_name for end in each.sources), each.kind, each.owner) for each in group}) == 1
    one = (_interface("service", "std_srvs/srv/Trigger"),)
    assert unused_title(one) == "1 service that no node of this cell calls"
    two = (_interface("topic", "std_msgs/msg/Bool"),) * 2
    assert unused_title(two) == "2 topics that no node of this cell reads"
