"""The poses of an object are said in another frame than the object hangs in.

One node publishes both, the frame of the object and the topic of its poses. Where the tree has the object in the
camera's frame and the topic says `world`, one of them is wrong: numbers of the camera are read as places in the world.

Example that is reported:

```yaml
interfaces: {/object_pose: {frame: world}}  # expect at frame
```

Example that is accepted:

```yaml
interfaces: {/object_pose: {frame: camera/color_optical}}
```

Fix: write the frame that the node stamps its poses with, or hang the object in the frame that it transforms to.

Source: docs/principles.md#command-contracts
"""

from __future__ import annotations

from cellc.compiler.cell.frame import FrameKind
from cellc.compiler.cell.interface import Interface
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_POSES = frozenset(
    {
        "geometry_msgs/msg/PointStamped",
        "geometry_msgs/msg/PoseArray",
        "geometry_msgs/msg/PoseStamped",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
    }
)


@rule(Severity.WARNING, assumes=("camera-data-in-body-frame", "object-under-another-camera"))
def check(graph: CellGraph) -> Findings:
    """Yield the poses of a node that publishes frames, where all are said in frames that none of those is in."""
    topics = [
        interface
        for interface in graph.cell.interfaces
        if interface.type in _POSES and not interface.derived and interface.frame is not None
    ]
    published_by: dict[str, set[str | None]] = {}
    for interface in topics:
        for name in _names(interface):
            published_by.setdefault(name, set()).add(interface.frame)
    dynamic = [frame for frame in graph.cell.frames if frame.kind is FrameKind.DYNAMIC]
    for interface in topics:
        names = _names(interface)
        own = [item for item in dynamic if item.authority in names]
        published = set[str | None]().union(*(published_by[name] for name in names))
        if own and published.isdisjoint({name for frame in own for name in (frame.name, frame.parent)}):
            message = f"`{interface.name}` must be in `{own[0].parent}`, in which its node has `{own[0].name}`,"
            related = (Related("the frame of the object", own[0].span),)
            yield found(graph, (*interface.path, "frame"), f"{message} got `{interface.frame}`", related=related)


def _names(interface: Interface) -> set[str]:
    return {name for source in interface.sources for name in (source.node, source.full_name)}
