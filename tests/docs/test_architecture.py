"""The three values that docs/architecture.md follows are, at each stage, what the page says; named files exist."""

from __future__ import annotations

import re

import pytest

from cellc.compiler.spec.parse import parse
from cellc.mock import load
from tests.cells import ROOT, built, document_of, generated, linked, spec_of
from tests.foreign_yaml import safe_load

PAGES = [(ROOT / name).read_text(encoding="utf-8") for name in ("docs/architecture.md", "CONTRIBUTING.md", "README.md")]
NAMED = {path for page in PAGES for path in re.findall(r"`((?:cellc|tests|docs|benchmarks)/[\w/.]+)`", page)}
PICK = spec_of("ur5e_pick")


@pytest.mark.parametrize("path", sorted(NAMED))
def test_file_that_is_named_exists(path: str) -> None:
    assert (ROOT / path).exists()


def test_mount_of_an_arm() -> None:
    document = document_of(PICK)
    assert document.text_at(("devices", "arm", "mount", "xyz")) == "0 0 0.8 m"
    spec = parse(document).value
    assert spec is not None
    mount = spec.devices["arm"].mount
    assert mount is not None
    assert mount.xyz is not None
    assert mount.xyz.si == (0.0, 0.0, 0.8)
    cell = linked(PICK)
    assert cell.device("arm").mount.transform_root_to_parent.position == (0.0, 0.0, 0.8)
    urdf = built("ur5e_pick").texts["urdf/ur5e_pick.mock.urdf"]
    (joint,) = re.findall(r"<joint [^>]*>(?:(?!</joint>).)*<parent link=\"world\"/>.*?</joint>", urdf, re.DOTALL)[:1]
    assert '<origin xyz="0 0 0.8"/>' in joint
    poses = {each.pose.position for each in load(generated("ur5e_pick")).folder.description.joints}
    assert (0.0, 0.0, 0.8) in poses


def test_reliability_of_an_endpoint() -> None:
    path = ("interfaces", "/object_pose", "to", "task", "reliability")
    assert document_of(PICK).text_at(path) == "reliable"
    interface = next(each for each in linked(PICK).interfaces if each.name == "/object_pose")
    assert [end.qos.reliability for end in interface.sinks if end.node == "task"] == ["reliable"]
    overrides = safe_load(built("ur5e_pick").texts["config/nodes.yaml"])
    assert "reliable" in str(overrides)
    promised = load(generated("ur5e_pick")).contract.interfaces["/object_pose"]
    assert [end.qos.reliability for end in promised.sinks if end.node == "task"] == ["reliable"]


def test_goal_time_of_a_controller() -> None:
    path = ("control", "controllers", "arm_trajectory", "goal_time")
    assert document_of(PICK).text_at(path) == "1 s"
    controller = next(each for each in linked(PICK).controllers if each.name == "arm_trajectory")
    assert controller.goal_time_s == 1.0
    parameters = safe_load(built("ur5e_pick").texts["config/controllers.yaml"])
    assert parameters["arm_trajectory"]["ros__parameters"]["constraints"]["goal_time"] == 1.0
    contract = load(generated("ur5e_pick")).contract
    assert contract.managers["control"].controllers["arm_trajectory"].goal_time_s == 1.0
    action = next(name for name in contract.interfaces if name.endswith("arm_trajectory/follow_joint_trajectory"))
    assert contract.interfaces[action].timeout_s != 1.0
