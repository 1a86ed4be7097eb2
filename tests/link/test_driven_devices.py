"""Nodes of the driver that a cell runs, and which of them stands at an end that names the device."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from tests.cells import linking, spec_text, written

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
    (action,) = (one for one in cell.interfaces if one.name == "/arm/go")
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
    cell = linking(written(tmp_path, text.replace(before, region))).value
    assert cell is not None
    assert cell.uncertainty is not None
    bound = cell.uncertainty.regions["object"]
    assert bound.half_m == pytest.approx(half_m)
    assert bound.half_yaw_rad == pytest.approx(half_yaw_deg * 3.141592653589793 / 180)
