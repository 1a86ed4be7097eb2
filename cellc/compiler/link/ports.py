"""Ports of a computer on which drivers listen: each device gets some that no other of the computer has.

A driver that its robot connects back to opens ports that its vendor has numbered: two robots on one computer need
others for the second. Texts of the catalog write them as ``{port_50001}``; one that is a plain number there stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.spec.devices import DeviceSpec

_APART = 10
"""More than any driver of the catalog listens on, and easy to read."""
_LARGEST = 65535


def listened(facts: DeviceModel, shift: int) -> tuple[int, ...]:
    """Return the ports of the host on which the driver of a device listens, moved by ``shift`` where they can be."""
    ports = () if facts.network is None else facts.network.ports
    usual = (port.port for port in ports if port.direction == "device_to_host")
    texts = frozenset(_texts(facts))
    return tuple(port + shift if f"{{port_{port}}}" in texts else port for port in usual)


def _texts(facts: DeviceModel) -> Iterator[str]:
    real = None if facts.control is None else facts.control.hardware.real
    if real is not None:
        yield from real.parameters.values()
        yield from (value for release in real.releases for value in release.parameters.values())
    yield from (value for node in facts.nodes for value in node.parameters.values() if isinstance(value, str))


def port_shifts(devices: Mapping[str, tuple[DeviceSpec, DeviceModel]]) -> dict[str, int]:
    """Return by how much the ports of each device are moved: to where the spec has them, else to the next free ones."""
    shifts = {name: _stated(device, facts) for name, (device, facts) in devices.items()}
    taken: dict[str, set[int]] = {}
    for name, (device, facts) in devices.items():
        if device.connection is not None and (shifts[name] is not None or not _moved(facts)):
            taken.setdefault(device.connection.host, set()).update(listened(facts, shifts[name] or 0))
    return {name: _free(shifts[name], *devices[name], taken) for name in devices}


def _moved(facts: DeviceModel) -> bool:
    return listened(facts, 1) != listened(facts, 0)


def _stated(written: DeviceSpec, facts: DeviceModel) -> int | None:
    first = None if written.connection is None else written.connection.first_port
    usual = listened(facts, 0)
    return None if first is None or not usual else first - min(usual)


def _free(stated: int | None, written: DeviceSpec, facts: DeviceModel, taken: dict[str, set[int]]) -> int:
    """Return the stated shift, or the least by which no port is taken; the ports are taken then."""
    if stated is not None or written.connection is None or not _moved(facts):
        return stated or 0
    here = taken.setdefault(written.connection.host, set())
    usual = listened(facts, 0)
    shifts = range(0, _LARGEST - max(usual), _APART)
    shift = next((number for number in shifts if here.isdisjoint(listened(facts, number))), 0)
    here.update(listened(facts, shift))
    return shift
