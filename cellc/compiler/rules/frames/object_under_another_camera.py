"""An object hangs on one camera, and its images come from another.

The node that publishes the frame hears only the other camera. What it measures in one image is placed in front of the
wrong lens, often a meter away.

Example that is reported:

```yaml
# a cell of two cameras
frames:
  object: {parent: second/color_optical}  # expect at parent
```

Example that is accepted:

```yaml
# a cell of two cameras
frames:
  object: {parent: camera/color_optical}
```

Fix: name the camera whose images the publisher reads.

Source: docs/principles.md#transforms-at-the-time-of-observation
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames under a camera whose publisher hears other cameras, and not this one."""
    cameras = {device.name: device for device in graph.cell.devices if device.camera is not None}
    owners = {frame: name for name, device in cameras.items() for frame in device.frames.values()}
    for frame in graph.cell.frames:
        own = owners.get(frame.parent)
        if frame.kind is not FrameKind.DYNAMIC or own is None:
            continue
        heard = {
            source.node: interface
            for interface in graph.cell.interfaces
            if interface.kind is InterfaceKind.TOPIC and any(sink.node == frame.authority for sink in interface.sinks)
            for source in interface.sources
            if source.node in cameras
        }
        if heard and own not in heard:
            other, interface = next(iter(heard.items()))
            message = f"`{frame.name}` hangs on `{own}`, but its publisher `{frame.authority}` hears `{other}` alone"
            missed = (
                interface for interface in graph.cell.interfaces if own in {source.node for source in interface.sources}
            )
            readers = [(interface, "its images"), *((interface, f"the images of `{own}`") for interface in missed)]
            related = tuple(Related(label, graph.cell.locate(*one.path, "to")) for one, label in readers)
            yield found(graph, (*frame.path, "parent"), message, related=related)
