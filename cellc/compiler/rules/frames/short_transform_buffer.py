"""The history of a frame is shorter than the age of what is looked up in it.

A lookup at the stamp of an old but allowed sample falls before the buffer begins and fails with an extrapolation
error, now and then, under load.

Example that is reported:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz, buffer: 100 ms}  # expect at buffer
```

Example that is accepted:

```yaml
frames:
  part: {parent: world, dynamic: true, published_by: perception, rate: 10 Hz, buffer: 10 s}
```

Fix: make the buffer at least as long as the `max_age` of what its publisher sends, or leave it out for 10 s.

Source:

- docs/principles.md#transforms-at-the-time-of-observation
- https://github.com/ros2/geometry2/blob/f390ccee31de4cdd9e1f54a160970d9fca813055/tf2/include/tf2/buffer_core.hpp
  (f390cce): a buffer keeps 10 s by default
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield dynamic frames whose buffer ends before the oldest sample that their publisher's users may use."""
    for frame in graph.cell.frames:
        if frame.kind is not FrameKind.DYNAMIC or frame.buffer_s is None:
            continue
        for interface in graph.cell.interfaces:
            sent = any(source.node == frame.authority for source in interface.sources)
            if sent and interface.max_age_s is not None and interface.max_age_s > frame.buffer_s:
                message = (
                    f"`buffer` of `{frame.name}` must be at least {interface.max_age_s:g} s, "
                    f"the `max_age` of `{interface.name}`, got {frame.buffer_s:g} s"
                )
                related = (Related("the age is allowed here", graph.cell.locate(*interface.path, "max_age")),)
                yield found(graph, (*frame.path, "buffer"), message, related=related)
                break
