"""The MoveIt configuration against the keys that move_group reads and the controllers that the cell has."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from cellc.compiler.deploy.files import PARAMETER_FILES
from tests.cells import DISTROS, spec_text
from tests.emit.cells import artifacts_of, emitted
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


def _called(folder: Path, client: str, distro: str = "jazzy") -> dict[str, Any]:
    """Return what move_group calls where a node is the client of the gripper."""
    text = spec_text("ur5e_pick").replace("device: gripper, client: task}", f"device: gripper, client: {client}}}")
    found = emitted(folder, text.replace("ros: jazzy", f"ros: {distro}"))["config/moveit/controllers.yaml"]
    (section,) = safe_load(found).values()
    called: dict[str, Any] = section["ros__parameters"]["moveit_simple_controller_manager"]
    return called


def test_action_types_follow_the_distribution(tmp_path: Path) -> None:
    # ParallelGripperCommand is new in Jazzy; before, the controller serves GripperCommand.
    types = {d: _called(tmp_path, "move_group", d)["gripper_action"]["type"] for d in DISTROS}
    assert types == dict.fromkeys(DISTROS, "ParallelGripperCommand") | {"humble": "GripperCommand"}


def test_move_group_calls_no_controller_that_another_node_commands(tmp_path: Path) -> None:
    # It makes a client of each as it starts (moveit2, trajectory_execution_manager.cpp): a second one at the action,
    # and one that an enforced policy, which grants it to the declared client alone, refuses.
    assert _called(tmp_path, "task")["controller_names"] == ["arm_trajectory"]
    assert "gripper_action" not in _called(tmp_path, "task")


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


def _planning(text: str, distro: str, folder: Path) -> dict[str, Any]:
    """Return what move_group is told of a cell whose spec says something else of planning, and its dependencies."""
    spec = spec_text("ur5e_pick").replace("groups: {manipulator: {base: arm/base_link, tip: tcp}}", text)
    assert text in spec
    texts = emitted(folder, spec.replace("ros: jazzy", f"ros: {distro}"))
    (told,) = safe_load(texts["config/moveit/move_group.yaml"]).values()
    (solved,) = safe_load(texts["config/moveit/kinematics.yaml"]).values()
    package = ElementTree.fromstring(texts["package.xml"])
    needed = {exec_depend.text: exec_depend.get("version_gte") for exec_depend in package.findall("exec_depend")}
    return {**told["ros__parameters"], **solved["ros__parameters"], "needed": needed}


def test_a_group_gets_the_solver_and_the_planner_that_its_spec_names(tmp_path: Path) -> None:
    group = "groups: {manipulator: {base: arm/base_link, tip: tcp, ik: pick_ik, ik_timeout: 20 ms, planner: RRTstar}}"
    told = _planning(group, "jazzy", tmp_path)
    solver = told["robot_description_kinematics"]["manipulator"]
    # pick_ik 1.1.2: pick_ik_kinematics_description.xml, src/pick_ik_parameters.yaml
    assert (solver["kinematics_solver"], solver["mode"]) == ("pick_ik/PickIkPlugin", "global")
    assert solver["kinematics_solver_timeout"] == 0.02
    (planner,) = told["ompl"]["manipulator"]["planner_configs"]
    assert told["ompl"]["manipulator"]["default_planner_config"] == planner
    assert told["ompl"]["planner_configs"][planner]["type"] == "geometric::RRTstar"
    # It has a version of its own, which is not that of MoveIt.
    assert told["needed"]["pick_ik"] is None
    assert "moveit_kinematics" not in told["needed"]


@pytest.mark.parametrize("distro", ["humble", "jazzy"])
def test_the_first_pipeline_is_the_default_and_each_brings_what_it_is_made_of(distro: str, tmp_path: Path) -> None:
    told = _planning(
        "groups: {manipulator: {base: arm/base_link, tip: tcp}}\n  pipelines: [ompl, chomp]", distro, tmp_path
    )
    assert told["planning_pipelines"] == ["ompl", "chomp"]
    assert told["default_planning_pipeline"] == "ompl"
    # Sequences are a capability of the industrial planner.
    assert "capabilities" not in told
    # moveit2 2.12.4 and 2.5.9: moveit_configs_utils/default_configs/chomp_planning.yaml
    plugin = told["chomp"]["planning_plugin" if distro == "humble" else "planning_plugins"]
    assert plugin in ("chomp_interface/CHOMPPlanner", ["chomp_interface/CHOMPPlanner"])
    assert told["chomp"]["ridge_factor"] == 0.01
    timed = told["chomp"]["request_adapters" if distro == "humble" else "response_adapters"]
    assert "AddTimeOptimalParameterization" in "".join(timed)
    assert {"moveit_planners_chomp", "moveit_planners_ompl"} <= set(told["needed"])
    assert "pilz_industrial_motion_planner" not in told["needed"]


def test_rviz_shows_the_cell_and_offers_nothing_that_commands() -> None:
    shown = safe_load(artifacts_of("ur5e_pick")["config/cell.rviz"])["Visualization Manager"]
    classes = [one["Class"] for one in (*shown["Displays"], *shown["Tools"])]
    assert {"rviz_default_plugins/RobotModel", "moveit_rviz_plugin/PlanningScene"} <= set(classes)
    # moveit2, motion_planning_rviz_plugin: it plans and executes; rviz_default_plugins: these tools publish.
    forbidden = (
        "moveit_rviz_plugin/MotionPlanning",
        "rviz_default_plugins/SetGoal",
        "rviz_default_plugins/SetInitialPose",
    )
    assert not set(forbidden) & set(classes)
    topics = [one["Topic"]["Value"] for one in shown["Displays"] if one["Class"].endswith("/Image")]
    assert topics == ["/camera/color/image_raw"]
    assert shown["Global Options"]["Fixed Frame"] == "world"
