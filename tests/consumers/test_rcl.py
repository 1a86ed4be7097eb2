"""Emitted parameter files through the real parser of ROS 2: what a node of the right name is told, with types.

Needs the extra ``ros``. A program of its own reads the files, see ``ros_parameters.py``.
"""

from __future__ import annotations

import importlib.util
import json
import subprocess
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from tests.cells import DISTROS
from tests.consumers.declared import match
from tests.consumers.matrix import HERE, SPECS, build, every_build
from tests.consumers.parameter_files import told
from tests.consumers.starting import node_name, processes

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("rclpy") is None, reason="rclpy is not installed: the extra `ros` brings it"
)

Told = dict[str, tuple[str, Any]]

_DECLARED = {
    "bool": "BOOL",
    "int": "INTEGER",
    "double": "DOUBLE",
    "string": "STRING",
    "string_array": "STRING_ARRAY",
    "double_array": "DOUBLE_ARRAY",
}
# launch_moveit.md 5.3: what move_group declares, by the end of the name.
_OF_MOVEIT = {
    "max_position": "DOUBLE",
    "min_position": "DOUBLE",
    "max_velocity": "DOUBLE",
    "max_acceleration": "DOUBLE",
    "max_jerk": "DOUBLE",
    "has_acceleration_limits": "BOOL",
    "default_velocity_scaling_factor": "DOUBLE",
    "max_trans_vel": "DOUBLE",
    "max_trans_acc": "DOUBLE",
    "max_trans_dec": "DOUBLE",
    "max_rot_vel": "DOUBLE",
    "kinematics_solver": "STRING",
    "kinematics_solver_timeout": "DOUBLE",
    "kinematics_solver_search_resolution": "DOUBLE",
    "planning_pipelines": "STRING_ARRAY",
    "planning_plugins": "STRING_ARRAY",
    "planning_plugin": "STRING",
    "capabilities": "STRING",
    "controller_names": "STRING_ARRAY",
    "joints": "STRING_ARRAY",
    "action_ns": "STRING",
    "default": "BOOL",
    "longest_valid_segment_fraction": "DOUBLE",
    "allowed_execution_duration_scaling": "DOUBLE",
    "allowed_goal_duration_margin": "DOUBLE",
    "allowed_start_tolerance": "DOUBLE",
    "execution_duration_monitoring": "BOOL",
    "publish_planning_scene": "BOOL",
    "start_state_max_bounds_error": "DOUBLE",
}
# rclpy declares these for every node.
_OF_EVERY_NODE = {"use_sim_time", "start_type_description_service"}


def _nodes(cell: str, distro: str) -> list[tuple[str, tuple[str, ...], str]]:
    """Return every node of a cell with its parameter files and, of a controller, its plugin."""
    texts = build(cell, distro).texts
    nodes: list[tuple[str, tuple[str, ...], str]] = []
    for process in processes(cell, distro, "real"):
        if process.files:
            nodes.append((node_name(process), process.files, ""))
        if process.executable == "ros2_control_node":
            types = told(texts, process.files, node_name(process))
            nodes += [
                (f"{process.namespace}/{key.removesuffix('.type')}", process.files, plugin)
                for key, plugin in types.items()
                if key.endswith(".type")
            ]
    return nodes


@lru_cache(maxsize=1)
def _answers(folder: Path) -> dict[tuple[str, str, str], Told]:
    """Ask the real parser for every node of every build, in one process."""
    asked: list[tuple[str, str, str]] = []
    requests: list[dict[str, object]] = []
    for cell, distro in [(cell, distro) for cell in SPECS for distro in DISTROS]:
        place = folder / cell / distro
        for path, text in build(cell, distro).texts.items():
            (place / path).parent.mkdir(parents=True, exist_ok=True)
            (place / path).write_text(text, encoding="utf-8")
        for node, files, _ in _nodes(cell, distro):
            namespace, _, name = node.rpartition("/")
            asked.append((cell, distro, node))
            requests.append({"name": name, "namespace": namespace, "files": [str(place / file) for file in files]})
    run = subprocess.run(
        [sys.executable, str(HERE / "ros_parameters.py")], input=json.dumps(requests), text=True, capture_output=True
    )
    assert run.returncode == 0, run.stderr[-2000:]
    return dict(zip(asked, json.loads(run.stdout), strict=True))


@pytest.fixture(scope="module")
def answers(tmp_path_factory: pytest.TempPathFactory) -> dict[tuple[str, str, str], Told]:
    """What every node of every build is told, by the real parser."""
    return _answers(tmp_path_factory.mktemp("parameters"))


@every_build
def test_every_node_is_told_what_its_files_say(
    cell: str, distro: str, answers: dict[tuple[str, str, str], Told]
) -> None:
    for node, files, _ in _nodes(cell, distro):
        real = {name: value for name, (_, value) in answers[cell, distro, node].items() if name not in _OF_EVERY_NODE}
        assert real == told(build(cell, distro).texts, files, node), node
        # A broadcaster may live on defaults; any other node has its file because it is told something.
        assert real or "joint_state" in node


@every_build
def test_controllers_are_told_values_of_the_declared_types(
    cell: str, distro: str, answers: dict[tuple[str, str, str], Told]
) -> None:
    for node, _, plugin in _nodes(cell, distro):
        for name, (kind, value) in answers[cell, distro, node].items() if plugin else ():
            if name not in _OF_EVERY_NODE:
                parameter = match(distro, plugin, name)
                assert parameter is not None, f"{node}: {name}"
                assert kind == _DECLARED[parameter.type], f"{node}: {name} = {value!r}"


@every_build
def test_move_group_is_told_values_of_its_types(
    cell: str, distro: str, answers: dict[tuple[str, str, str], Told]
) -> None:
    if (cell, distro, "/move_group") not in answers:
        assert "move_group" not in SPECS[cell].read_text(encoding="utf-8")
        return
    found = answers[cell, distro, "/move_group"]
    ends = {name: name.rpartition(".")[2] for name in found}
    assert {name: kind for name, (kind, _) in found.items() if ends[name] in _OF_MOVEIT} == {
        name: _OF_MOVEIT[end] for name, end in ends.items() if end in _OF_MOVEIT
    }
    assert {"max_acceleration", "kinematics_solver", "controller_names", "planning_pipelines"} <= set(ends.values())


def test_integer_where_a_double_is_due_is_seen_by_the_real_parser(tmp_path: Path) -> None:
    # The proof that this test can fail: one decimal point less, and the type that arrives is another.
    (tmp_path / "p.yaml").write_text('a:\n  ros__parameters: {goal_time: 1, rate: 1.0, v: "010"}\n', encoding="utf-8")
    request = {"name": "a", "namespace": "", "files": [str(tmp_path / "p.yaml")]}
    other = {"name": "a", "namespace": "/cell", "files": [str(tmp_path / "p.yaml")]}
    run = subprocess.run(
        [sys.executable, str(HERE / "ros_parameters.py")],
        input=json.dumps([request, other]),
        text=True,
        capture_output=True,
        check=True,
    )
    plain, namespaced = json.loads(run.stdout)
    assert (plain["goal_time"], plain["rate"], plain["v"]) == (["INTEGER", 1], ["DOUBLE", 1.0], ["STRING", "010"])
    assert "rate" not in namespaced
