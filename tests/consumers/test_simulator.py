"""The target ``sim``: the plugin of MuJoCo finds what it is given, and nothing that is started there is real."""

from __future__ import annotations

import importlib.util
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from xml.etree.ElementTree import Element, fromstring

import pytest
import xacro

from tests.cells import DISTROS, EVERY_CELL, built, graph_of, spec_text, written
from tests.consumers.declared import complaints
from tests.consumers.launch_interpreter import Launch, Process
from tests.consumers.launch_text import LaunchError
from tests.consumers.matrix import HERE, SPECS, Build, build
from tests.consumers.mujoco_plugin import Plugin, started
from tests.consumers.parameter_files import sections, told
from tests.consumers.refused_parameters import claimed, read
from tests.consumers.starting import launched, proven
from tests.emit.cells import contract_data, emitted_graph

SIMULATED = tuple(cell for cell in EVERY_CELL if "targets: {sim:" in spec_text(cell))
PLUGIN_NODE = "/mujoco_ros2_control_node"
_ADDRESS = re.compile(r"\b\d+\.\d+\.\d+\.\d+\b|/dev/\w+")

every_simulation = pytest.mark.parametrize(
    ("cell", "distro"),
    [
        (cell, distro)
        for cell in SIMULATED
        for distro in DISTROS
        if cell in SPECS or f"ros: {distro}" in spec_text(cell)
    ],
)


def _build(cell: str, distro: str) -> Build:
    if cell in SPECS:
        return build(cell, distro)
    whole = built(cell)
    return Build(whole.graph, whole.artifacts, cell, distro)


def _launches(cell: str, distro: str) -> list[Launch]:
    whole = _build(cell, distro)
    return [
        launched(whole, file, target="sim", **more) for file, more in (("cell", {"headless": "true"}), ("move", {}))
    ]


def _processes(cell: str, distro: str) -> list[Process]:
    return [process for launch in _launches(cell, distro) for process in launch.processes]


def _manager(cell: str, distro: str) -> Process:
    (manager,) = [process for process in _processes(cell, distro) if process.executable == "ros2_control_node"]
    return manager


def tag_of(whole: Build, folder: Path, headless: str = "true") -> Element:
    """Return the tag of the simulator as the real xacro expands the description of an installed package."""
    for path in ("sim/scene.xml", f"urdf/{whole.cell}.sim.urdf"):
        (folder / path).parent.mkdir(exist_ok=True)
        text = whole.texts[path].replace(f"$(find {whole.cell})", str(folder))
        (folder / path).write_text(text, encoding="utf-8")
    expanded = xacro.process_file(str(folder / f"urdf/{whole.cell}.sim.urdf"), mappings={"headless": headless})
    (tag,) = fromstring(expanded.toxml()).findall("ros2_control")
    return tag


def test_simulated_cells_are_of_every_kind() -> None:
    assert {"fr3_hand", "gen3_2f", "openarm_bimanual", "rail_arm", "ur5e_pick"} == set(SIMULATED)


@every_simulation
def test_plugin_starts_without_an_error(cell: str, distro: str, tmp_path: Path) -> None:
    whole = _build(cell, distro)
    plugin = started(tag_of(whole, tmp_path))
    assert plugin.said == []
    assert plugin.headless
    assert plugin.keyframe == ("start" if cell == "openarm_bimanual" else "home")
    assert not started(tag_of(whole, tmp_path, "false")).headless


@every_simulation
def test_controllers_that_are_spawned_take_what_the_plugin_exports(cell: str, distro: str, tmp_path: Path) -> None:
    whole = _build(cell, distro)
    plugin, manager = started(tag_of(whole, tmp_path)), _manager(cell, distro)
    (spawner,) = [process for process in _processes(cell, distro) if process.executable == "spawner"]
    names = spawner.arguments[: spawner.arguments.index("-c")]
    types = told(whole.texts, manager.files, "/controller_manager")
    assert sorted(names) == sorted(key.removesuffix(".type") for key in types if key.endswith(".type"))
    moved = set[str]()
    for name in names:
        values = told(whole.texts, manager.files, f"/{name}")
        assert set(claimed(values)) <= plugin.commands, name
        assert {one.removesuffix(" (state)") for one in read(values)} <= plugin.states, name
        assert complaints(distro, types[f"{name}.type"], values) == [], name
        moved |= {one.rpartition("/")[0] for one in claimed(values)}
    # Every joint that an actuator of the scene moves has a controller, as on the robot.
    assert moved == {one.rpartition("/")[0] for one in plugin.commands}


@every_simulation
def test_nothing_that_is_started_is_a_driver_or_is_told_where_a_device_is(cell: str, distro: str) -> None:
    whole = _build(cell, distro)
    for launch in _launches(cell, distro):
        assert launch.commands == []
        for process in launch.processes:
            values = [value for value, _ in process.values.values()]
            everything = "\n".join([*process.arguments, *values, *(whole.texts[file] for file in process.files)])
            assert not _ADDRESS.findall(everything), process
            assert set(re.findall(r"<plugin>(.*?)</plugin>", everything)) <= {
                "mujoco_ros2_control/MujocoSystemInterface"
            }
            assert process.package not in _driver_packages(whole), process


def _driver_packages(whole: Build) -> set[str]:
    """Return the packages whose programs the real target alone starts, beside those that both start."""
    real = fromstring(whole.texts["launch/cell.launch.xml"]).findall("node")
    return {node.attrib["pkg"] for node in real if "'real'" in node.get("if", "")} - {whole.cell, "controller_manager"}


@every_simulation
def test_every_process_has_the_time_of_the_simulation(cell: str, distro: str) -> None:
    whole = _build(cell, distro)
    assert _processes(cell, distro)
    for process in _processes(cell, distro):
        assert process.values["use_sim_time"] == ("true", ""), process
        # Files of a node come after what is set for all: none says otherwise.
        said = [values for file in process.files for values in sections(whole.texts[file]).values()]
        assert not [values for values in said if "use_sim_time" in values]
    for file in ("cell", "move"):
        assert not [one for one in launched(whole, file).processes if "use_sim_time" in one.values]


@every_simulation
def test_the_manager_runs_in_the_program_of_the_simulator(cell: str, distro: str) -> None:
    manager = _manager(cell, distro)
    assert (manager.package, manager.name) == ("mujoco_ros2_control", None)
    assert manager.remaps["~/robot_description"] == "/robot_description"
    (publisher,) = [one for one in _processes(cell, distro) if one.executable == "robot_state_publisher"]
    description = publisher.values["robot_description"][0]
    assert '<param name="headless">true</param>' in description
    if distro == "humble":
        assert manager.values["robot_description"][0] == description
    for target in ("mock", "real"):
        assert "mujoco" not in _build(cell, distro).texts[f"urdf/{cell}.{target}.urdf"]


@every_simulation
def test_steps_ask_for_what_is_spawned_and_for_the_one_component(cell: str, distro: str) -> None:
    whole = _build(cell, distro)
    plan = json.loads(whole.texts["config/bring_up.json"])
    (spawner,) = [process for process in _processes(cell, distro) if process.executable == "spawner"]
    spawned = set(spawner.arguments[: spawner.arguments.index("-c")])
    proofs = [proof for step in proven(plan, "sim") for proof in (*step["proof"], *step.get("effect", ()))]
    assert {proof["controller"] for proof in proofs if proof["kind"] == "controller"} == spawned
    assert {proof["component"] for proof in proofs if proof["kind"] == "hardware"} == {"simulator"}
    assert {plugin for proof in proofs if proof["kind"] == "mock" for plugin in proof["plugins"]} == {
        "mujoco_ros2_control/MujocoSystemInterface"
    }
    assert [step["phase"] for step in plan["sim"]][-1] == "move"
    taken = [process.arguments for process in _processes(cell, distro) if process.executable == "bring_up"]
    assert all(words[words.index("--target") + 1] == "sim" for words in taken)
    for process in launched(whole, "move", target="sim").processes:
        assert process.prefix[-4:] == ("--target", "sim", "move", "--")


@every_simulation
def test_cameras_publish_on_topics_in_frames_and_at_rates_of_the_contract(
    cell: str, distro: str, tmp_path: Path
) -> None:
    whole = _build(cell, distro)
    values = told(whole.texts, _manager(cell, distro).files, PLUGIN_NODE)
    plugin = started(tag_of(whole, tmp_path))
    assert bool(values) == bool(plugin.cameras) == (cell == "ur5e_pick")
    if not values:
        return
    prefix = "mujoco_plugins.mujoco_camera_plugin."
    assert values[f"{prefix}type"] == "mujoco_ros2_control_plugins/CameraPlugin"
    contract = contract_data(whole.texts["contract.json"])
    published = {}
    for camera in plugin.cameras:
        assert values[f"{prefix}{camera}.frame_name"] == camera
        for kind in ("image_topic", "depth_topic"):
            if f"{prefix}{camera}.{kind}" in values:
                published[values[f"{prefix}{camera}.{kind}"]] = camera
    # Frames and topics of realsense2_camera 4.58 for a camera that is called `camera`.
    assert published == {
        "/camera/color/image_raw": "camera_color_optical_frame",
        "/camera/depth/image_rect_raw": "camera_depth_optical_frame",
    }
    asked = {name: one for name, one in contract["interfaces"].items() if name in published}
    assert asked
    assert all(values[f"{prefix}camera_publish_rate"] == one["rate_hz"] for one in asked.values())


def _without_rclpy() -> bool:
    return importlib.util.find_spec("rclpy") is None


@pytest.mark.skipif(_without_rclpy(), reason="rclpy is not installed: the extra `ros` brings it")
def test_real_parser_tells_manager_and_cameras_what_the_file_says(tmp_path: Path) -> None:
    asked: list[tuple[Build, str]] = []
    requests: list[dict[str, object]] = []
    for cell in SIMULATED:
        whole = _build(cell, next(distro for distro in DISTROS if f"ros: {distro}" in spec_text(cell)))
        path = tmp_path / f"{cell}.yaml"
        path.write_text(whole.texts["config/controllers.sim.yaml"], encoding="utf-8")
        for node in sections(path.read_text(encoding="utf-8")):
            asked.append((whole, node))
            requests.append({"name": node.removeprefix("/"), "namespace": "", "files": [str(path)]})
    run = subprocess.run(
        [sys.executable, str(HERE / "ros_parameters.py")], input=json.dumps(requests), text=True, capture_output=True
    )
    assert run.returncode == 0, run.stderr[-2000:]
    for (whole, node), answer in zip(asked, json.loads(run.stdout), strict=True):
        said = told(whole.texts, ("config/controllers.sim.yaml",), node)
        heard = {name: value for name, (_, value) in answer.items() if name in said}
        assert heard == said
        if node == PLUGIN_NODE:
            assert answer["mujoco_plugins.mujoco_camera_plugin.camera_publish_rate"][0] == "DOUBLE"


@pytest.mark.parametrize("cell", sorted(set(EVERY_CELL) - set(SIMULATED)))
def test_a_cell_that_does_not_ask_has_no_simulator(cell: str) -> None:
    texts = built(cell).texts
    assert not [path for path in texts if ".sim." in path]
    assert not [path for path, text in texts.items() if "mujoco_ros2_control" in text]
    with pytest.raises(LaunchError, match="'target' is 'sim'"):
        launched(Build(built(cell).graph, built(cell).artifacts, cell, ""), target="sim")


@contextmanager
def _changed(cell: str, path: str, old: str, new: str) -> Iterator[Build]:
    whole = build(cell, "jazzy")
    assert old in whole.texts[path], old
    artifacts = tuple(
        type(one)(one.path, one.text.replace(old, new), one.executable) if one.path == path else one
        for one in whole.artifacts
    )
    yield Build(whole.graph, artifacts, cell, "jazzy")


@pytest.mark.parametrize(
    ("path", "old", "new", "said"),
    [
        (
            "sim/scene.xml",
            'position name="arm_elbow_joint" joint="arm_elbow_joint" kp="14000" kv="280"',
            'motor name="arm_elbow_joint" joint="arm_elbow_joint"',
            "arm_elbow_joint/position is not supported with a motor actuator",
        ),
        (
            "urdf/ur5e_pick.sim.urdf",
            '<joint name="arm_elbow_joint">\n      <command_interface name="position"/>',
            '<joint name="arm_elbow_joint">\n      <command_interface name="velocity"/>',
            "arm_elbow_joint/velocity is not supported with a position actuator",
        ),
        ("sim/scene.xml", "arm_tcp_fts_sensor_torque", "torque", "no sensor arm_tcp_fts_sensor_torque"),
        ("sim/scene.xml", '<key name="home"', '<key name="start"', "no keyframe home"),
        ("urdf/ur5e_pick.sim.urdf", "sim/scene.xml", "sim/other.xml", "MuJoCo model file does not exist"),
    ],
)
def test_what_the_plugin_complains_of_is_heard(path: str, old: str, new: str, said: str, tmp_path: Path) -> None:
    with _changed("ur5e_pick", path, old, new) as whole:
        plugin: Plugin = started(tag_of(whole, tmp_path))
    assert plugin.said == [said]


def test_a_controller_of_effort_is_left_out_and_a_stock_one_stands_in(tmp_path: Path) -> None:
    text = spec_text("fr3_hand")
    effort = text.replace(
        "{type: joint_trajectory, device: arm,", "{type: joint_trajectory, device: arm, command_interfaces: [effort],"
    )
    assert effort != text
    texts = emitted_graph(graph_of(written(tmp_path, effort)))
    assert "arm_trajectory" not in texts["config/controllers.sim.yaml"]
    stock = sections(build("ur5e_pick", "jazzy").texts["config/controllers.sim.yaml"])
    assert (
        stock["/controller_manager"]["arm_trajectory.type"] == "joint_trajectory_controller/JointTrajectoryController"
    )
    kilted = sections(build("ur5e_pick", "kilted").texts["config/controllers.sim.yaml"])
    assert not [name for name in kilted["/arm_trajectory"] if name.startswith("speed_scaling")]
    on_mock = sections(build("ur5e_pick", "kilted").texts["config/controllers.yaml"])
    assert "speed_scaling.state_interface" in on_mock["/arm_trajectory"]
