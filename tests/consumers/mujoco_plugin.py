"""What mujoco_ros2_control 0.1.0 does with a scene and its tag of a description, from its source and with MuJoCo.

``MujocoSystemInterface::on_init`` and ``register_*`` of
https://github.com/ros-controls/mujoco_ros2_control/blob/bda2b674/mujoco_ros2_control/src/mujoco_system_interface.cpp.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element

import mujoco

_FREE, _JOINT, _AFFINE = 0, 0, 1  # mjJNT_FREE, mjTRN_JOINT, mjBIAS_AFFINE
_STATES = {"position", "velocity", "effort", "torque", "force"}


@dataclass(slots=True)
class Plugin:
    """The plugin after its start: what it says at level ERROR or FATAL, and the interfaces that it exports."""

    said: list[str] = field(default_factory=list)
    commands: set[str] = field(default_factory=set)
    states: set[str] = field(default_factory=set)
    headless: bool = False
    cameras: list[str] = field(default_factory=list)
    keyframe: str = ""


def started(tag: Element) -> Plugin:
    """Start the plugin on the tag ``<ros2_control>`` of a description that xacro has expanded."""
    plugin = Plugin()
    parameters = {param.attrib["name"]: (param.text or "") for param in tag.findall("hardware/param")}
    if not Path(parameters["mujoco_model"].strip()).exists():
        plugin.said.append("MuJoCo model file does not exist")
        return plugin
    plugin.headless = {"true": True, "false": False}[parameters.get("headless", "false").lower()]
    model = mujoco.MjModel.from_xml_path(parameters["mujoco_model"].strip())
    plugin.said += [
        "a joint of the mjcf has no name"
        for index in range(model.njnt)
        if model.jnt_type[index] != _FREE and not model.joint(index).name
    ]
    drives = dict(_drives(model, plugin))
    plugin.keyframe = parameters.get("initial_keyframe", "")
    if plugin.keyframe and mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_KEY, plugin.keyframe) == -1:
        plugin.said.append(f"no keyframe {plugin.keyframe}")
    for joint in tag.findall("joint"):
        _joint(plugin, joint, drives)
    for sensor in tag.findall("sensor"):
        _sensor(plugin, sensor, model)
    plugin.cameras = [model.camera(index).name for index in range(model.ncam)]
    return plugin


def _drives(model: Any, plugin: Plugin) -> Iterator[tuple[str, str]]:
    """Yield the names by which each actuator is found, its own and its joint's, with its kind."""
    for index in range(model.nu):
        actuator = model.actuator(index)
        if model.actuator_trntype[index] != _JOINT:
            plugin.said.append(f"transmission of {actuator.name} is not that of a joint")
            continue
        kind = "general"
        if model.actuator_biastype[index] == 0:
            kind = "motor"
        elif model.actuator_biastype[index] == _AFFINE and model.actuator_biasprm[index][1] != 0.0:
            kind = "position"
        elif model.actuator_biastype[index] == _AFFINE and model.actuator_biasprm[index][2] != 0.0:
            kind = "velocity"
        yield actuator.name, kind
        yield model.joint(model.actuator_trnid[index][0]).name, kind


def _joint(plugin: Plugin, joint: Element, drives: dict[str, str]) -> None:
    name = joint.attrib["name"]
    wanted = [one.attrib["name"] for one in joint.findall("command_interface")]
    if wanted and name not in drives:
        plugin.said.append(f"{name} has command interfaces and no actuator")
        wanted = []
    for command in wanted:
        # Without gains of a PID: native alone, by the table of hardware_interface.rst.
        native = {"position": "position", "velocity": "velocity", "motor": "effort", "general": "effort"}
        if native[drives[name]] != command:
            plugin.said.append(f"{name}/{command} is not supported with a {drives[name]} actuator")
        plugin.commands.add(f"{name}/{command}")
    states = [one.attrib["name"] for one in joint.findall("state_interface")]
    plugin.states |= {f"{name}/{state}" for state in states if state in _STATES}


def _sensor(plugin: Plugin, sensor: Element, model: Any) -> None:
    parameters = {param.attrib["name"]: param.text for param in sensor.findall("param")}
    name = parameters.get("mujoco_sensor_name", sensor.attrib["name"])
    if "mujoco_type" not in parameters:
        return  # "Not adding hardware interface"
    if parameters["mujoco_type"] != "fts":
        plugin.said.append(f"{sensor.attrib['name']} is {parameters['mujoco_type']}, which is not known here")
    for kind in ("force", "torque"):
        if mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, f"{name}_{kind}") == -1:
            plugin.said.append(f"no sensor {name}_{kind}")
    plugin.states |= {f"{sensor.attrib['name']}/{one.attrib['name']}" for one in sensor.findall("state_interface")}
