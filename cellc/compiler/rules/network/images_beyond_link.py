"""The images of the cell fill a link between two computers.

Raw images travel whole, to each computer that reads or records them. Where they take what the link has, everything
beside them waits: poses and states come late, and best-effort images with a part lost are thrown away as a whole.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  control_pc: {nics: {cell: {speed: 100 Mbit/s}}}  # expect at speed
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  control_pc: {nics: {cell: {speed: 1 Gbit/s}}}
```

Fix: read and record the images where the camera is, take smaller ones or fewer, or a faster link.

Source: https://docs.ros.org/en/jazzy/How-To-Guides/DDS-tuning.html
(Jazzy): large messages over lossy connections; a fifth of the link is kept free for headers, repeats and all else
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from cellc.compiler.cell.interface import Interface
from cellc.compiler.graph.network import Nic, running_hosts
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_ASSUMED_BPS = 1e9
_SHARE = 0.8


@rule(Severity.WARNING, assumes=("malformed-address", "missing-ros-card", "ros-cards-apart"))
def check(graph: CellGraph) -> Findings:
    """Yield cards whose images, as the cameras send them, take more than a share of their link."""
    loads: dict[str, list[tuple[Nic, Interface, float]]] = defaultdict(list)
    for nic, interface, rate_bps in _crossings(graph):
        loads[nic.full_name].append((nic, interface, rate_bps))
    for name, carried in loads.items():
        nic, total_bps = carried[0][0], sum(rate_bps for _, _, rate_bps in carried)
        speed_bps = nic.speed_bps or _ASSUMED_BPS
        if total_bps <= speed_bps * _SHARE:
            continue
        link = "its" if nic.speed_bps else "an assumed"
        message = f"the images on `{name}` must take at most {speed_bps * _SHARE / 1e6:g} Mbit/s of {link}"
        message += f" {speed_bps / 1e6:g} Mbit/s, and take {total_bps / 1e6:.0f} Mbit/s"
        topics = {interface.name: interface for _, interface, _ in carried}
        related = tuple(Related(f"`{topic}` goes over it", one.span) for topic, one in topics.items())
        yield found(graph, (*nic.path, "speed"), message, related=related)


def _crossings(graph: CellGraph) -> Iterator[tuple[Nic, Interface, float]]:
    """Yield the card of either end of each stream that another computer reads or records, with what it takes there."""
    running = running_hosts(graph.cell)
    recorders = {nic.host for nic in graph.network.nics if "bag" in nic.carries}
    cameras = {device.name: device for device in graph.cell.devices if device.camera is not None}
    for interface in graph.cell.interfaces:
        camera = next((cameras[source.node] for source in interface.sources if source.node in cameras), None)
        streams = () if camera is None or camera.camera is None else camera.camera.streams
        image = next((stream for stream in streams if stream.topic == interface.name and stream.image_bytes), None)
        if camera is None or image is None or image.image_bytes is None:
            continue
        rate_bps = image.image_bytes * 8.0 * min(interface.rate_hz or image.rate_hz, image.rate_hz)
        readers = {running.get(sink.full_name, "") for sink in interface.sinks}
        if interface.name in graph.cell.recording.topics and camera.host not in recorders:
            readers |= recorders
        readers -= {camera.host, ""}
        for reader in sorted(readers):
            for nic in _way(graph, camera.host, reader):
                yield nic, interface, rate_bps


def _way(graph: CellGraph, one: str, other: str) -> tuple[Nic, ...]:
    """Return the cards over which two hosts talk ROS: the first two that share a subnet."""
    for ours in graph.network.ros_cards(one):
        for theirs in graph.network.ros_cards(other):
            assert ours.interface is not None
            assert theirs.interface is not None
            if ours.interface.network.overlaps(theirs.interface.network):
                return ours, theirs
    return ()
