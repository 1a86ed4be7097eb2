"""Rules on what keeps the mock from real hardware."""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from ipaddress import AddressValueError, IPv4Address, IPv6Address

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node, NodeSource, ParameterValue
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_WORD = re.compile(r"[^\s\"'`,;()\[\]{}<>|&=@?#]+")
_NUMBERS = re.compile(r"(?<![0-9.])[0-9]+(?:\.[0-9]+){3}(?![0-9])")
_PART = re.compile(r"0[xX][0-9a-fA-F]+|[0-9]{1,12}")


@rule(Severity.ERROR)
def address_in_parameters(graph: CellGraph) -> Findings:
    """Yield parameters of what runs on the mock that hold the address, the port or the name of a connected device."""
    owners = _owners(graph)
    for label, path, name, value in _given_on_mock(graph.cell):
        for place in _places(value):
            if place in owners:
                what, device = owners[place]
                yield found(graph, path, f"parameter `{name}` of `{label}` holds {place}, the {what} of `{device}`")
                break


def _owners(graph: CellGraph) -> dict[str, tuple[str, str]]:
    """Return how each device is reached → what that is, and the device."""
    owners: dict[str, tuple[str, str]] = {}
    for link in graph.network.devices:
        if link.text is not None:
            owners[_host(link.text) if link.address is None else str(link.address)] = ("address", link.device)
    for device in graph.cell.devices:
        if device.site.connection is not None and device.site.connection.port is not None:
            owners[_file(device.site.connection.port)] = ("port", device.name)
    owners.pop("", None)
    return owners


def _given_on_mock(cell: Cell) -> Iterator[tuple[str, YamlPath, str, ParameterValue]]:
    """Yield each parameter that something is given on the mock: who, where it is written, its name and its value."""
    for node in cell.nodes:
        if not node.real_only:
            in_spec = node.source is NodeSource.SPEC
            for name, value in node.parameters.items():
                yield node.name, _path(node.path, in_spec, name), name, value
    for controller in cell.controllers:
        if "mock" in controller.targets:
            for name, value in controller.parameters.items():
                yield controller.name, _path(controller.path, name in controller.written_parameters, name), name, value
    for device in cell.devices:
        given: Mapping[str, str] = {} if device.control.hardware is None else device.control.hardware.parameters["mock"]
        for name, text in given.items():
            yield f"the mock of {device.name}", (*device.path, "model"), name, text


def _path(path: YamlPath, written: bool, name: str) -> YamlPath:
    return (*path, "parameters", name) if written else (*path, "model")


def _places(value: ParameterValue) -> Iterator[str]:
    """Yield every address, file and name that a value may stand for, each in its usual spelling."""
    if isinstance(value, tuple):
        for item in value:
            yield from _places(item)
        if len(value) == 4:
            yield from _addresses(".".join(str(item) for item in value))
    elif isinstance(value, str):
        for number in _NUMBERS.findall(value):
            yield from _addresses(number)
        for word in _WORD.findall(value):
            yield from _named(word)
    elif not isinstance(value, bool) and float(value).is_integer():
        yield from _numbered(int(value))


def _named(word: str) -> Iterator[str]:
    """Yield what a word may name: as a whole, after a scheme, and before a port."""
    yield _file(word)
    for part in (word, *word.split("/")):
        for host in (part, *part.split(":")):
            yield _host(host)
            yield from _addresses(host.rstrip("."))


def _addresses(text: str) -> Iterator[str]:
    """Yield the IPv4 addresses that a text may be, as inet_aton reads it and with leading zeros of no meaning."""
    with suppress(AddressValueError):
        yield str(IPv4Address(int(IPv6Address(text)) & 0xFFFFFFFF))
    parts = text.split(".")
    if len(parts) <= 4 and all(_PART.fullmatch(part) for part in parts):
        for octal in (True, False):
            *heads, last = (_number(part, octal) for part in parts)
            if all(head < 256 for head in heads) and last < 256 ** (4 - len(heads)):
                high = sum(head << 8 * (3 - place) for place, head in enumerate(heads))
                yield str(IPv4Address(high + last))


def _number(text: str, octal: bool) -> int:
    if text[:2] in ("0x", "0X"):
        return int(text, 16)
    return int(text, 8) if octal and text[0] == "0" and set(text) <= set("01234567") else int(text)


def _numbered(value: int) -> Iterator[str]:
    """Yield the addresses that a number is, in both orders of bytes."""
    if 0 <= value < 2**32:
        yield str(IPv4Address(value))
        yield str(IPv4Address(value.to_bytes(4, "little")))


def _host(text: str) -> str:
    return text.rstrip(".").casefold()


def _file(text: str) -> str:
    return posixpath.normpath("/" + text.lstrip("/")) if text.startswith("/") else ""


_DESCRIPTION = "robot_description"
_MANAGER = "ros2_control_node"


@rule(Severity.ERROR)
def driver_on_mock(graph: CellGraph) -> Findings:
    """Yield nodes and mock plugins that are known to reach a device, and nodes whose parameters name hardware."""
    cell, real_plugins = graph.cell, _real_plugins(graph.cell)
    drivers, programs = _driver_packages(cell), _real_programs(cell)
    for node in cell.nodes:
        if not node.real_only and node.source is not NodeSource.STANDARD:
            yield from (found(graph, path, message) for path, message in _reasons(cell, node, drivers, programs))
    for device in cell.devices:
        plugin = "" if device.control.hardware is None else device.control.hardware.plugins["mock"]
        package = plugin.partition("/")[0]
        if package in cell.hardware_packages or plugin in real_plugins:
            message = f"the mock of `{device.name}` is `{plugin}`, of a package that reaches real hardware"
            yield found(graph, (*device.path, "model"), message)


def _reasons(
    cell: Cell, node: Node, drivers: frozenset[str], programs: frozenset[str]
) -> Iterator[tuple[YamlPath, str]]:
    in_spec = node.source is NodeSource.SPEC
    program = f"{node.package}/{node.executable}"
    packages = cell.hardware_packages | (drivers if in_spec else frozenset())
    drives = node.package in packages or program in programs or node.executable.endswith("ros2_control_node")
    if drives:
        message = f"`{node.name}` runs `{program}` on the mock, a driver of real hardware"
        yield (*node.path, "run" if in_spec else "model"), message
    for name, value in node.parameters.items():
        texts = value if isinstance(value, tuple) else (value,)
        described = any("<ros2_control" in text or "<plugin" in text for text in texts if isinstance(text, str))
        if described or name.rpartition(".")[2] == _DESCRIPTION:
            message = f"`{node.name}` gets hardware to drive from `{name}` on the mock"
            yield (*node.path, *(("parameters", name) if in_spec else ("model",))), message


def _driver_packages(cell: Cell) -> frozenset[str]:
    """Return the packages that the devices of the cell call their drivers."""
    return frozenset(
        device.software.packages.driver for device in cell.devices if device.software.packages.driver is not None
    )


def _real_programs(cell: Cell) -> frozenset[str]:
    return frozenset(f"{node.package}/{node.executable}" for node in cell.nodes if node.real_only)


def _real_plugins(cell: Cell) -> frozenset[str]:
    """Return the plugins of the real target, but for one that the catalog knows to reach nothing there either."""
    components = (device.control.hardware for device in cell.devices)
    named = (component.plugins.get("real", "") for component in components if component is not None)
    return frozenset(named) - cell.harmless_plugins - {""}


@rule(Severity.ERROR, assumes=("real-hardware-in-mock",))
def hardware_of_another_target(graph: CellGraph) -> Findings:
    """Yield the targets `mock` and `real` with hardware of another name."""
    for name in ("mock", "real"):
        target = graph.cell.targets[name]
        if target.hardware != name:
            message = f"target `{name}` must have `hardware: {name}`, got `{target.hardware}`"
            yield found(graph, ("targets", name, "hardware"), message)


@rule(Severity.ERROR)
def real_hardware_in_mock(graph: CellGraph) -> Findings:
    """Yield targets other than real with real hardware."""
    for name, target in graph.cell.targets.items():
        if name != "real" and target.hardware == "real":
            path = ("targets", name, "hardware")
            yield found(graph, path, f"target `{name}` uses real hardware", f"write `hardware: {name}`")


@rule(Severity.ERROR)
def unproven_mock_plugin(graph: CellGraph) -> Findings:
    """Yield devices whose mock plugin neither the catalog nor a signed statement knows to touch no hardware."""
    for device in graph.cell.devices:
        plugin = "" if device.control.hardware is None else device.control.hardware.plugins["mock"]
        if device.control.hardware is not None and not graph.cell.is_harmless_plugin(plugin):
            message = f"the mock of `{device.name}` is `{plugin}`, without a statement that it touches no hardware"
            yield found(graph, ("devices", device.name, "model"), message)


@rule(Severity.ERROR)
def unproven_mock_program(graph: CellGraph) -> Findings:
    """Yield devices that run a program on the mock without a statement that it touches no hardware."""
    for device in graph.cell.devices:
        for program in graph.cell.programs_on_mock(device):
            if not graph.cell.is_harmless_program(program):
                message = (
                    f"`{device.name}` runs `{program}` on the mock, without a statement that it touches no hardware"
                )
                yield found(graph, ("devices", device.name, "model"), message)
