"""``config/*.yaml``: ROS parameter files of controller managers, nodes and drivers, and what an attempt records.

``controllers.yaml`` tells a manager its rate and the plugin of each controller, then each controller its parameters;
there is one file for each manager (``<manager>.controllers.yaml`` where there are several, ``controllers.mock.yaml``
and ``controllers.real.yaml`` where a controller commands real hardware otherwise). ``controllers.sim.yaml`` has the
controllers and the cameras of the simulator. ``nodes.yaml`` has a section for
each other node, ``drivers.yaml`` for each that only real hardware starts. Overrides of QoS have the names of rclcpp's
QosOverridingOptions; a node whose author passed no such options ignores them silently: gate L4 looks at what the
endpoints really offer. ``recording_qos.yaml`` is the override file of rosbag2: what an attempt records, with the QoS
that every publisher offers, below the command that records it; raw images on the control path are recorded only where
the spec asks for them, since their volume belongs on another card. Left out: what is a matter of launching, such as
which controllers are active; nodes without parameters; overrides of controllers and the controller manager, which allow
none, and of interfaces that the spec does not write.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller, ControllerManager
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import (
    CONTROLLERS_ON_SIM,
    DRIVERS,
    NODES,
    RECORDING,
    control_path,
    controllers_file,
    node_file,
)
from cellc.compiler.deploy.recording import record_command
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.parameter_file import NodeParameters, node_parameters, parameter_file
from cellc.compiler.formats.yaml_text import render_rows
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import CAMERA_PLUGIN, CAMERAS, PLUGIN_NODE, cameras, is_asked, simulated
from cellc.contract.entities import TARGETS, Qos, Target
from cellc.contract.vocabulary import Feature, features


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the files of controller managers, of nodes, and of the recording."""
    yield from _of_managers(graph, plan.header)
    yield from _of_nodes(graph, plan.header)
    yield _recording(graph, plan)


def _of_managers(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    cell = graph.cell
    if is_asked(cell):
        yield Artifact(CONTROLLERS_ON_SIM, parameter_file(header, _on_simulator(simulated(cell))))
    for manager in cell.managers:
        for file, target in {controllers_file(cell, manager, target): target for target in TARGETS}.items():
            yield Artifact(file, parameter_file(header, _sections(cell, manager, target)))


def _sections(cell: Cell, manager: ControllerManager, target: Target) -> Iterator[NodeParameters]:
    yield NodeParameters(f"{manager.namespace}/controller_manager", manager.path, _of_manager(cell, manager))
    for controller in manager.controllers:
        yield _of_controller(manager, controller, target)


def _on_simulator(cell: Cell) -> Iterator[NodeParameters]:
    """Yield the sections of what the simulator has alone, and of its cameras."""
    (manager,) = cell.managers
    there = tuple(controller for controller in manager.controllers if "mock" in controller.targets)
    yield from _sections(cell, replace(manager, controllers=there), "mock")
    if watched := tuple(cameras(cell)):
        parameters: dict[str, ParameterValue] = {
            f"{CAMERAS}.type": CAMERA_PLUGIN,
            f"{CAMERAS}.camera_publish_rate": max(camera.rate_hz for camera in watched),
        }
        for camera in watched:
            parameters |= {f"{CAMERAS}.{camera.frame}.{key}": value for key, value in camera.parameters.items()}
        yield NodeParameters(f"{manager.namespace}/{PLUGIN_NODE}", ("devices",), parameters)


def _of_manager(cell: Cell, manager: ControllerManager) -> dict[str, ParameterValue]:
    # An update_rate with a decimal point makes the manager abort.
    rate: dict[str, ParameterValue] = {"update_rate": round(manager.update_rate_hz)}
    for state in ("unconfigured", "inactive"):
        devices = (cell.device(name) for name in manager.devices)
        if named := tuple(
            device.control.hardware.name
            for device in devices
            if device.control.hardware and device.control.startup_state == state
        ):
            rate[f"hardware_components_initial_state.{state}"] = named
    hardware = [cell.device(name).control.hardware for name in manager.devices]
    if Feature.LIMITED_COMMANDS in features(cell.distro) and any(
        item is not None and item.enforce_command_limits is False for item in hardware
    ):
        rate["enforce_command_limits"] = False
    return rate | {f"{controller.name}.type": controller.plugin for controller in manager.controllers}


def _of_controller(manager: ControllerManager, controller: Controller, target: Target) -> NodeParameters:
    return NodeParameters(f"{manager.namespace}/{controller.name}", controller.path, controller.parameters_on(target))


def _of_nodes(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    for file in (NODES, DRIVERS):
        nodes = (node for node in graph.cell.nodes if node_file(node) == file and not node.is_bridge)
        sections = [NodeParameters(node.full_name, node.path, node_parameters(graph.cell, node)) for node in nodes]
        if any(section.parameters for section in sections):
            yield Artifact(file, parameter_file(header, sections))


def _recording(graph: CellGraph, plan: Deployment) -> Artifact:
    # As a comment, so that the override file says what it is used with; E is the folder of the attempt. Durations are
    # left at their defaults, which match any publisher.
    command = "# " + " \\\n#   ".join(record_command(graph.cell, "bag")) + "\n\n"
    text = render_rows({name: _profile(qos) for name, qos in plan.recorded.items()})
    places = dict.fromkeys(("interfaces", ".".join(map(str, control_path(graph.cell))), "recording.topics"))
    origin = f"# {', '.join(places)}\n"
    return Artifact(RECORDING, plan.header.commented("#") + command + origin + text)


def _profile(qos: Qos) -> dict[str, ParameterValue]:
    return {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": qos.reliability,
        "durability": qos.durability,
    }
