"""Rules on what a card of a host is, by the name that the operating system gives it and by its link."""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.graph.network import Nic, read_address
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_WIRELESS = re.compile(r"(wl|ww)[a-z0-9]+|(ath|ra|wifi)[0-9]+")
_NO_CARD = re.compile(r"lo|(docker|veth|virbr|vmnet|vboxnet|tun|tap|wg|dummy|br-)[a-z0-9.-]*")
"""Names by systemd.net-naming-scheme(7): `wl` is a wireless LAN, `ww` a mobile network; and those of no card."""

_LEAST_BPS = 100e6


@rule(Severity.ERROR)
def unsuited_card(graph: CellGraph) -> Findings:
    """Yield names of what is no card, and cards of robots that are wireless or slow."""
    robots = {device.name for device in graph.cell.devices if device.actuated_joints}
    linked = {(link.host, link.nic) for link in graph.network.devices if link.device in robots}
    for nic in graph.network.nics:
        controls = "control" in nic.carries or (nic.host, nic.name) in linked
        yield from _unsuited(graph, nic, controls)


def _unsuited(graph: CellGraph, nic: Nic, controls: bool) -> Findings:
    name = nic.device or ""
    if _NO_CARD.fullmatch(name):
        message = f"`{nic.full_name}` must be a network card, got `{name}`, which leads out of no computer"
        yield found(graph, (*nic.path, "interface"), message)
    elif controls and _WIRELESS.fullmatch(name):
        message = f"`{nic.full_name}` carries the commands of a robot and must be wired, got the wireless `{name}`"
        yield found(graph, (*nic.path, "interface"), message)
    if controls and nic.speed_bps is not None and nic.speed_bps < _LEAST_BPS:
        message = (
            f"`{nic.full_name}` carries the commands of a robot and must have at least {_LEAST_BPS / 1e6:g} Mbit/s"
        )
        yield found(graph, (*nic.path, "speed"), f"{message}, got {graph.cell.text(*nic.path, 'speed')}")


@rule(Severity.ERROR)
def card_named_twice(graph: CellGraph) -> Findings:
    """Yield the second card of a host that has the name of an earlier one in the operating system."""
    first: dict[tuple[str, str], Nic] = {}
    for nic in graph.network.nics:
        if nic.device is None:
            continue
        earlier = first.setdefault((nic.host, nic.device), nic)
        if earlier is not nic:
            message = f"`{nic.full_name}` and `{earlier.full_name}` must be two cards, both got `{nic.device}`"
            related = (Related("the other card is here", graph.cell.locate(*earlier.path, "interface")),)
            yield found(graph, (*nic.path, "interface"), message, related=related)


@rule(Severity.ERROR, assumes=("duplicate-address",))
def peer_on_control_card(graph: CellGraph) -> Findings:
    """Yield peers at the address of a card that carries control, or of a device."""
    control = dict(_without_ros(graph))
    for index, text in enumerate(graph.cell.network.peers):
        address = read_address(text)
        what = control.get(str(address))
        if address is not None and what is not None:
            yield found(graph, ("network", "peers", index), f"a peer must have a card that carries `ros`, got {what}")


def _without_ros(graph: CellGraph) -> Iterator[tuple[str, str]]:
    for nic in graph.network.nics:
        if nic.interface is not None and "control" in nic.carries:
            yield str(nic.interface.ip), f"{nic.interface.ip} of `{nic.full_name}`, which carries control"
    for link in graph.network.devices:
        if link.address is not None:
            yield str(link.address), f"{link.address}, which is the device `{link.device}`"


@rule(Severity.WARNING)
def wireless_ros_card(graph: CellGraph) -> Findings:
    """Yield wireless cards over which the hosts of a cell find each other."""
    for nic in graph.network.nics:
        if len(graph.cell.hosts) > 1 and "ros" in nic.carries and _WIRELESS.fullmatch(nic.device or ""):
            message = f"`{nic.full_name}` carries what hosts send each other and must be wired, got `{nic.device}`"
            yield found(graph, (*nic.path, "interface"), message)
