"""Rules on what else is on the wire, and on the computer, of a control loop."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from cellc.compiler.cell.interface import Interface, Node
from cellc.compiler.graph.network import Nic, running_hosts
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule
from cellc.contract.vocabulary import UNKNOWN


@rule(Severity.ERROR)
def camera_on_control_card(graph: CellGraph) -> Findings:
    """Yield cameras on a card that carries control."""
    cameras = {device.name for device in graph.cell.devices if device.kind == "camera"}
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if nic is not None and "control" in nic.carries and device.device in cameras:
            message = f"camera `{device.device}` is on `{nic.full_name}`, which carries control"
            yield found(graph, (*device.path, "nic"), message)


_ASSUMED_BPS = 1e9
_SHARE = 0.8


@rule(Severity.WARNING, assumes=("malformed-address", "missing-ros-card", "ros-cards-apart"))
def images_beyond_link(graph: CellGraph) -> Findings:
    """Yield cards whose images, as the cameras send them, take more than a share of their link."""
    loads: dict[str, list[tuple[Nic, Interface, float]]] = defaultdict(list)
    for nic, interface, rate_bps in (*_crossings(graph), *_from_cameras(graph)):
        loads[nic.full_name].append((nic, interface, rate_bps))
    for name, carried in loads.items():
        nic, total_bps = carried[0][0], sum(rate_bps for _, _, rate_bps in carried)
        speed_bps = nic.speed_bps or _ASSUMED_BPS
        if total_bps <= speed_bps * _SHARE:
            continue
        link = "its" if nic.speed_bps else "an assumed"
        message = f"the images on `{name}` must take at most {speed_bps * _SHARE / 1e6:g} Mbit/s of {link}"
        message += f" {speed_bps / 1e6:g} Mbit/s, got {total_bps / 1e6:.0f} Mbit/s"
        topics = {interface.name: interface for _, interface, _ in carried}
        related = tuple(Related(f"`{topic}` goes over it", interface.span) for topic, interface in topics.items())
        yield found(graph, (*nic.path, "speed"), message, related=related)


def _crossings(graph: CellGraph) -> Iterator[tuple[Nic, Interface, float]]:
    """Yield the card of either end of each stream that another computer reads or records, with what it takes there."""
    running = running_hosts(graph.cell)
    recorders = {nic.host for nic in graph.network.nics if "bag" in nic.carries}
    cameras = {device.name: device for device in graph.cell.devices if device.sensing.camera is not None}
    for interface in graph.cell.interfaces:
        camera = next((cameras[source.node] for source in interface.sources if source.node in cameras), None)
        streams = () if camera is None or camera.sensing.camera is None else camera.sensing.camera.streams
        image = next((stream for stream in streams if stream.topic == interface.name and stream.image_bytes), None)
        if camera is None or image is None or image.image_bytes is None:
            continue
        rate_bps = image.image_bytes * 8.0 * min(interface.rate_hz or image.rate_hz, image.rate_hz)
        readers = {running.get(sink.full_name, "") for sink in interface.sinks}
        if interface.name in graph.cell.recording.topics and camera.site.host not in recorders:
            readers |= recorders
        readers -= {camera.site.host, ""}
        for reader in sorted(readers):
            for nic in _way(graph, camera.site.host, reader):
                yield nic, interface, rate_bps


_RAW = 3.0
"""Cameras send one byte of a pixel for the three of color that their driver makes of it."""


def _from_cameras(graph: CellGraph) -> Iterator[tuple[Nic, Interface, float]]:
    """Yield the card of each camera with an address, with each stream that is used and the least that it takes."""
    at = {
        known.device: nic
        for known in graph.network.devices
        if known.address and (nic := graph.network.nic_of(known)) is not None
    }
    for device in graph.cell.devices:
        streams = () if device.sensing.camera is None else device.sensing.camera.streams
        for stream in streams if device.name in at else ():
            named = (interface for interface in graph.cell.interfaces if interface.name == stream.topic)
            interface = next((interface for interface in named if interface.sinks), None)
            if interface is not None and stream.image_bytes and stream.type.endswith("/Image"):
                size = stream.image_bytes / (_RAW if (stream.encoding or "").startswith(("rgb", "bgr")) else 1.0)
                rate = min(interface.rate_hz or stream.rate_hz, stream.rate_hz)
                yield at[device.name], interface, size * 8.0 * rate


def _way(graph: CellGraph, one: str, other: str) -> tuple[Nic, ...]:
    """Return the cards over which two hosts talk ROS: the first two that share a subnet."""
    for ours in graph.network.ros_cards(one):
        for theirs in graph.network.ros_cards(other):
            assert ours.interface is not None
            assert theirs.interface is not None
            if ours.interface.network.overlaps(theirs.interface.network):
                return ours, theirs
    return ()


_FAST_HZ = 1000.0
_PLANNERS = frozenset({"moveit_ros_move_group", "moveit_servo", "nav2_planner"})
_IMAGES = ("/Image", "/CompressedImage", "/PointCloud2")


@rule(Severity.WARNING)
def load_beside_control_loop(graph: CellGraph) -> Findings:
    """Yield planners and readers of images on the host of a loop of 1 kHz or more that a device requires."""
    readers = {
        sink.full_name
        for interface in graph.cell.interfaces
        if interface.type.endswith(_IMAGES)
        for sink in interface.sinks
    }
    fast = {manager.host: manager for manager in graph.cell.managers if manager.update_rate_hz >= _FAST_HZ}
    for node in graph.cell.nodes:
        manager = fast.get(node.host)
        if manager is None or not node.host or not (node.package in _PLANNERS or node.full_name in readers):
            continue
        message = f"`{node.name}` {_does(node)} and must not run on `{node.host}`, beside a loop of"
        related = (Related("the loop", graph.cell.locate("control", "update_rate")),)
        yield found(graph, (*node.path, "host"), f"{message} {manager.update_rate_hz:g} Hz", related=related)


def _does(node: Node) -> str:
    return "plans" if node.package in _PLANNERS else "reads images"


@rule(Severity.WARNING)
def robot_off_control_card(graph: CellGraph) -> Findings:
    """Yield arms that want a dedicated link on a card without control."""
    dedicated = {d.name for d in graph.cell.devices if d.site.network is not None and d.site.network.dedicated_link}
    for device in graph.network.devices:
        nic = graph.network.nic_of(device)
        if device.device in dedicated and nic is not None and "control" not in nic.carries:
            message = f"`{device.device}` is on `{nic.full_name}`, which does not carry control"
            related = (Related("the card is here", graph.cell.locate(*nic.path, "carries")),)
            yield found(graph, (*device.path, "nic"), message, related=related)


@rule(Severity.ERROR)
def traffic_on_control_card(graph: CellGraph) -> Findings:
    """Yield cards that carry control and something else."""
    for nic in graph.network.nics:
        others = [kind for kind in nic.carries if kind != "control"]
        if "control" in nic.carries and others:
            message = f"`{nic.full_name}` carries control together with {', '.join(others)}"
            yield found(graph, (*nic.path, "carries"), message)


@rule(Severity.WARNING)
def unsuited_kernel(graph: CellGraph) -> Findings:
    """Yield hosts that run drivers for which real time is asked, with a generic or unknown kernel."""
    reported: set[str] = set()
    for device in graph.cell.devices:
        needs, link = device.site.network, device.site.connection
        if needs is None or link is None or needs.realtime == "not_needed" or link.host in reported:
            continue
        host = graph.cell.hosts.get(link.host)
        if host is not None and host.scheduling in ("generic", UNKNOWN):
            reported.add(link.host)
            message = f"`{link.host}` must have real-time scheduling for `{device.name}`, got `{host.scheduling}`"
            path = ("hosts", link.host, "scheduling")
            yield found(graph, path, message)
