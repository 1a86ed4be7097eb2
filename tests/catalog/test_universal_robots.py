"""Each model of the family has the kinematics, inertias, reach and joints of its vendor."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest

from cellc.compiler.catalog.compiled import compiled_device
from cellc.compiler.catalog.load import CatalogDevice, device_names, load_device
from tests.cells import catalog_facts
from tests.foreign_yaml import safe_load
from tests.oracles import here
from tests.vendors.oracle import RELEASES, Release, facts

TABLE = Path(__file__).with_name("universal_robots.yaml")
PUBLISHED: dict[str, dict[str, Any]] = safe_load(TABLE.read_text(encoding="utf-8"))
MODELS = sorted(PUBLISHED)
POSITIONS = np.array([0.3, -1.1, 1.4, -0.7, 0.9, -0.4])
# facts/robots.md, section 1: the driver's order.
JOINTS = [f"{name}_joint" for name in ("shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3")]


@cache
def _robot(model: str) -> Any:
    compiled = compiled_device(model)
    assert compiled is not None
    return pinocchio.buildModelFromXML(compiled[1])


def _configuration(model: str) -> Any:
    """Return the joints' positions as pinocchio has them: a continuous joint is a cosine and a sine."""
    last = POSITIONS[5]
    return POSITIONS if _robot(model).nq == 6 else np.array([*POSITIONS[:5], np.cos(last), np.sin(last)])


def _device(model: str) -> CatalogDevice:
    device = load_device(model).value
    assert device is not None
    return device


def test_the_table_has_every_model_of_the_family() -> None:
    assert [name for name in device_names() if _device(name).model.family == "ur"] == MODELS


@pytest.mark.parametrize("model", MODELS)
def test_tool_is_where_the_vendors_description_has_it(model: str) -> None:
    robot = _robot(model)
    data = robot.createData()
    pinocchio.framesForwardKinematics(robot, data, _configuration(model))
    base, tool = (data.oMf[robot.getFrameId(frame)] for frame in ("base_link", "tool0"))
    actual = base.actInv(tool)
    x, y, z, *quaternion = PUBLISHED[model]["tool0"]
    np.testing.assert_allclose(actual.translation, [x, y, z], atol=1e-6)
    np.testing.assert_allclose(actual.rotation, pinocchio.Quaternion(np.array(quaternion)).matrix(), atol=1e-6)


@pytest.mark.parametrize("model", MODELS)
def test_links_weigh_what_the_vendor_publishes(model: str) -> None:
    robot, configuration = _robot(model), _configuration(model)
    data = robot.createData()
    np.testing.assert_allclose(
        np.diag(pinocchio.crba(robot, data, configuration)), PUBLISHED[model]["inertia"], rtol=1e-6
    )
    held = pinocchio.computeGeneralizedGravity(robot, data, configuration)
    np.testing.assert_allclose(held, PUBLISHED[model]["gravity"], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_stretched_arm_reaches_as_far_as_the_data_sheet_says(model: str) -> None:
    # The vendor counts from the axis of the base to that of the last joint: at most with wrist 1 turned in line.
    _, upper, fore, _, fifth, _ = (abs(float(one)) for one in _arguments(model)["dh"].split())
    assert upper + fore < PUBLISHED[model]["reach"] <= upper + fore + fifth + 1e-9
    assert f"{PUBLISHED[model]['reach'] * 1000:g} mm reach" in _device(model).model.summary


def _arguments(model: str) -> dict[str, str]:
    arguments: dict[str, str] = catalog_facts(model)["description"]["arguments"]
    return arguments


@pytest.mark.parametrize("model", MODELS)
def test_joints_are_those_of_the_driver_in_its_order(model: str) -> None:
    joints = [joint for joint in _device(model).description.joints if joint.movable]
    assert [joint.name for joint in joints] == JOINTS
    # Only the small one turns its last joint without end: joint_limits.yaml, has_position_limits false.
    assert [joint.type for joint in joints] == ["revolute"] * 5 + ["continuous" if model == "ur3e" else "revolute"]
    assert all(joint.limit is not None and joint.limit.velocity and joint.limit.effort for joint in joints)


@pytest.mark.parametrize("release", here([one for one in RELEASES if one.device == "ur5e"]), ids=str)
def test_each_release_of_the_driver_knows_each_model(release: Release) -> None:
    launch = facts(release, "launch_arguments")["ur_robot_driver/launch/ur_control.launch.py"]
    assert set(MODELS) <= set(launch["ur_type"]["choices"])


@pytest.mark.parametrize("model", MODELS)
def test_real_plugin_is_told_its_own_model(model: str) -> None:
    control = _device(model).model.control
    assert control is not None
    assert control.hardware.real is not None
    told = [release.parameters.get("ur_type", model) for release in control.hardware.real.releases]
    assert set(told) == {model}
