"""Nothing feeds the occupancy map that plans are to keep clear of.

move_group subscribes to the data of the map, and is silent when none arrives: it plans through obstacles as if the
space were empty. A depth image is of no use without the camera info beside it.

Example that is reported:

```yaml
motion:
  octomap: {source: /camera/camera/color/image_raw, resolution: 25 mm, range: 2 m, padding: 30 mm}  # expect at source
```

Example that is accepted:

```yaml
nodes:
  cloud: {run: cell_cloud/maker, host: control_pc, owner: perception}
interfaces:
  /cloud:
    topic: sensor_msgs/msg/PointCloud2
    from: cloud
    to: {move_group: {reliability: best_effort, depth: 1}}
    wants: newest
    frame: camera/color_optical
    rate: 5 Hz
    max_age: 500 ms
    on_stale: reject_goal
motion:
  octomap: {source: /cloud, resolution: 25 mm, range: 2 m, padding: 30 mm}
```

Fix: name a depth image or point cloud among the interfaces, with `move_group` in its `to`; of an image, its camera info
too.

Source: https://github.com/moveit/moveit2/releases/tag/2.12.4 (2.12.4): occupancy_map_monitor, octomap updaters
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.motion import DEPTH_IMAGE, POINT_CLOUD, Octomap
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_PLANNER = ("moveit_ros_move_group", "move_group")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a map without a planner, without data, or whose data the planner does not hear."""
    octomap = graph.cell.octomap
    if octomap is None:
        return
    path = ("motion", "octomap", "source")
    planners = {node.name for node in graph.cell.nodes if (node.package, node.executable) == _PLANNER}
    if not planners:
        yield found(graph, path, "the occupancy map needs a node that runs move_group")
        return
    topics = {interface.name: interface for interface in graph.cell.interfaces}
    absent = (_absent(name, name == octomap.source, topics.get(name), planners) for name in _needed(octomap, topics))
    if message := next(filter(None, absent), ""):
        yield found(graph, path, message)


def _absent(name: str, is_source: bool, heard: Interface | None, planners: set[str]) -> str:
    """Return what keeps a topic from the map; empty where it is heard."""
    if heard is None:
        return f"the occupancy map needs `{name}`, which must be an interface of this cell"
    if is_source and heard.type not in (DEPTH_IMAGE, POINT_CLOUD):
        return f"`{name}` must be a depth image or a point cloud, got {heard.type}"
    listens = planners & {end.node for end in heard.sinks}
    return "" if listens else f"`{name}` must have {' or '.join(sorted(planners))} in its `to`"


def _needed(octomap: Octomap, topics: dict[str, Interface]) -> Iterator[str]:
    """Yield the source, and the camera info that a depth image needs."""
    yield octomap.source
    source = topics.get(octomap.source)
    if source is not None and source.type == DEPTH_IMAGE:
        yield f"{octomap.source.rpartition('/')[0]}/camera_info"
