"""The tip of a group does not hang on the arm's tool frame.

Goals place the tip. A tip that branches off before the tool frame leaves out the last joints or the tool, so the
fingers arrive somewhere else.

Example that is reported:

```yaml
motion:
  groups:
    elbow: {base: arm/base_link, tip: arm/link_4}  # expect at tip
```

Example that is accepted:

```yaml
motion:
  groups:
    flange: {base: arm/base_link, tip: arm/tool0}
```

Fix: use the tool frame of the arm or a frame that hangs on it, and mount tools there.

Source: https://gavanderhoorn.github.io/rep/rep-0199.html (draft of 2019-01-11): tools mount at tool0, child of flange
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield groups of an arm with a tip that does not come after its tool frame."""
    arms = {
        link.name: device for device in graph.cell.devices if device.tool_frame for link in device.description.links
    }
    for group in graph.cell.groups:
        arm = arms.get(group.base_link)
        if arm is None or arm.tool_frame is None:
            continue
        chain = graph.frames.chain(group.tip_frame)
        if arm.tool_frame not in (frame.name for frame in chain):
            message = f"tip `{group.tip_frame}` of group `{group.name}` does not hang on `{arm.tool_frame}`"
            mounts = [frame for frame in chain if frame.kind is FrameKind.MOUNT and frame.device != arm.name]
            related = tuple(Related(f"`{mount.device}` is mounted on `{mount.parent}`", mount.span) for mount in mounts)
            yield found(graph, (*group.path, "tip"), message, related=related)
