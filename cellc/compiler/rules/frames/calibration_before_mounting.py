"""A calibration is older than the mounting of what it measured.

A camera that was taken off, a tool that was changed or a finger that was exchanged is elsewhere afterwards,
by more than the residual of the measurement. The old figures go on being used, and no tool of ROS knows of either day.

Example that is reported:

```yaml
devices:
  camera: {mount: {since: 2026-07-20}}
calibrations:
  hand_eye: {measured: 2026-07-01}  # expect at measured
```

Example that is accepted:

```yaml
devices:
  camera: {mount: {since: 2026-06-20}}
calibrations:
  hand_eye: {measured: 2026-07-01}
```

Fix: measure again, with a new revision, or correct the date.

Source: docs/principles.md#calibration
"""

from __future__ import annotations

from collections.abc import Container

from cellc.compiler.cell.frame import Frame, FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield calibrations of a mount, or of a frame on a device that is mounted on another, from before that day."""
    carried = {name for device in graph.cell.devices for name in device.carries}
    for frame in graph.cell.frames:
        calibration = graph.cell.calibrations.get(frame.calibration or "")
        name = _moved(graph, frame, carried)
        if calibration is None or calibration.measured_on is None or name is None:
            continue
        device = graph.cell.device(name)
        if device.mounted_on is not None and calibration.measured_on < device.mounted_on:
            message = f"`{calibration.name}` must be measured after `{device.name}` was mounted, on"
            message += f" {device.mounted_on}, got {calibration.measured_on}"
            related = (Related("mounted since then", graph.cell.locate(*device.path, "mount", "since")),)
            yield found(graph, (*calibration.path, "measured"), message, related=related)


def _moved(graph: CellGraph, frame: Frame, carried: Container[str | None]) -> str | None:
    """Return the device whose mounting moves a measured frame: its own, or the tool on which it is fixed."""
    if frame.kind is FrameKind.MOUNT:
        return frame.device
    carrier = graph.frames.get(frame.parent)
    name = None if carrier is None else carrier.device
    return name if name in carried else None
