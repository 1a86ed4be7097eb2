"""The two-arm cell in the mock: controllers of one name under two managers are told apart."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from cellc.mock.cell import load, run_all
from tests.cells import DISTROS
from tests.consumers.matrix import build


@pytest.mark.parametrize("distro", DISTROS)
def test_each_arm_is_moved_by_its_own_controller(distro: str, tmp_path: Path) -> None:
    for path, text in build("two_arms", distro).texts.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    (result,) = run_all(load(tmp_path))
    assert result.passed, result
    claims = next(stage for stage in result.bringup if stage.stage == "claim").facts
    for side in ("left", "right"):
        owner = f"/{side}/arm_trajectory"
        assert f"`{side}_elbow_joint/position` is claimed by `{owner}`" in claims
    moved = {record.controller_name for record in result.attempts if record.controller_name}
    assert "/left/gripper_action" in moved


def test_no_port_of_the_host_is_listened_on_by_two_drivers() -> None:
    # Universal Robots: the robot connects back to four ports of the computer, the same four by default.
    root = ElementTree.fromstring(build("two_arms", "jazzy").texts["urdf/two_arms.real.urdf"])
    ports = {
        tag.get("name", ""): [param.text for param in tag.iter("param") if param.get("name", "").endswith("_port")]
        for tag in root.findall("ros2_control")
    }
    assert ports["left_arm_hardware"] == ["50001", "50002", "50003", "50004"]
    assert ports["right_arm_hardware"] == ["50011", "50012", "50013", "50014"]
    gates = build("two_arms", "jazzy").texts["gates/promotion.md"]
    assert "port 50002. " in gates
    assert "port 50012. " in gates
