"""An adapter publishes the joints of its device where robot_state_publisher does not hear them.

robot_state_publisher makes transforms of the joints on `/joint_states`, and MoveIt takes its current state from there.
On another topic no reader gets them: every frame of the arm stays fixed on the real target, or is there
not at all, while the mock, which reads the adapter itself, shows them moving.

Example that is reported:

```yaml
# a cell of adapted arms
interfaces:
  /side_arm/joint_states: {topic: sensor_msgs/msg/JointState, from: side_arm, to: {task: {depth: 1}},  # expect at from
                           wants: newest, rate: 250 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Example that is accepted:

```yaml
# a cell of adapted arms
interfaces:
  /joint_states: {topic: sensor_msgs/msg/JointState, from: [side_arm, joint_states],
                  to: {task: {depth: 1}, move_group: {depth: 1}, robot_state_publisher: {depth: 1}},
                  wants: newest, rate: 250 Hz, max_age: 100 ms, on_stale: reject_goal}
```

Fix: publish on `/joint_states`, beside the broadcasters, and name robot_state_publisher among those who read it.

Source: docs/principles.md#direct-sdk
"""

from __future__ import annotations

from cellc.compiler.link.frames import ROBOT_STATE_PUBLISHER
from cellc.compiler.link.hardware import JOINT_STATES
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield state topics of adapters that robot_state_publisher does not read."""
    topics = {interface.name: interface for interface in graph.cell.interfaces}
    for adapted in graph.cell.adapters:
        topic = topics[adapted.state_topic]
        readers = {sink.node for sink in topic.sinks}
        if topic.name != JOINT_STATES or ROBOT_STATE_PUBLISHER not in readers:
            message = f"robot_state_publisher must hear the joints of `{adapted.device}` on `{JOINT_STATES}`"
            yield found(graph, (*topic.path, "from"), f"{message}, got `{topic.name}`")
