"""The MoveIt configuration against the keys that move_group reads and the controllers that the cell has."""

from __future__ import annotations

from itertools import combinations
from typing import Any
from xml.etree import ElementTree

import pytest

from cellc.deploy.files import PARAMETER_FILES
from tests.cells import DISTROS
from tests.emit.cells import artifacts_of
from tests.foreign_yaml import safe_load


def _parameters(distro: str = "jazzy") -> dict[str, Any]:
    """Merge the files as one node that is started with all of them does."""
    merged: dict[str, Any] = {}
    for file in PARAMETER_FILES:
        (section,) = safe_load(artifacts_of("ur5e_pick", distro)[file]).values()
        for key, value in section["ros__parameters"].items():
            if isinstance(value, dict):
                assert not set(merged.get(key, {})) & set(value)
                merged[key] = merged.get(key, {}) | value
            else:
                assert key not in merged
                merged[key] = value
    return merged


def _srdf() -> ElementTree.Element:
    return ElementTree.fromstring(artifacts_of("ur5e_pick")["config/moveit/ur5e_pick.srdf"])


@pytest.mark.parametrize("distro", DISTROS)
def test_every_called_controller_is_one_of_the_cell(distro: str) -> None:
    sections = safe_load(artifacts_of("ur5e_pick", distro)["config/controllers.yaml"])
    called = _parameters(distro)["moveit_simple_controller_manager"]
    for name in called.pop("controller_names"):
        entry = called.pop(name)
        own = sections[name]["ros__parameters"]
        assert entry["joints"] == own.get("joints", [own.get("joint")])
    assert called == {}


def test_action_types_follow_the_distribution() -> None:
    # ParallelGripperCommand is new in Jazzy; before, the controller serves GripperCommand.
    types = {d: _parameters(d)["moveit_simple_controller_manager"]["gripper_action"]["type"] for d in DISTROS}
    assert types == dict.fromkeys(DISTROS, "ParallelGripperCommand") | {"humble": "GripperCommand"}


@pytest.mark.parametrize("distro", DISTROS)
def test_pipelines_use_the_keys_of_the_distribution(distro: str) -> None:
    for name in ("ompl", "pilz_industrial_motion_planner"):
        keys = set(_parameters(distro)[name])
        assert ("planning_plugin" in keys) is (distro == "humble")
        assert ("planning_plugins" in keys) is (distro != "humble")
        assert ("response_adapters" in keys) is (distro != "humble")


def test_every_active_joint_has_an_acceleration_limit() -> None:
    # Without one time parameterization fails for the whole trajectory.
    limits = _parameters()["robot_description_planning"]["joint_limits"]
    assert len(limits) == 7
    assert all(limit["has_acceleration_limits"] and limit["max_acceleration"] > 0.0 for limit in limits.values())


def test_speed_scaling_is_not_taken_for_a_stall() -> None:
    assert _parameters()["trajectory_execution"]["execution_duration_monitoring"] is False


def test_semantic_description_names_what_the_description_has() -> None:
    # srdfdom only logs an unknown name and drops the entry.
    robot = ElementTree.fromstring(artifacts_of("ur5e_pick")["urdf/ur5e_pick.real.urdf"])
    links = {link.get("name") for link in robot.findall("link")}
    joints = {joint.get("name") for joint in robot.findall("joint")}
    srdf = _srdf()
    assert srdf.get("name") == robot.get("name")
    for tag, attributes, known in (
        ("group/chain", ("base_link", "tip_link"), links),
        ("group/joint", ("name",), joints),
        ("group_state/joint", ("name",), joints),
        ("end_effector", ("parent_link",), links),
        ("disable_collisions", ("link1", "link2"), links),
    ):
        entries = srdf.findall(tag)
        assert entries
        assert {entry.get(name) for entry in entries for name in attributes} <= known


def test_disabled_pairs_have_the_reasons_of_the_setup_assistant() -> None:
    pairs = {
        frozenset((p.attrib["link1"], p.attrib["link2"])): p.get("reason")
        for p in _srdf().findall(".//disable_collisions")
    }
    assert pairs[frozenset(("arm_upper_arm_link", "arm_forearm_link"))] == "Adjacent"
    assert pairs[frozenset(("arm_wrist_3_link", "gripper_base_link"))] == "Adjacent"  # bolted, frames between
    assert pairs[frozenset(("arm_base_link_inertia", "table"))] == "Always"  # stands on it
    assert pairs[frozenset(("camera_link", "gripper_base_link"))] == "Never"
    moving = ("arm_upper_arm_link", "arm_wrist_2_link", "table", "arm_base_link_inertia")
    kept = {frozenset(pair) for pair in combinations(moving, 2)} - {frozenset(("table", "arm_base_link_inertia"))}
    assert not kept & set(pairs)
