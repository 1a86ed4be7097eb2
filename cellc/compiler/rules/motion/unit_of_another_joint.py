"""A figure of a joint is a length where the joint turns, or an angle where it slides.

Numbers reach the controller in rad or m, whatever unit they were written in: `-1571 mm` would turn a wrist by 1.57 rad,
and `90 deg` drive a rail by 1.57 m. A tolerance of `10 mm` on a wrist allows 0.01 rad. In a group of both
kinds each value has its unit behind it, as in `400 mm 0 -90 90 deg`; a tolerance has a figure for each kind, as in
`0.2 rad 5 mm`.

Example that is reported:

```yaml
motion:
  poses: {home: {manipulator: 0 -1571 1571 -1571 -1571 0 mm}}  # expect at manipulator
```

Example that is accepted:

```yaml
motion:
  poses: {home: {manipulator: 0 -90 90 -90 -90 0 deg}}
```

Fix: write an angle for a joint that turns and a length for one that slides, several as in `400 mm 0 -90 90 deg`.

Source: https://www.ros.org/reps/rep-0103.html (REP 103, 2010): lengths in meters, angles in radians
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule
from cellc.compiler.rules.tolerances import stated


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each figure whose unit is not that of its joint, once for each place."""
    joints = {joint.name: joint for device in graph.cell.devices for joint in device.joints}
    seen = set[YamlPath]()
    for path, name, linear in _figures(graph.cell):
        joint = joints.get(name)
        if joint is None or joint.slides == linear:
            continue
        named = (*path, f"{joint.path[-1]}/{joint.local_name}")  # a tolerance by joint
        at = named if graph.cell.states(*named) else path
        if at not in seen:
            seen.add(at)
            units = "`m` or `mm`" if joint.slides else "`rad` or `deg`"
            got = graph.cell.text(*at)
            yield found(graph, at, f"`{path[-1]}` must be in {units} for `{name}`, which is {joint.type}, got {got}")


def _figures(cell: Cell) -> Iterator[tuple[YamlPath, str, bool]]:
    """Yield the place of a figure, its joint, and whether it is a length."""
    for pose in cell.poses:
        if len(pose.joints) == len(pose.linear):
            yield from ((pose.path, name, linear) for name, linear in zip(pose.joints, pose.linear, strict=True))
    for controller in cell.controllers:
        for key, figures in stated(controller):
            yield from (((*controller.path, key), name, one.linear) for name, one in (figures or {}).items())
    for device in cell.devices:
        if device.adapter is not None and device.adapter.path_tolerance is not None:
            at: YamlPath = (*device.path, "adapter", "path_tolerance")
            fits = [joint.slides for joint in device.actuated_joints]
            linear = device.adapter.path_tolerance.linear
            # One figure is said of all joints: where a device has both kinds, it is that of one of them.
            yield from ((at, joint.name, linear) for joint in device.actuated_joints if linear not in fits)
    yield from _of_one_joint(cell)


def _of_one_joint(cell: Cell) -> Iterator[tuple[YamlPath, str, bool]]:
    first = cell.bringup.first_motion
    if first is not None:
        joints = {f"{device.name}/{joint.local_name}": joint.name for device in cell.devices for joint in device.joints}
        name = joints.get(first.joint, "")
        for key, figure in (("max_delta", first.max_delta), ("velocity", first.velocity)):
            yield ("bringup", "first_motion", key), name, figure.linear
    for rehearsal in cell.rehearsals:
        for fault in rehearsal.faults:
            for key, moved in (("by", fault.displacement), ("to", fault.velocity)):
                if moved is not None:
                    yield (*fault.path, key), fault.name, fault.linear
