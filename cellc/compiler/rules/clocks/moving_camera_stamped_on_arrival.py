"""A camera moves, and its images are stamped when they arrive.

Between exposure and arrival lie the exposure itself, the readout, the cable and the driver. The camera was elsewhere by
then: at 250 mm/s an image that arrives 80 ms late puts the object 20 mm beside its place, in the direction of motion.

Example that is reported:

```yaml
devices:
  camera: {stamp: {source: arrival}}  # expect at source
```

Example that is accepted:

```yaml
devices:
  camera: {stamp: {source: hardware}}
```

Fix: let the camera or its driver stamp the middle of the exposure, or mount it where nothing moves it.

Source: docs/principles.md#clocks-and-age
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield cameras that a joint carries and whose stamps are those of the arrival."""
    mounts = {frame.device: frame for frame in graph.cell.frames if frame.kind is FrameKind.MOUNT}
    for device in graph.cell.devices:
        mount = mounts.get(device.name)
        if device.camera is None or device.stamp is None or device.stamp.source != "arrival" or mount is None:
            continue
        moved = next((frame for frame in graph.frames.chain(mount.name) if frame.moving), None)
        if moved is not None:
            message = f"the stamp of `{device.name}` must be that of the exposure, as `{moved.device}` moves it,"
            message += " got `arrival`"
            related = (Related(f"it is mounted on `{mount.parent}`", mount.span),)
            yield found(graph, (*device.path, "stamp", "source"), message, related=related)
