"""A process on the mock has the address of a real device.

Parameters of nodes, controllers and mock plugins are those of every target. On the mock the program then talks to the
real machine, past everything that was meant to keep it out. Every spelling counts that a resolver takes: an integer,
hexadecimal or octal parts, leading zeros, IPv4 within IPv6, four numbers in a list; and so do the serial port and the
name of a device. A name that only the network resolves is not known.

Example that is reported:

```yaml
nodes:
  task: {parameters: {robot_ip: 192.168.56.101}}  # expect at robot_ip
```

Example that is accepted:

```yaml
nodes:
  task: {parameters: {robot: arm}}
```

Fix: leave the address to `connection:` of the device, which only the real target reads.

Source:

- https://man7.org/linux/man-pages/man3/inet_aton.3.html (man-pages 6.9.1): spellings of an IPv4 address
- docs/principles.md#mock-and-real
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from ipaddress import AddressValueError, IPv4Address, IPv6Address

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import NodeSource, ParameterValue
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_WORD = re.compile(r"[^\s\"'`,;()\[\]{}<>|&=@?#]+")
_NUMBERS = re.compile(r"(?<![0-9.])[0-9]+(?:\.[0-9]+){3}(?![0-9])")
_PART = re.compile(r"0[xX][0-9a-fA-F]+|[0-9]{1,12}")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of what runs on the mock that hold the address, the port or the name of a connected device."""
    owners = _owners(graph)
    for label, path, name, value in _told_on_mock(graph.cell):
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
        if device.connection is not None and device.connection.port is not None:
            owners[_file(device.connection.port)] = ("port", device.name)
    owners.pop("", None)
    return owners


def _told_on_mock(cell: Cell) -> Iterator[tuple[str, YamlPath, str, ParameterValue]]:
    """Yield each parameter that something is given on the mock: who, where it is written, its name and its value."""
    for node in cell.nodes:
        if not node.real_only:
            own = node.source is NodeSource.SPEC
            for name, value in node.parameters.items():
                yield node.name, _path(node.path, own, name), name, value
    for controller in cell.controllers:
        if "mock" in controller.targets:
            for name, value in controller.parameters.items():
                yield controller.name, _path(controller.path, name in controller.written_parameters, name), name, value
    for device in cell.devices:
        given: Mapping[str, str] = {} if device.hardware is None else device.hardware.parameters["mock"]
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
