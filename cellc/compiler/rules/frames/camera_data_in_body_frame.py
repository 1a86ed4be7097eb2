"""Camera data is declared in a frame that is not optical.

Pixels and depths are in an optical frame: z forward, x right, y down. In the body frame of the camera the same
numbers point sideways, and the object appears a quarter turn away.

Example that is reported:

```yaml
interfaces:
  /camera/camera/color/image_raw: {frame: camera/link}  # expect at frame
```

Example that is accepted:

```yaml
interfaces:
  /camera/camera/color/image_raw: {frame: camera/color_optical}
```

Fix: name the optical frame of the stream.

Source:

- https://www.ros.org/reps/rep-0103.html (as of 2025-10-24): suffix frames
- https://www.ros.org/reps/rep-0104.html (as of 2025-10-24): the frame of camera_info is the optical frame
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/CameraInfo")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield image topics of a camera in a frame other than its optical ones."""
    cameras = {device.name: device for device in graph.cell.devices if device.optical_frames}
    for interface in graph.cell.interfaces:
        source = next((cameras[end.node] for end in interface.sources if end.node in cameras), None)
        if source is None or interface.frame is None or interface.type not in _IMAGES:
            continue
        optical = {source.frames[name] for name in source.optical_frames}
        if interface.frame not in optical:
            message = f"`{interface.name}` carries images in `{interface.frame}`, which is not an optical frame"
            names = ", ".join(f"`{source.name}/{name}`" for name in source.optical_frames)
            yield found(graph, (*interface.path, "frame"), message, f"use one of {names}")
