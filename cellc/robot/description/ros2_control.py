"""``<ros2_control>`` elements of a URDF: the grammar and the refusals of hardware_interface's component parser."""

from __future__ import annotations

import re

from cellc.contract.diagnostics import Span
from cellc.robot.description.model import HardwareComponent, HardwareInterface, HardwarePart
from cellc.robot.description.xml_tree import XmlElement


class _RefusedError(Exception):
    """Stops the reading with the message of the component parser."""


def read_hardware(robot: XmlElement) -> tuple[tuple[HardwareComponent, ...], str, Span | None]:
    """Read the hardware components of a robot; or none, with what ros2_control says as it refuses one, and where."""
    components, reading = [], robot
    try:
        for reading in robot.all("ros2_control"):
            components.append(_read_component(reading))
    except _RefusedError as error:
        return (), str(error), reading.span
    return tuple(components), "", None


def _read_component(element: XmlElement) -> HardwareComponent:
    name, kind = _attribute(element, "name"), _attribute(element, "type")
    rate = _read_rate(element)
    hardware = element.first("hardware")
    plugin = None if hardware is None else hardware.first("plugin")
    if hardware is None or plugin is None:
        raise _RefusedError(f"Missing <plugin> tag of <hardware> element for '{name}' in your URDF.")
    return HardwareComponent(
        name=name,
        type=kind,
        plugin=plugin.text.strip(),
        rw_rate=rate,
        is_async=element.attributes.get("is_async", "false").strip().lower() == "true",
        parameters=_parameters(hardware),
        joints=tuple(_read_part(child) for child in element.all("joint")),
        sensors=tuple(_read_part(child) for child in element.all("sensor")),
        gpios=tuple(_read_part(child) for child in element.all("gpio")),
        span=element.span,
    )


def _read_rate(element: XmlElement) -> int:
    text = element.attributes.get("rw_rate", "0")
    if re.fullmatch(r"[0-9]{1,9}", text) is None:
        raise _RefusedError(
            f'Could not parse rw_rate tag in "{element.tag}". Invalid value: "{text}", expected a positive integer.'
        )
    return int(text)


def _read_part(element: XmlElement) -> HardwarePart:
    _parameters(element)
    limits = element.first("limits")
    return HardwarePart(
        name=_attribute(element, "name"),
        command_interfaces=tuple(_read_interface(child) for child in element.all("command_interface")),
        state_interfaces=tuple(_read_interface(child) for child in element.all("state_interface")),
        mimic=element.attributes.get("mimic"),
        limits_enabled=limits is None or limits.attributes.get("enable", "true").strip().lower() != "false",
        span=element.span,
    )


def _read_interface(element: XmlElement) -> HardwareInterface:
    parameters = _parameters(element)
    size = element.attributes.get("size", "1")
    if re.fullmatch(r"[1-9][0-9]*", size) is None:
        raise _RefusedError(
            f'Could not parse size tag in "{element.tag}".Got "{size}", but expected a non-zero positive integer.'
        )
    return HardwareInterface(
        name=_attribute(element, "name"),
        data_type=element.attributes.get("data_type", "double"),
        initial_value=parameters.get("initial_value", ""),
        minimum=parameters.get("min", ""),
        maximum=parameters.get("max", ""),
    )


def _parameters(element: XmlElement) -> dict[str, str]:
    return {_attribute(child, "name"): child.text.strip() for child in element.all("param")}


def _attribute(element: XmlElement, name: str) -> str:
    value = element.attributes.get(name)
    if value is None:
        raise _RefusedError(f"no attribute '{name}' in '{element.tag}' tag")
    return value
