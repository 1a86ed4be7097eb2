"""A trajectory controller drives joints that a planning group lacks.

A plan has the joints of its group. The controller that executes it refuses a goal that leaves joints of its own out,
unless it takes partial goals: planning succeeds, and every motion ends as a rejected goal.

Example that is reported:

```yaml
devices:
  side_arm: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
control: {controllers: {side: {type: joint_trajectory, device: side_arm, client: task, goal_time: 1 s,
                               path_tolerance: 0.1 rad 20 mm, goal_tolerance: 0.1 rad 10 mm}}}
motion: {groups: {side: {base: side_arm/base, tip: side_arm/arm}}}  # expect at side
```

Example that is accepted:

```yaml
devices:
  side_arm: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
control: {controllers: {side: {type: joint_trajectory, joints: [side_arm/turn], device: side_arm, client: task,
                               goal_time: 1 s, path_tolerance: 0.1 rad, goal_tolerance: 0.1 rad}}}
motion: {groups: {side: {base: side_arm/base, tip: side_arm/arm}}}
```

Fix: name under `joints:` of the controller those of the group, or plan for the whole chain.

Source: https://github.com/ros-controls/ros2_controllers/blob/4.25.0/joint_trajectory_controller/src/joint_trajectory_controller.cpp
(4.25.0): validate_trajectory_msg, "Joints on incoming trajectory don't match the controller joints."
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.vocabulary import TRAJECTORIES

_PARTIAL = "allow_partial_joints_goal"


@rule(Severity.ERROR, assumes=("group-without-joints", "tip-off-the-tool-chain"))
def check(graph: CellGraph) -> Findings:
    """Yield groups whose controllers want more joints than a plan of the group has."""
    for group in graph.cell.groups:
        for controller in graph.cell.controllers:
            executes = controller.label in group.controllers and controller.behaviour in TRAJECTORIES
            if not executes or controller.parameters.get(_PARTIAL) is True:
                continue
            lacking = [joint for joint in controller.joints if joint not in group.joints]
            if lacking:
                shown = ", ".join(f"`{joint}`" for joint in lacking[:3]) + (" and more" if lacking[3:] else "")
                message = f"`{controller.name}` drives {shown}, which group `{group.name}` lacks"
                yield found(graph, group.path, message)
