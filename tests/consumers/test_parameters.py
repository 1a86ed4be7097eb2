"""Emitted controller parameters against the declarations of the controllers that read them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.cells import DISTROS
from tests.consumers.declared import complaints
from tests.consumers.matrix import build, every_build
from tests.consumers.parameter_files import sections, told
from tests.consumers.starting import node_name, processes, targets


def controllers(cell: str, distro: str) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield manager, plugin and parameters of every controller as its node is told them."""
    texts = build(cell, distro).texts
    for process in processes(cell, distro, "mock"):
        if process.executable == "ros2_control_node":
            manager = told(texts, process.files, node_name(process))
            for name in [key.removesuffix(".type") for key in manager if key.endswith(".type")]:
                values = told(texts, process.files, f"{process.namespace}/{name}")
                yield f"{process.namespace}/{name}", manager[f"{name}.type"], values


@every_build
def test_controllers_declare_what_they_are_told_and_are_told_what_they_need(cell: str, distro: str) -> None:
    found = list(controllers(cell, distro))
    assert found
    for name, plugin, values in found:
        assert complaints(distro, plugin, values) == [], name
        if "GripperAction" in plugin and "state_interfaces" in values:
            assert values["state_interfaces"] == ["position", "velocity"]  # it stalls by velocity
        if "GripperAction" in plugin:
            # OBSERVED.md, 4: a goal that meets a part before it is reached is aborted otherwise, and so is each grasp.
            assert values["allow_stalling"] is True, name


@every_build
def test_manager_declares_what_it_is_told(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    for process in processes(cell, distro, "mock"):
        if process.executable == "ros2_control_node":
            values = told(texts, process.files, node_name(process))
            own = {name: value for name, value in values.items() if not name.endswith(".type")}
            assert complaints(distro, "controller_manager", own) == []
            assert own["update_rate"] > 0


@every_build
def test_every_section_belongs_to_a_node_that_runs(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    nodes = {node_name(process) for process in processes(cell, distro, "real")}
    nodes |= {name for name, _, _ in controllers(cell, distro)}
    nodes |= {"/mujoco_ros2_control_node"}  # of the plugin, in the process of the manager
    for path, text in texts.items():
        if path.startswith("config/") and "ros__parameters:" in text:
            named = {key for key in sections(text) if not key.startswith("/**")}
            assert named <= nodes, path
            every = targets(build(cell, distro))
            started = [process for target in every for process in processes(cell, distro, target)]
            read = {node_name(one) for one in started if path in one.files}
            assert {node_name(one) for one in started} & named <= read, path


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("constraints.goal_time", 1, "double"),
        ("constraints.goal_time", -1.0, "gt_eq"),
        ("constraints.goaltime", 1.0, "not declared"),
        ("joints", [], "joints"),
        ("joints", ["a", "a"], "unique"),
        ("joints", "a", "string_array"),
        ("command_interfaces", ["acceleration"], "combinations"),
        ("command_interfaces", ["positions"], "subset_of"),
        ("state_interfaces", ["velocity"], "combinations"),
        ("interpolation_method", "cubic", "one_of"),
        ("action_monitor_rate", 0.0, "gt_eq"),
    ],
)
def test_checker_says_what_the_trajectory_controller_says(distro: str, name: str, value: Any, said: str) -> None:
    good = {"joints": ["a", "b"], "command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
    plugin = "joint_trajectory_controller/JointTrajectoryController"
    assert complaints(distro, plugin, good | {"constraints.a.goal": 0.1, "gains.b.p": 1.0}) == []
    (complaint, *_) = complaints(distro, plugin, good | {name: value})
    assert name in complaint
    assert said in complaint


def test_checker_asks_for_what_has_no_default() -> None:
    plugin = "forward_command_controller/ForwardCommandController"
    assert complaints("kilted", plugin, {"joints": ["a"]}) == ["interface_name is not given"]
    gripper = "parallel_gripper_action_controller/GripperActionController"
    assert complaints("kilted", gripper, {}) == ["joint is not given"]
