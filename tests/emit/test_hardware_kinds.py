"""The real description says of each plugin what of ros2_control it is: the manager looks for it among those alone."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from cellc.compiler.formats.urdf.robot import manager_description
from cellc.compiler.formats.xml_text import render
from cellc.contract.entities import Target
from tests.cells import linked, written

SPEC = """format: 1
cell: pushed
summary: an arm with a sensor at its flange
versions: {ros: jazzy}
devices:
  arm: {model: ur5e}
  wrench: {model: ati_axia80, mount: {parent: arm/tool0}}
control:
  update_rate: 500 Hz
  controllers: {joint_states: {type: joint_state_broadcaster}}
"""


# On the mock it is mock_components/GenericSystem, which is a system whatever it stands for.
@pytest.mark.parametrize(("target", "kind"), [("real", "sensor"), ("mock", "system")])
def test_sensor_is_a_sensor_on_the_real_target(target: Target, kind: str, tmp_path: Path) -> None:
    cell = linked(written(tmp_path, SPEC))
    root = ElementTree.fromstring(render(manager_description(cell, target, ("arm", "wrench")), ""))
    found = {tag.get("name"): tag.get("type") for tag in root.iter("ros2_control")}
    assert found == {"arm_hardware": "system", "wrench_hardware": kind}
