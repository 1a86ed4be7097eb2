"""What drives a device: nodes of its driver, components, adapters and the controllers of its fingers."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.emit.contract.devices import devices
from cellc.compiler.formats.urdf.robot import robot_description
from tests.cells import linked, linking, spec_of, spec_text, there, written

_ARM = """
format: 1
cell: demo
versions: {{ros: jazzy}}
nodes: {{task: {{run: own/task}}}}
devices: {{arm: {{model: ur5e, mount: {{parent: world}}{more}}}}}
interfaces:
  /arm/go: {{action: control_msgs/action/FollowJointTrajectory, server: arm, client: task, timeout: 5 s,
            on_timeout: cancel_and_hold, cancel_within: 200 ms}}
"""


def _cell(folder: Path, more: str) -> Cell:
    outcome = linking(written(folder, _ARM.format(more=more)))
    assert outcome.value is not None, outcome.diagnostics
    return outcome.value


@pytest.mark.parametrize(
    ("firmware", "run"),
    [
        # The vendor's dashboard client needs PolyScope X 10.11; it runs with every other product.
        ("polyscope_x 10.10.9", False),
        ("polyscope_x 10.11.0", True),
        ("polyscope_x 10.12.1", True),
        ("polyscope_5 5.21.0", True),
        ("UNKNOWN", True),
    ],
)
def test_node_that_needs_a_newer_firmware_is_not_run(firmware: str, run: bool, tmp_path: Path) -> None:
    nodes = {node.name for node in _cell(tmp_path, f", firmware: {firmware}").nodes}
    assert ("arm_dashboard_client" in nodes) is run


@pytest.mark.parametrize(
    ("more", "name"),
    [
        (", architecture: direct_sdk, adapter: {run: own/loop}", "/arm"),  # the name of the adapter
        (", architecture: direct_sdk", "/arm"),
        ("", "/arm_dashboard_client"),  # the first node of its driver
    ],
)
def test_device_stands_at_an_end_with_the_node_that_drives_it(more: str, name: str, tmp_path: Path) -> None:
    cell = _cell(tmp_path, more)
    (action,) = (interface for interface in cell.interfaces if interface.name == "/arm/go")
    assert [(end.node, end.full_name) for end in action.sources] == [("arm", name)]
    assert "arm_dashboard_client" in {node.name for node in cell.nodes}


@pytest.mark.parametrize(
    ("region", "half_m", "half_yaw_deg"),
    [
        ("{box: 80 60 0 mm, yaw: 60 deg}", (0.04, 0.03, 0.0), 30.0),
        ("{box: 80 60 10 mm}", (0.04, 0.03, 0.005), 0.0),
    ],
)
def test_region_reaches_half_its_size_to_each_side(
    region: str, half_m: tuple[float, float, float], half_yaw_deg: float, tmp_path: Path
) -> None:
    before = "{box: 80 80 0 mm, yaw: 60 deg}"
    text = spec_text("ur5e_pick")
    assert before in text
    cell = there(linking(written(tmp_path, text.replace(before, region))).value)
    bound = there(cell.uncertainty).regions["object"]
    assert bound.half_m == pytest.approx(half_m)
    assert bound.half_yaw_rad == pytest.approx(half_yaw_deg * 3.141592653589793 / 180)


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
    gripper = there(devices(gen3)["arm"].gripper)
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
