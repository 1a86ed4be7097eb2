"""An arm whose driver moves its fingers too, and an arm that no manager loads because an adapter drives it."""

from __future__ import annotations

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.emit.contract.devices import devices
from cellc.compiler.formats.urdf.robot import robot_description
from tests.cells import linked, spec_of


@pytest.fixture(name="gen3", scope="module")
def gen3_fixture() -> Cell:
    """Return the cell of an arm with fingers on its own bus."""
    return linked(spec_of("gen3_2f"))


@pytest.fixture(name="hybrid", scope="module")
def hybrid_fixture() -> Cell:
    """Return the cell of an arm behind an adapter, and a gripper that ros2_control drives."""
    return linked(spec_of("hybrid_sdk"))


def test_trajectories_of_an_arm_leave_its_fingers_to_a_controller_of_their_own(gen3: Cell) -> None:
    joints = {controller.name: controller.joints for controller in gen3.controllers if controller.joints}
    assert joints["arm_trajectory"] == tuple(f"joint_{number}" for number in range(1, 8))
    assert joints["gripper_action"] == ("robotiq_85_left_knuckle_joint",)


def test_fingers_are_gripped_by_the_controller_that_moves_them(gen3: Cell) -> None:
    gripper = devices(gen3)["arm"].gripper
    assert gripper is not None
    assert gripper.controller == "gripper_action"


def test_nothing_of_ros_loads_what_an_adapter_drives(hybrid: Cell) -> None:
    (manager,) = hybrid.managers
    assert manager.devices == ("gripper",)
    for target in ("mock", "real"):
        tags = robot_description(hybrid, target).findall("ros2_control")
        assert [tag.get("name") for tag in tags] == ["gripper_hardware"]
    arm = hybrid.device("arm")
    assert (arm.control.hardware, arm.control.offers) == (None, ())
    assert [one.controller_kind for one in arm.procedures.record] == [None] * len(arm.procedures.record)
