"""One child frame has two authorities.

tf2 keeps whatever arrived last. With two publishers for one child the frame flickers between two poses, and a grasp
lands between them. No node reports it.

Example that is reported:

```yaml
frames:
  camera_link: {parent: world, xyz: 0 0 1 m, designed: true}  # expect at camera_link
```

Example that is accepted:

```yaml
frames:
  camera_stand: {parent: world, xyz: 0 0 1 m, designed: true}
```

Fix: rename one of the two frames, or delete the one that repeats what another publishes.

Source:

- docs/principles.md#one-authority-for-each-frame
- https://www.ros.org/reps/rep-0105.html (as of 2025-10-24): each frame has one parent
"""

from __future__ import annotations

from cellc.compiler.cell.frame import WORLD, FrameKind
from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, Severity, rule


@rule(Severity.ERROR, assumes=("shared-prefix",))
def check(graph: CellGraph) -> Findings:
    """Yield every edge after the first for one child frame."""
    for name in graph.frames.names():
        first, *others = graph.frames.authorities(name)
        for frame in others:
            if frame.kind is FrameKind.LINK and frame.device == first.device:
                continue  # inside one description this is a link with two parents
            message = f"frame `{name}` is published by `{first.authority}` and again by `{frame.authority}`"
            related = (Related(f"`{name}` already hangs on `{first.parent or WORLD}` here", first.span),)
            yield Finding(message, frame.span, frame.path, related=related)
