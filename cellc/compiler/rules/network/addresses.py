"""Rules on the addresses of hosts and devices."""

from __future__ import annotations

from ipaddress import IPv4Address, IPv4Network
from itertools import combinations

from cellc.compiler.graph.network import Nic
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule

_PRIVATE = tuple(map(IPv4Network, ("10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "169.254.0.0/16", "127.0.0.0/8")))
"""RFC 1918, and what is of one link or one computer alone."""


@rule(Severity.ERROR)
def address_of_a_carried_device(graph: CellGraph) -> Findings:
    """Yield the address of each device that has none of its own: it is reached at that of its carrier."""
    for device in graph.cell.devices:
        link, needs = device.site.connection, device.site.network
        if link is None or link.address is None or needs is None or not needs.by_carrier:
            continue
        path = (*device.path, "connection", "address")
        message = f"`{device.name}` must have no address of its own, got `{link.address}`"
        carriers = [carrier for carrier in graph.cell.devices if device.name in carrier.mount.carries]
        related = tuple(Related("it is reached through this one", graph.cell.locate(*c.path)) for c in carriers)
        yield found(graph, path, message, related=related)


@rule(Severity.ERROR)
def cards_in_one_subnet(graph: CellGraph) -> Findings:
    """Yield the second card of a host whose subnet overlaps."""
    for first, second in (pair for cards in graph.network.cards.values() for pair in combinations(cards.values(), 2)):
        if first.interface is None or second.interface is None:
            continue
        same = first.interface.ip == second.interface.ip  # a duplicate address, which is reported as such
        if first.interface.network.overlaps(second.interface.network) and not same:
            message = f"`{second.full_name}` and `{first.full_name}` are both in {first.interface.network}"
            related = (Related("the other card is here", graph.cell.locate(*first.path, "address")),)
            yield found(graph, (*second.path, "address"), message, related=related)


@rule(Severity.ERROR)
def device_outside_subnet(graph: CellGraph) -> Findings:
    """Yield devices with an address outside the subnet of their card."""
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if nic is None or nic.interface is None or device.address is None:
            continue
        if device.address not in nic.interface.network:
            message = f"{device.address} of `{device.device}` is not in {nic.interface.network} of `{nic.full_name}`"
            related = (Related("the card is here", graph.cell.locate(*nic.path, "address")),)
            yield found(graph, (*device.path, "address"), message, related=related)


@rule(Severity.ERROR)
def duplicate_address(graph: CellGraph) -> Findings:
    """Yield the second and every later bearer of an address."""
    bearers = [(nic.interface.ip, nic.full_name, nic.path) for nic in graph.network.nics if nic.interface is not None]
    bearers += [(d.address, d.device, d.path) for d in graph.network.devices if d.address is not None]
    first: dict[IPv4Address, tuple[str, YamlPath]] = {}
    for address, name, path in bearers:
        earlier_name, earlier_path = first.setdefault(address, (name, path))
        if earlier_path != path:
            message = f"`{name}` and `{earlier_name}` both have address {address}"
            related = (Related("first used here", graph.cell.locate(*earlier_path, "address")),)
            yield found(graph, (*path, "address"), message, related=related)


@rule(Severity.ERROR)
def malformed_address(graph: CellGraph) -> Findings:
    """Yield cards and devices whose address cannot be read."""
    for nic in graph.network.nics:
        if nic.interface is None:
            message = f"expected an IPv4 address with a prefix length for `{nic.full_name}`, got `{nic.text}`"
            yield found(graph, (*nic.path, "address"), message, "write it such as `192.168.56.10/24`")
    for device in graph.network.devices:
        if device.text is not None and device.address is None:
            message = f"expected an IPv4 address for `{device.device}`, got `{device.text}`"
            yield found(graph, (*device.path, "address"), message, "write it such as `192.168.56.101`")


@rule(Severity.ERROR)
def no_route_to_device(graph: CellGraph) -> Findings:
    """Yield devices without a named card whose address is in no subnet of their host."""
    for device in graph.network.devices:
        if device.nic is not None or device.address is None:
            continue
        cards = graph.network.cards.get(device.host, {}).values()
        if not any(nic.interface is not None and device.address in nic.interface.network for nic in cards):
            message = f"no card of `{device.host}` is in the subnet of {device.address} of `{device.device}`"
            yield found(graph, (*device.path, "address"), message)


@rule(Severity.ERROR)
def public_address(graph: CellGraph) -> Findings:
    """Yield devices with a global address, and cards whose subnet reaches beyond private addresses."""
    for device in graph.network.devices:
        if device.address is not None and device.address.is_global:
            message = f"{device.address} of `{device.device}` is a public address"
            yield found(graph, (*device.path, "address"), message)
    for nic in graph.network.nics:
        if nic.interface is None or not nic.interface.ip.is_private:
            continue
        if not any(nic.interface.network.subnet_of(block) for block in _PRIVATE):
            message = f"the subnet of `{nic.full_name}` must be of private addresses, got {nic.interface.network}"
            yield found(graph, (*nic.path, "address"), message, "write a longer prefix, such as /24")


@rule(Severity.ERROR)
def unusable_address(graph: CellGraph) -> Findings:
    """Yield cards and devices with the network or broadcast address of their subnet."""
    for nic in graph.network.nics:
        if nic.interface is not None and _reserved(nic, nic.interface.ip):
            message = f"{nic.interface.ip} of `{nic.full_name}` is not a host address in {nic.interface.network}"
            yield found(graph, (*nic.path, "address"), message)
    for device in graph.network.devices:
        card = graph.network.nic_of(device)
        if card is not None and device.address is not None and _reserved(card, device.address):
            message = f"{device.address} of `{device.device}` is not a host address"
            yield found(graph, (*device.path, "address"), message)


def _reserved(nic: Nic, address: IPv4Address) -> bool:
    # RFC 3021: a /31 has two hosts and neither of the two addresses; a /32 has one.
    if nic.interface is None or nic.interface.network.prefixlen >= 31:
        return False
    return address in (nic.interface.network.network_address, nic.interface.network.broadcast_address)
