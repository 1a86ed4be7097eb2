"""The network graph: addresses, the cards that they are on, and what reaches what."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from ipaddress import IPv4Address, IPv4Interface

from cellc.compiler.cell.cell import Cell
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass
from cellc.contract.stated import DiscoveryServer


@dataclass(frozen=True, slots=True)
class Nic:
    """A network card; ``interface`` is None where its address is no IPv4 address with a prefix length.

    ``device`` is the name that the operating system gives it.
    """

    host: str
    name: str
    text: str
    interface: IPv4Interface | None
    carries: tuple[str, ...]
    path: YamlPath
    speed_bps: float | None = None
    device: str | None = None

    @property
    def full_name(self) -> str:
        """Name of the card with its host."""
        return f"{self.host}/{self.name}"


@dataclass(frozen=True, slots=True)
class DeviceAddress:
    """How a device is reached; ``address`` is None where none is written or where it is malformed."""

    device: str
    host: str
    nic: str | None
    text: str | None
    address: IPv4Address | None
    path: YamlPath


# Without slots, so that the cards are sorted by host when they are first asked for.
@dataclass(frozen=True)
class NetworkGraph:
    """Cards of hosts and addresses of devices, in the order of the spec."""

    nics: tuple[Nic, ...]
    devices: tuple[DeviceAddress, ...]

    @cached_property
    def cards(self) -> Mapping[str, Mapping[str, Nic]]:
        """Cards of each host that has some, by their names."""
        cards: dict[str, dict[str, Nic]] = {}
        for nic in self.nics:
            cards.setdefault(nic.host, {})[nic.name] = nic
        return cards

    @cached_property
    def devices_of(self) -> Mapping[str, tuple[DeviceAddress, ...]]:
        """Devices with a connection to each host that has some."""
        devices: dict[str, list[DeviceAddress]] = {}
        for device in self.devices:
            devices.setdefault(device.host, []).append(device)
        return {host: tuple(connected) for host, connected in devices.items()}

    def nic(self, host: str, name: str) -> Nic | None:
        """Find a card."""
        return self.cards.get(host, {}).get(name)

    def ros_cards(self, host: str) -> tuple[Nic, ...]:
        """Return the cards of a host that ROS may use: those with an address that are not for control."""
        return tuple(
            nic
            for nic in self.cards.get(host, {}).values()
            if nic.interface is not None and "control" not in nic.carries
        )

    def card_of(self, server: DiscoveryServer) -> Nic | None:
        """Find the card on which a discovery server listens: that of the spec, or the first of its host for ROS."""
        cards = self.ros_cards(server.host)
        return next((card for card in cards if server.nic in (None, card.name)), None)

    def nic_of(self, device: DeviceAddress) -> Nic | None:
        """Find the card on which a device is reached, where the spec names one."""
        return None if device.nic is None else self.nic(device.host, device.nic)


def build_network(cell: Cell) -> NetworkGraph:
    """Read the addresses of hosts and devices."""
    nics = tuple(
        Nic(
            host,
            name,
            nic.address,
            read_interface(nic.address),
            nic.carries,
            _path(host, name),
            nic.speed_bps,
            nic.interface,
        )
        for host, computer in cell.hosts.items()
        for name, nic in computer.nics.items()
    )
    devices = tuple(
        DeviceAddress(
            device.name, link.host, link.nic, link.address, read_address(link.address), (*device.path, "connection")
        )
        for device in cell.devices
        if (link := device.site.connection) is not None
    )
    return NetworkGraph(nics, devices)


def running_hosts(cell: Cell) -> dict[str, str]:
    """Return the host that runs each node and each controller, by its full name; empty where the cell names none."""
    nodes = {node.full_name: node.host for node in cell.nodes}
    return nodes | {
        controller.full_name: manager.host for manager in cell.managers for controller in manager.controllers
    }


def _path(host: str, nic: str) -> YamlPath:
    return ("hosts", host, "nics", nic)


def read_interface(text: str) -> IPv4Interface | None:
    """Read an IPv4 address with a prefix length; None where the text is anything else."""
    if "/" not in text:
        return None
    try:
        return IPv4Interface(text)
    except ValueError:
        return None


def read_address(text: str | None) -> IPv4Address | None:
    """Read an IPv4 address; None where the text is anything else."""
    try:
        return None if text is None else IPv4Address(text)
    except ValueError:
        return None
