"""Rules on what distinguishes one device from another: serial numbers and ports."""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.ERROR)
def duplicate_serial(graph: CellGraph) -> Findings:
    """Yield the second device of one model with a serial number."""
    first: dict[tuple[str, str], Device] = {}
    for device in graph.cell.devices:
        serial = device.software.versions.serial
        if serial == UNKNOWN:
            continue
        owner = first.setdefault((device.model, serial), device)
        if owner is not device:
            message = f"`{device.name}` must have a serial number of its own, got `{serial}`, that of `{owner.name}`"
            related = (Related("first written here", graph.cell.locate(*owner.path, "serial")),)
            yield found(graph, (*device.path, "serial"), message, related=related)


@rule(Severity.BLOCKER)
def indistinguishable_devices(graph: CellGraph) -> Findings:
    """Yield devices without address, port and serial number that share their model and host with another."""
    alike: dict[tuple[str, str], list[Device]] = {}
    for device in graph.cell.devices:
        link = device.site.connection
        if link is not None and link.address is None and link.port is None:
            alike.setdefault((device.model, link.host), []).append(device)
    for (model, host), devices in alike.items():
        for device in devices if len(devices) > 1 else ():
            if device.software.versions.serial != UNKNOWN:
                continue
            others = [other for other in devices if other is not device]
            message = (
                f"`{device.name}` must state its `serial`, because `{others[0].name}` on `{host}` is also a `{model}`"
            )
            related = tuple(Related("of the same model", other.span) for other in others)
            yield found(graph, (*device.path, "serial"), message, related=related)


@rule(Severity.ERROR)
def shared_port(graph: CellGraph) -> Findings:
    """Yield the second device that listens on a port of a host, once."""
    first: dict[tuple[str, int], Device] = {}
    for device in graph.cell.devices:
        link = device.site.connection
        listens = () if device.site.network is None or link is None else device.site.network.listens
        taken = [(port, owner) for port in listens if (owner := first.get((device.site.host, port))) is not None]
        first.update({(device.site.host, port): device for port in listens if (device.site.host, port) not in first})
        if taken:
            port, owner = taken[0]
            message = (
                f"`{device.name}` must have ports of its own on `{device.site.host}`, got {port} of `{owner.name}`"
            )
            related = (Related("first used here", graph.cell.locate(*owner.path, "connection")),)
            yield found(graph, (*device.path, "connection", "first_port"), message, related=related)


@rule(Severity.ERROR)
def shared_serial_port(graph: CellGraph) -> Findings:
    """Yield the second device of a port on one host, and the second tool connector that becomes one."""
    first: dict[tuple[str, str], Device] = {}
    forwarded: dict[tuple[str, str], Device] = {}
    for device in graph.cell.devices:
        serial = None if device.robot.tool_connector is None else device.robot.tool_connector.serial
        robot = device if serial is None else forwarded.setdefault((device.site.host, serial.port), device)
        if robot is not device:
            path = (*device.path, "tool_connector", "serial", "port")
            message = f"`{device.name}` must forward its tool to a port of its own, got that of `{robot.name}`"
            related = (Related("first used here", graph.cell.locate(*robot.path, *path[2:])),)
            yield found(graph, path, message, related=related)
        link = device.site.connection
        if link is None or link.port is None or link.address is not None:
            continue
        owner = first.setdefault((link.host, link.port), device)
        if owner is not device:
            path = (*device.path, "connection", "port")
            message = f"`{device.name}` must have a port of its own on `{link.host}`, got that of `{owner.name}`"
            related = (Related("first used here", graph.cell.locate(*owner.path, "connection", "port")),)
            yield found(graph, path, message, related=related)


@rule(Severity.WARNING)
def port_of_another_model(graph: CellGraph) -> Findings:
    """Yield a device at the port where the vendor has another model of the cell, and two that changed places once."""
    placed = [
        (device, network.usual_port, link.port)
        for device in graph.cell.devices
        if (network := device.site.network) is not None
        and (link := device.site.connection) is not None
        and None not in (network.usual_port, link.port)
    ]
    usual = {port: device for device, port, _ in placed}
    named: set[str] = set()
    for device, own, port in placed:
        other = usual.get(port)
        if port == own or other is None or other.name in named:
            continue
        named.add(device.name)
        message = f"the vendor has `{device.name}` at `{own}`, got `{port}`, the usual port of `{other.name}`"
        related = (Related("that device", graph.cell.locate(*other.path, "connection", "port")),)
        yield found(graph, (*device.path, "connection", "port"), message, related=related)


@rule(Severity.ERROR)
def unused_first_port(graph: CellGraph) -> Findings:
    """Yield stated ports that are not those on which a driver listens."""
    for device in graph.cell.devices:
        path = (*device.path, "connection", "first_port")
        stated = graph.cell.text(*path)
        listens = () if device.site.network is None else device.site.network.listens
        if stated and stated != str(min(listens, default=0)):
            where = f"from {min(listens)} on, whatever is stated" if listens else "on no port"
            yield found(graph, path, f"the driver of `{device.name}` listens {where}: got {stated}")
