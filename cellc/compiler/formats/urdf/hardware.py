"""The ``<ros2_control>`` tag of a device for one target, or of a simulator for all: plugin, parameters, interfaces.

Limits are not repeated here: ros2_control takes those of the URDF's joints. Only the mock gets initial values: real
hardware tells its own, and the simulator begins at a keyframe of its scene.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device, DeviceJoint
from cellc.compiler.cell.hardware import HardwareComponent, InterfaceGroup
from cellc.compiler.formats.escape import xacro_text
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.xml_text import element
from cellc.compiler.graph.simulated import (
    COMPONENT,
    FORCES,
    PLUGIN,
    commands,
    force_sensors,
    simulated_devices,
    states,
)
from cellc.contract.entities import Target

# Only an installed workspace knows the folder; xacro puts it in when the launch file reads the description.
# Credentials are no part of the package: xacro reads them from the environment, or a file, of who launches.
_VARIABLE = re.compile(r"\{env:([A-Z][A-Z0-9_]*)\}")
_ENTRY = re.compile(r"\{yaml:((?:/[A-Za-z0-9_][A-Za-z0-9_.-]*)+):([a-z]+)\}")
_ARGUMENT = re.compile(r"\{arg:([a-z]+)\}")
_SHARE = re.compile(r"\{share:([A-Za-z_][A-Za-z0-9_]*)\}")


def ros2_control(device: Device, hardware: HardwareComponent, target: Target, start: Mapping[str, float]) -> Element:
    """Return the tag of one hardware component.

    Args:
        target: ``mock`` or ``real``.
        start: position of each joint when the mock begins, rad or m; empty for real hardware, which tells its own.
    """
    groups = [("sensor", group) for group in hardware.sensors] + [("gpio", group) for group in hardware.gpios]
    return element(
        "ros2_control",
        {"name": hardware.name, "type": hardware.kinds.get(target, "system")},
        [
            _hardware(hardware, target),
            *_joints(device, start),
            *(_group(tag, group, target) for tag, group in groups if _has_tag(group, target)),
        ],
    )


HEADLESS = "headless"
"""The argument of the description of a simulator that leaves out its window."""


def simulator(cell: Cell, scene: str, keyframe: str) -> Element:
    """Return the tag of the one component of a simulator, which finds its joints and sensors in the scene by name.

    Args:
        scene: path of the scene in the package.
        keyframe: where it begins.
    """
    devices = tuple(simulated_devices(cell))
    parameters = {
        "mujoco_model": f"{{share:{cell.name}}}/{scene}",
        "initial_keyframe": keyframe,
        HEADLESS: f"{{arg:{HEADLESS}}}",
    }
    return element(
        "ros2_control",
        {"name": COMPONENT, "type": "system"},
        [
            element(
                "hardware",
                children=[element("plugin", text=PLUGIN), *(_parameter(*each) for each in parameters.items())],
            ),
            *(
                _tag(joint.name, commands(joint), states(joint))
                for device in devices
                for joint in device.joints
                if commands(joint) or states(joint)
            ),
            *(_force_sensor(group) for device in devices for group in force_sensors(device)),
        ],
    )


def _tag(name: str, taken: tuple[str, ...], offered: tuple[str, ...]) -> Element:
    commanded = [element("command_interface", {"name": each}) for each in taken]
    return element("joint", {"name": name}, [*commanded, *(_state(each, None) for each in offered)])


def _force_sensor(group: InterfaceGroup) -> Element:
    facts = {"mujoco_type": "fts", "mujoco_sensor_name": group.name}
    offered = (_state(name, None) for name in FORCES)
    return element("sensor", {"name": group.name}, [*(_parameter(*each) for each in facts.items()), *offered])


def _has_tag(group: InterfaceGroup, target: Target) -> bool:
    return group.declared and (target == "real" or not group.real_only)


def share_folders(device: Device) -> tuple[str, ...]:
    """Return the packages whose share folders the real hardware's parameters name; xacro stops where one is missing."""
    if device.control.hardware is None:
        return ()
    parameters = device.control.hardware.parameters.get("real", {})
    return tuple(package for value in parameters.values() for package in _SHARE.findall(value))


def for_xacro(root: Element) -> Element:
    """Return a description whose texts xacro leaves as they are, but for share folders and credentials."""
    for node in root.iter():
        node.attrib.update({name: xacro_text(value) for name, value in node.attrib.items() if "$" in value})
        text = xacro_text(node.text or "") or None
        node.text = _found_at_launch(text) if text and node.tag == "param" else text
    return root


def _found_at_launch(text: str) -> str:
    text = _VARIABLE.sub(r"$(env \1)", _SHARE.sub(r"$(find \1)", text))
    text = _ARGUMENT.sub(r"$(arg \1)", text)
    return _ENTRY.sub(r"${xacro.load_yaml('\1')['\2']}", text)


def credentials(device: Device) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the environment variables, and the files, from which the real hardware has its user name and password."""
    hardware = device.control.hardware
    values = () if hardware is None else tuple(hardware.parameters.get("real", {}).values())
    files = dict.fromkeys(path for value in values for path, _ in _ENTRY.findall(value))
    return tuple(name for value in values for name in _VARIABLE.findall(value)), tuple(files)


def _hardware(hardware: HardwareComponent, target: Target) -> Element:
    parameters = hardware.parameters[target]
    return element(
        "hardware",
        children=[
            element("plugin", text=hardware.plugins[target]),
            *(_parameter(name, value) for name, value in parameters.items()),
        ],
    )


def _joints(device: Device, start: Mapping[str, float]) -> Iterator[Element]:
    # A joint that follows another may offer states; ros2_control takes its factors from the URDF's `<mimic>`.
    for joint in device.joints:
        if joint.command_interfaces or joint.state_interfaces:
            yield _joint(joint, start.get(joint.name))


def _joint(joint: DeviceJoint, start: float | None) -> Element:
    taken = [element("command_interface", {"name": name}) for name in joint.command_interfaces]
    offered = [_state(name, start if name == "position" else None) for name in joint.state_interfaces]
    return element("joint", {"name": joint.name}, [*taken, *offered])


def _group(tag: str, group: InterfaceGroup, target: Target) -> Element:
    initial = group.initial if target == "mock" else {}
    taken = [element("command_interface", {"name": name}) for name in group.command_interfaces]
    offered = [_state(name, initial.get(name)) for name in group.state_interfaces]
    return element(tag, {"name": group.name}, [*taken, *offered])


def _state(name: str, initial: float | None) -> Element:
    value = [] if initial is None else [_parameter("initial_value", shortest(initial))]
    return element("state_interface", {"name": name}, value)


def _parameter(name: str, value: str) -> Element:
    return element("param", {"name": name}, text=value)
