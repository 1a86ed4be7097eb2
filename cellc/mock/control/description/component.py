"""One `<ros2_control>` element: grammar and refusals of hardware_interface's component parser."""

from __future__ import annotations

import re
from dataclasses import dataclass
from xml.etree.ElementTree import Element

from cellc.mock.control.errors import DescriptionError


@dataclass(frozen=True, slots=True)
class InterfaceInfo:
    """A command or state interface of a joint, sensor or gpio; `minimum`, `maximum`, `initial_value` as written."""

    name: str
    data_type: str
    initial_value: str
    minimum: str
    maximum: str


@dataclass(frozen=True, slots=True)
class PartInfo:
    """A joint, sensor or gpio of a component.

    Attributes:
        name: name of the part.
        command_interfaces: offered command interfaces.
        state_interfaces: offered state interfaces.
        mimic: the `mimic` attribute as written, None where absent.
        limits_enabled: false with `<limits enable="false"/>`.
    """

    name: str
    command_interfaces: tuple[InterfaceInfo, ...]
    state_interfaces: tuple[InterfaceInfo, ...]
    mimic: str | None
    limits_enabled: bool


@dataclass(frozen=True, slots=True)
class ComponentInfo:
    """A hardware component; `rw_rate` 0 means the rate of the manager."""

    name: str
    type: str
    plugin: str
    rw_rate: int
    is_async: bool
    parameters: dict[str, str]
    joints: tuple[PartInfo, ...]
    sensors: tuple[PartInfo, ...]
    gpios: tuple[PartInfo, ...]


def parse_bool(text: str) -> bool:
    """Read a boolean as hardware_interface does: only true and false, in any case, with white space around.

    Raises:
        ValueError: for everything else.
    """
    word = text.strip().lower()
    if word not in ("true", "false"):
        raise ValueError(f"Input string : '{text}' is not a valid boolean value. Expected 'true' or 'false'.")
    return word == "true"


def _attribute(element: Element, name: str) -> str:
    value = element.get(name)
    if value is None:
        raise DescriptionError(f"no attribute '{name}' in '{element.tag}' tag")
    return value


def _parameters(element: Element) -> dict[str, str]:
    return {_attribute(child, "name"): (child.text or "").strip() for child in element.findall("param")}


def _read_interface(element: Element) -> InterfaceInfo:
    parameters = _parameters(element)
    size = element.get("size", "1")
    if re.fullmatch(r"[1-9][0-9]*", size) is None:
        raise DescriptionError(
            f'Could not parse size tag in "{element.tag}".Got "{size}", but expected a non-zero positive integer.'
        )
    return InterfaceInfo(
        _attribute(element, "name"),
        element.get("data_type", "double"),
        parameters.get("initial_value", ""),
        parameters.get("min", ""),
        parameters.get("max", ""),
    )


def _read_part(element: Element) -> PartInfo:
    _parameters(element)
    limits = element.find("limits")
    enabled = limits is None or limits.get("enable", "true").strip().lower() != "false"
    return PartInfo(
        _attribute(element, "name"),
        tuple(_read_interface(child) for child in element.findall("command_interface")),
        tuple(_read_interface(child) for child in element.findall("state_interface")),
        element.get("mimic"),
        enabled,
    )


def _read_rate(element: Element) -> int:
    text = element.get("rw_rate", "0")
    if not text.isdigit():
        raise DescriptionError(
            f'Could not parse rw_rate tag in "{element.tag}". Invalid value: "{text}", expected a positive integer.'
        )
    return int(text)


def read_component(element: Element) -> ComponentInfo:
    """Read one `<ros2_control>` element.

    Raises:
        DescriptionError: with the message of the component parser.
    """
    name = _attribute(element, "name")
    kind = _attribute(element, "type")
    rate = _read_rate(element)
    hardware = element.find("hardware")
    plugin = None if hardware is None else hardware.find("plugin")
    if hardware is None or plugin is None:
        raise DescriptionError(f"Missing <plugin> tag of <hardware> element for '{name}' in your URDF.")
    return ComponentInfo(
        name,
        kind,
        (plugin.text or "").strip(),
        rate,
        element.get("is_async", "false").strip().lower() == "true",
        _parameters(hardware),
        tuple(_read_part(child) for child in element.findall("joint")),
        tuple(_read_part(child) for child in element.findall("sensor")),
        tuple(_read_part(child) for child in element.findall("gpio")),
    )
