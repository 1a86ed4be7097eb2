"""An interface type does not exist in the pinned distribution.

The type was added or removed between distributions, so the node does not build, or two parts of the cell speak
different types under one name.

Example that is reported:

```yaml
interfaces:
  /squeeze: {action: control_msgs/action/ParallelGripperCommand, server: squeezer, client: task,  # expect at action
             frame: world,
             timeout: 5 s, on_timeout: cancel_and_hold, cancel_within: 200 ms}
versions: {os: ubuntu 22.04, ros: humble, rmw: rmw_fastrtps_cpp 6.2.10, ros2_control: 2.54.0, moveit: 2.5.9}
nodes: {squeezer: {run: cell_tasks/squeezer, host: control_pc, owner: integration}}
control: {controllers: {gripper_action: null}}
# expect: version-outside-matrix at devices.arm.driver
# expect: gripper-without-controller at rehearsals.pick_and_place.steps.3.grip
```

Example that is accepted:

```yaml
interfaces:
  /squeeze: {action: control_msgs/action/ParallelGripperCommand, server: squeezer, client: task, frame: world,
             timeout: 5 s, on_timeout: cancel_and_hold, cancel_within: 200 ms}
nodes: {squeezer: {run: cell_tasks/squeezer, host: control_pc, owner: integration}}
```

Fix: use the type of the distribution that the cell pins.

Source: docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.graph.data_flow import interface_types
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield known types that the distribution does not have."""
    known = interface_types()
    for interface in graph.cell.interfaces:
        facts = known.get(interface.type)
        if facts is not None and facts.only and graph.cell.distro not in facts.only and not interface.derived:
            message = f"`{interface.type}` does not exist in {graph.cell.distro}"
            names = ", ".join(facts.only)
            yield found(
                graph, (*interface.path, interface.kind.value), message, f"it exists in {names}; use another type"
            )
