"""What `ros2 launch` does with the emitted launch files, by an interpreter that cellc knows nothing of."""

from __future__ import annotations

import re
import sys
from fnmatch import fnmatch
from xml.etree.ElementTree import fromstring

import pytest

from tests.consumers.launch_interpreter import Process
from tests.consumers.launch_text import LaunchError
from tests.consumers.matrix import build, every_build, every_cell
from tests.consumers.parameter_files import told
from tests.consumers.refused_parameters import claimed, interfaces
from tests.consumers.starting import (
    CONFIRMED,
    bring_ups,
    hosts,
    launched,
    moves,
    node_name,
    processes,
    spawners,
    targets,
    written,
    written_managers,
)
from tests.emit.cells import contract_data

TARGETS = ("mock", "real")
# ros2_control.md 4: where the plugin's name does not begin with its package's.
_PACKAGES = {
    "parallel_gripper_action_controller/GripperActionController": "parallel_gripper_controller",
    "position_controllers/GripperActionController": "gripper_controllers",
}
# The packages of moveit2 and its pipelines that hold these plugins, by their plugin descriptions (2.12.3).
_PACKAGES_OF_MOVEIT = {
    "kdl_kinematics_plugin": "moveit_kinematics",
    "ompl_interface": "moveit_planners_ompl",
    "pilz_industrial_motion_planner": "pilz_industrial_motion_planner",
    "moveit_simple_controller_manager": "moveit_simple_controller_manager",
    # Of moveit_ros_planning, which comes with the node that loads them.
    "default_planning_request_adapters": "moveit_ros_move_group",
    "default_planner_request_adapters": "moveit_ros_move_group",
    "default_planning_response_adapters": "moveit_ros_move_group",
}
_ADDRESS = re.compile(r"\b\d+\.\d+\.\d+\.\d+\b|/dev/\w+")


def _told(process: Process, texts: dict[str, str]) -> str:
    """Return everything that a process is started with."""
    values = [value for value, _ in process.values.values()]
    return "\n".join([*process.arguments, *values, *(texts[file] for file in process.files)])


@every_build
def test_real_target_is_refused_without_its_confirmation(cell: str, distro: str) -> None:
    built = build(cell, distro)
    for given in ({"target": "real"}, {"target": "real", "confirm_real": "yes"}, {"target": "reel"}):
        for file in ("cell", *hosts(built)):
            with pytest.raises(LaunchError, match=r"confirm_real|target"):
                launched(built, file, **given)
    assert all(bring_up.processes for bring_up in bring_ups(built, "real"))


@every_build
def test_real_target_is_not_started_from_one_computer_where_it_has_several(cell: str, distro: str) -> None:
    built = build(cell, distro)
    started = [[node_name(process) for process in launch.processes] for launch in bring_ups(built, "real")]
    assert len(started) == max(1, len(hosts(built)))
    if hosts(built):
        with pytest.raises(LaunchError, match="'host' is 'all'"):
            launched(built, **CONFIRMED)
        # Each process once, but for the steps of each computer, and on the mock the same ones in one place.
        own = ("spawner", "/bring_up_start")
        names = [name for names in started for name in names if not name.endswith(own)]
        assert len(set(names)) == len(names)


@every_build
def test_nothing_asks_for_motion_before_a_person_releases_it(cell: str, distro: str) -> None:
    built = build(cell, distro)
    clients = {
        name for name, node in written(cell).get("nodes", {}).items() if node["run"].split("/")[0] == "cell_tasks"
    }
    for target in TARGETS:
        started = {node_name(process) for launch in bring_ups(built, target) for process in launch.processes}
        assert not started & {f"/{name}" for name in clients}
        assert {node_name(move) for move in moves(built, target)} == {f"/{name}" for name in clients}
        assert all(move.prefix[-4:] == ("--target", target, "move", "--") for move in moves(built, target))
    if clients:
        for given in ({"target": "real"}, {"target": "real", "confirm_motion": "yes"}):
            with pytest.raises(LaunchError, match="confirm_motion"):
                launched(built, "move", **given)


@every_build
def test_nothing_on_the_mock_is_told_of_a_real_address_or_plugin(cell: str, distro: str) -> None:
    built = build(cell, distro)
    for process in processes(cell, distro, "mock"):
        told = _told(process, built.texts)
        assert not _ADDRESS.findall(told), process
        plugins = re.findall(r"<plugin>(.*?)</plugin>", told)
        assert set(plugins) <= {"mock_components/GenericSystem"}, process


@every_build
def test_real_target_has_no_mock_hardware_and_the_mock_has_no_driver(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    real = processes(cell, distro, "real")
    assert not [process for process in real if "mock_components" in _told(process, texts)]
    mock = processes(cell, distro, "mock")
    names, on_mock = {node_name(process) for process in real}, {node_name(process) for process in mock}
    # The mock starts and claims in one process; a claim on real hardware is a person's, and is watched.
    assert on_mock - names == {"/bring_up_claim"}
    if cell == "ur5e_pick":
        drivers = {"/arm_dashboard_client", "/arm_state_helper", "/camera"}
        assert names - on_mock == {*drivers, "/bring_up_start", "/claim_watch"}


@pytest.mark.parametrize("target", TARGETS)
def test_processes_of_the_pick_cell_start_in_this_order(target: str) -> None:
    drivers = ["/arm_dashboard_client", "/arm_state_helper", "/camera"] if target == "real" else []
    names = [node_name(process) for process in processes("ur5e_pick", "jazzy", target)]
    nodes = ["/perception", "/move_group"]
    # On real hardware a second spawner brings the controllers that the mock lacks, and the claims are watched.
    real = ["/spawner", "/spawner", "/bring_up_start", "/claim_watch"]
    steps = ["/spawner", "/bring_up_claim"] if target == "mock" else real
    assert names == ["/robot_state_publisher", "/controller_manager", *nodes, *drivers, *steps, "/task"]


@every_build
def test_other_address_than_that_of_the_description_is_refused(cell: str, distro: str) -> None:
    built = build(cell, distro)
    addresses = {name for name in launched(built).descriptions if name.endswith("_address")}
    for name in addresses:
        with pytest.raises(LaunchError, match="not one of"):
            launched(built, **{name: "10.99.99.99"})


@every_build
def test_static_transforms_have_one_authority(cell: str, distro: str) -> None:
    for target in TARGETS:
        started = processes(cell, distro, target)
        assert not [process for process in started if "static_transform_publisher" in process.executable]
        publishers = [process for process in started if process.executable == "robot_state_publisher"]
        whole = [process for process in publishers if not {"/tf", "/tf_static"} <= set(process.remaps)]
        assert [node_name(process) for process in whole] == ["/robot_state_publisher"]
        assert whole[0].values["robot_description"][0] == build(cell, distro).urdf(target)
        assert {process.values["robot_description"][1] for process in publishers} == {"str"}


@every_build
@pytest.mark.parametrize("target", TARGETS)
def test_spawners_follow_the_spec_and_activate_nothing(cell: str, distro: str, target: str) -> None:
    spawned = [process.arguments for process in spawners(cell, distro, target)]
    for namespace, manager in written_managers(cell, distro):
        flag = ("-c", f"{namespace}/controller_manager")
        own = [line for line in spawned if line[line.index("-c") :][:2] == flag]
        names = [name for line in own for name in line[: line.index("-c")]]
        written_ = manager["controllers"]
        order = list(written_)
        wanted = [name for name in order if _has_hardware(cell, distro, target, f"{namespace}/{name}")]
        # What one target alone has is spawned by itself, after what both have.
        assert sorted(names, key=order.index) == wanted
        assert all(list(line[: line.index("-c")]) == [name for name in order if name in line] for line in own)
        # Humble's manager hands its own remaps to its controllers; later ones warn, and ask it of the spawner.
        moved = () if distro == "humble" or not namespace else (f"--remap {namespace}/joint_states:=/joint_states",)
        told = ("--inactive", *(("--controller-ros-args", *moved) if moved else ()))
        assert all(line[line.index("-c") + 2 :] == told for line in own)


def _has_hardware(cell: str, distro: str, target: str, node: str) -> bool:
    """Whether the description of a target offers what a controller claims; broadcasters claim nothing.

    What a device's own controller claims stands in no file that a manager reads: the contract says where it runs.
    """
    texts = build(cell, distro).texts
    contract = contract_data(texts["contract.json"])
    own = (controller for manager in contract["managers"].values() for controller in manager["controllers"].values())
    if any(one["full_name"] == node and target not in one.get("targets", TARGETS) for one in own):
        return False
    managers = [process for process in processes(cell, distro, target) if process.executable == "ros2_control_node"]
    (files,) = [manager.files for manager in managers if manager.namespace == node.rpartition("/")[0]]
    return set(claimed(told(texts, files, node))) <= interfaces(build(cell, distro).urdf(target))


@every_build
def test_each_manager_hears_the_description_of_its_own_hardware(cell: str, distro: str) -> None:
    for target in TARGETS:
        started = processes(cell, distro, target)
        said = {
            process.remaps.get("robot_description", f"{process.namespace}/robot_description"): process
            for process in started
            if process.executable == "robot_state_publisher"
        }
        heard: list[str] = []
        for manager in (process for process in started if process.executable == "ros2_control_node"):
            assert manager.name is None  # it would name the nodes of the hardware too
            topic = manager.remaps.get("robot_description", f"{manager.namespace}/robot_description")
            assert manager.remaps["~/robot_description"] == topic
            description = said[topic].values["robot_description"][0]
            if distro == "humble":
                assert manager.values["robot_description"] == (description, "str")
            heard += [tag.attrib["name"] for tag in fromstring(description).findall("ros2_control")]
        everything = fromstring(build(cell, distro).urdf(target)).findall("ros2_control")
        assert heard == [tag.attrib["name"] for tag in everything]


@every_build
def test_node_names_differ_and_nothing_that_commands_is_started_again(cell: str, distro: str) -> None:
    started = processes(cell, distro, "real")
    names = [node_name(one) for one in started if one.executable not in ("spawner", "bring_up")]
    assert len(set(names)) == len(names)
    assert not [process for process in started if process.respawn]


@every_build
def test_every_parameter_file_is_read_by_a_process(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    parameters = {path for path, text in texts.items() if path.startswith("config/") and "ros__parameters:" in text}
    every = targets(build(cell, distro))
    for target in every:
        read = {file for process in processes(cell, distro, target) for file in process.files}
        assert read <= parameters
        # A driver's own parameters wait for real hardware.
        stages = {path for path in parameters if path.startswith("config/commissioning/")}
        assert read & stages == stages & {f"config/commissioning/stage_{'10' if target == 'real' else '100'}.yaml"}
        others = tuple(f".{other}.yaml" for other in every if other != target)
        assert target != "real" or read | stages == {path for path in parameters if not path.endswith(others)}
        own = {path for path in parameters if path.endswith(f".{target}.yaml")}
        assert own <= read


_BESIDE = {"installed_versions", *(f"observe_{part}" for part in ("checks", "host", "listener", "reports"))}
"""Modules of the package itself, beside its programs."""
_KEYS = {"yaml": "python3-yaml"}
"""Keys of rosdep of what is no package of ROS."""


@every_build
def test_what_is_launched_or_found_is_a_dependency_and_is_installed(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    depends = {tag.text for tag in fromstring(texts["package.xml"]).findall("exec_depend")}
    launch = {process.package for target in targets(build(cell, distro)) for process in processes(cell, distro, target)}
    # The packages that bring `ros2 control`, the other commands, and tf2_echo.
    launch |= {"ros2controlcli", "ros2cli_common_extensions", "tf2_ros"}
    launch -= {cell}
    found = {package for text in texts.values() for package in re.findall(r"\$\(find ([^)]+)\)", text)}
    programs = [text for text in texts.values() if text.startswith("#!/usr/bin/env python3")]
    imports = r"^ *(?:from (\w+)[\w.]* import|import (\w+)$)"
    imported = {"".join(names) for text in programs for names in re.findall(imports, text, re.MULTILINE)}
    imported = {_KEYS.get(name, name) for name in imported - sys.stdlib_module_names - _BESIDE}
    assert launch | found - {cell} | imported <= depends
    installed = set(re.findall(r"^  ([a-z_.]+)$", texts["CMakeLists.txt"], re.MULTILINE))
    assert {path.split("/")[0] for path in texts if path.startswith(("launch", "config", "urdf"))} <= installed


@every_build
def test_plugins_are_of_packages_that_the_manifest_names(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    manifest = fromstring(texts["package.xml"])
    depends = {tag.text for tag in manifest.findall("exec_depend")}
    assert [tag.text for tag in manifest.findall("buildtool_depend")] == ["ament_cmake"]
    assert manifest.findtext("name") == cell
    used = {"hardware_interface"}  # home of mock_components
    for path, text in texts.items():
        if path.endswith(".real.urdf"):
            used |= {plugin.split("/")[0] for plugin in re.findall(r"<plugin>(.*?)</plugin>", text)}
        if fnmatch(path, "*controllers*.yaml") and "moveit" not in path:
            types = re.findall(r"^ +type: (\S+)$", text, re.MULTILINE)
            used |= {_PACKAGES.get(plugin, plugin.split("/")[0]) for plugin in types}
        if path.startswith("config/moveit/"):
            used |= {_PACKAGES_OF_MOVEIT[home] for home in re.findall(r"\b([a-z_]+)/[A-Z]\w+", text)}
    assert used <= depends


@every_cell
def test_arguments_are_described(cell: str) -> None:
    for launch in bring_ups(build(cell, "jazzy"), "real"):
        assert all(launch.descriptions.values())
