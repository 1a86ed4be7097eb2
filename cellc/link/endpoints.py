"""Who may stand at the end of an interface, and the QoS that devices and controllers offer there."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.cell.control import ControllerManager
from cellc.cell.device import Device
from cellc.cell.interface import Node, NodeSource, Qos
from cellc.link.interfaces import EndpointNames
from cellc.link.placeholders import placeholders
from cellc.link.qos import QosResolver
from cellc.spec.cell_spec import CellSpec


def name_endpoints(
    spec: CellSpec,
    devices: tuple[Device, ...],
    nodes: tuple[Node, ...],
    managers: tuple[ControllerManager, ...],
    resolver: QosResolver,
) -> EndpointNames:
    """Collect nodes, devices and controllers with their owners, and what devices publish with which QoS."""
    owners = {node.name: node.owner for node in nodes if node.source is not NodeSource.DEVICE}
    owners |= {device.name: spec.owners.responsibilities.vendor_safety for device in devices}
    owners |= {c.name: spec.owners.responsibilities.command for manager in managers for c in manager.controllers}
    offered = {(device.name, topic): qos for device in devices for topic, qos in _offered(device, spec, resolver)}
    return EndpointNames(owners=owners, offered=offered)


def _offered(device: Device, spec: CellSpec, resolver: QosResolver) -> Iterator[tuple[str, Qos]]:
    known = placeholders(device.name, device.prefix, device.spec, spec)
    for topic in device.facts.topics:
        yield known.fill(topic.name), resolver.writer(topic.qos)
    if device.facts.camera is not None:
        for stream in device.facts.camera.streams.values():
            yield known.fill(stream.topic), resolver.writer(stream.qos)
            yield known.fill(stream.info_topic), resolver.writer(stream.info_qos)
