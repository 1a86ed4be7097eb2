"""``package.xml``, ``CMakeLists.txt``, ``sources.repos``: the folder as a ROS package, read by colcon, rosdep and vcs.

Format 3 of REP-149. Run-time dependencies follow from what is in use: nodes, controllers, hardware drivers. The version
is that of the artifacts' format; what the cell was made from is in ``manifest.json``. There is nothing to compile:
the build file installs the folders through ament_cmake. Left out: tests and targets of the user's own, which belong
into a package beside this one; the artifacts are tested where they are made.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import SOURCES, plans
from cellc.compiler.deploy.first_goal import first_goals, programs
from cellc.compiler.deploy.observation import readings
from cellc.compiler.deploy.recording import reporting
from cellc.compiler.deploy.versions import installed_parts
from cellc.compiler.deploy.watches import watches
from cellc.compiler.formats.urdf.hardware import share_folders
from cellc.compiler.formats.xml_text import comment, element, render
from cellc.compiler.formats.yaml_text import render as yaml
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import LEAST_VERSION, PACKAGES, is_asked, simulated
from cellc.compiler.graph.versions import unreleased
from cellc.contract.pins import version_number

_ALWAYS = ("ros2launch", "xacro")
_CONTROL = ("controller_manager", "hardware_interface", "ros2controlcli")
# What the program of the bring-up imports: it asks the controller managers and managed nodes, and hears transforms.
_BRING_UP = ("controller_manager_msgs", "lifecycle_msgs", "rcl_interfaces", "rclpy", "tf2_msgs")
# What the program that observes imports besides; the first is a key of rosdep.
_OBSERVE = ("python3-yaml", "std_msgs")
_CYCLES = ("diagnostic_msgs", "pal_statistics_msgs")
# What acknowledges claims, and what ends them where a robot no longer follows.
_WATCH = ("action_msgs", "std_srvs")
# What the commands of the gates call; the keys of rosdep.
_GATES = ("liburdfdom-tools", "ros2bag", "ros2cli_common_extensions", "rosbag2_storage_mcap", "sros2", "tf2_ros")
_EXECUTION = "moveit_simple_controller_manager"
# What the program of the first goal imports.
_FIRST_GOAL = ("builtin_interfaces", "control_msgs", "sensor_msgs", "trajectory_msgs")
_MOVE_GROUP = "moveit_ros_move_group"
_OF_MOVEIT = "moveit_"
_PERCEPTION = "moveit_ros_perception"
_FOLDERS = ("config", "launch", "security", "sim", "urdf")
_ON_HOSTS = "middleware"
_FILES = ("contract.json", "manifest.json", "rehearsals.json")
# The format demands an address, and the spec names owners, not mailboxes: RFC 2606 keeps this domain from being one.
_EMAIL = "maintainer@unset.invalid"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the package manifest and the build file."""
    yield Artifact("package.xml", render(_package(graph.cell), plan.header.text))
    sources = unreleased(graph.cell)
    if sources:
        repositories = {name: {"type": "git", "url": pin.url, "version": pin.ref} for name, pin in sources.items()}
        text = "# versions, devices: run `vcs import src < sources.repos` in the workspace of this package\n"
        yield Artifact(SOURCES, plan.header.commented("#") + text + yaml({"repositories": repositories}))
    yield Artifact("CMakeLists.txt", plan.header.commented("#") + "\n".join(_build_file(graph.cell)) + "\n")


def _package(cell: Cell) -> Element:
    pinned = _pinned(cell)
    return element(
        "package",
        {"format": "3"},
        [
            element("name", text=cell.name),
            element("version", text="1.0.0"),
            element("description", text=cell.summary if cell.summary.strip() else f"Robot cell {cell.name}."),
            comment("owners.approvals.graph; the spec has no mail address, so this one is a placeholder"),
            element("maintainer", {"email": _EMAIL}, text=cell.owners.approvals.graph),
            element("license", text="Apache-2.0"),
            element("buildtool_depend", text="ament_cmake"),
            *(element("exec_depend", _at_least(name, pinned), text=name) for name in _dependencies(cell)),
            element("export", children=[element("build_type", text="ament_cmake")]),
        ],
    )


def _at_least(name: str, pinned: Mapping[str, str]) -> dict[str, str]:
    return {"version_gte": pinned[name]} if name in pinned else {}


def _pinned(cell: Cell) -> dict[str, str]:
    """Return the pinned number of each package that a part of the version tuple is; a commit is no number."""
    parts: list[tuple[str | None, str]] = [(name, cell.versions.ros2_control) for name in _CONTROL]
    parts += [(name, cell.versions.moveit) for name in _of_moveit(cell)]
    for device in cell.devices:
        packages, versions = device.software.packages, device.software.versions
        parts += [(packages.driver, versions.driver), (packages.sdk_package, versions.sdk)]
        parts += [(packages.description, versions.description)]
    parts += [(name, LEAST_VERSION) for name in PACKAGES]
    return {name: number for name, text in parts if name and (number := version_number(text))}


def _of_moveit(cell: Cell) -> set[str]:
    """Return the packages of planning that have the version of MoveIt; other solvers have their own."""
    solvers = {group.solver.package for group in cell.groups}
    packages = {name for name in solvers if name.startswith(_OF_MOVEIT)}
    perception = () if cell.octomap is None else (_PERCEPTION,)
    return {_EXECUTION, _MOVE_GROUP, *perception, *packages, *(pipeline.package for pipeline in cell.pipelines)}


def _dependencies(cell: Cell) -> tuple[str, ...]:
    """Return package names in alphabetical order, so that a new device shows as new lines alone."""
    controllers = (controller.package for controller in cell.controllers)
    hardware = (device.software.packages.driver for device in cell.devices if device.control.hardware is not None)
    names = {*_ALWAYS, *_BRING_UP, *_OBSERVE, *_GATES, *(node.package for node in cell.nodes)}
    names |= {name for name in (*controllers, *hardware, *(part.package for part in installed_parts(cell))) if name}
    names |= {package for device in cell.devices for package in share_folders(device)}
    programs_of = (program for device in cell.devices for program in device.site.programs)
    names |= {name for program in programs_of for name in (program.package, *program.system)}
    tools = (None if device.body.kinematics is None else device.body.kinematics.package for device in cell.devices)
    names |= {package for package in tools if package is not None}
    if plans(cell):
        names |= {*_of_moveit(cell), *(group.solver.package for group in cell.groups)}
    if first_goals(cell):
        names |= set(_FIRST_GOAL)
    if any(watches(cell)):
        names |= set(_WATCH)
    read = {reading.interface for reading in readings(cell)}
    names |= {interface.type.partition("/")[0] for interface in cell.interfaces if interface.name in read}
    if reporting(cell):
        names |= set(_CYCLES)
    if is_asked(cell):
        names |= {*PACKAGES, *(each.package for each in simulated(cell).controllers if "mock" in each.targets)}
    if cell.managers:
        names |= set(_CONTROL)
        # Every topic that the bring-up listens to is one whose type it imports.
    return tuple(sorted(names))


def _build_file(cell: Cell) -> Iterator[str]:
    yield "cmake_minimum_required(VERSION 3.8)"
    yield f"project({cell.name} NONE)"
    yield ""
    yield "find_package(ament_cmake REQUIRED)"
    yield ""
    yield from _install("DIRECTORY", (*_FOLDERS, *((_ON_HOSTS,) if cell.hosts else ())))
    yield from _install("FILES", _FILES)
    yield from _install("PROGRAMS", programs(cell), "lib")
    yield ""
    yield "ament_package()"


def _install(kind: str, names: tuple[str, ...], place: str = "share") -> list[str]:
    return [f"install({kind}", *(f"  {name}" for name in names), f"  DESTINATION {place}/${{PROJECT_NAME}}", ")"]
