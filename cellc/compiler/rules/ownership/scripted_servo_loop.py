"""A Python node closes a servo loop.

A publish rate is not a deadline. An interpreter with garbage collection and a shared executor misses cycles, and the
arm follows references that stop and jump.

Example that is reported:

```yaml
nodes:
  follower: {run: cell_tasks/follower, host: control_pc, owner: integration, language: python}
interfaces:
  /arm_forward/commands: {topic: std_msgs/msg/Float64MultiArray,  # expect: unstamped-age-limit at topic
                          from: {follower: {depth: 1}},  # expect at follower
                          to: {arm_forward: {depth: 1}}, unit: rad,  # expect: motion-over-topic at arm_forward
                          wants: newest, rate: 250 Hz, max_age: 20 ms,
                          on_stale: stop_and_hold}
control:
  controllers:
    arm_forward: {type: forward_command, device: arm, client: follower, active: false,
                  parameters: {interface_name: position}}
  switches:
    to_forward: {activate: [arm_forward], deactivate: [arm_trajectory]}
```

Example that is accepted:

```yaml
nodes:
  follower: {run: cell_tasks/follower, host: control_pc, owner: integration, language: python,
             lifecycle: true}
```

Fix: leave the loop to a controller or to the vendor's servo, and send goals or trajectories.

Source: docs/principles.md#servo-loops
"""

from __future__ import annotations

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_SERVO_HZ = 100.0  # above it a reference stream is a servo loop, below it a set point


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield Python nodes that stream references to a controller at a servo rate."""
    scripted = {node.name: node for node in graph.cell.nodes if node.language == "python"}
    for interface in graph.cell.interfaces:
        commanded = any(sink.node in graph.data.commanders for sink in interface.sinks)
        if interface.kind is not InterfaceKind.TOPIC or not commanded or (interface.rate_hz or 0.0) < _SERVO_HZ:
            continue
        for source in interface.sources:
            if source.node in scripted:
                message = (
                    f"Python node `{source.node}` streams references on `{interface.name}` at {interface.rate_hz:g} Hz"
                )
                yield found(graph, source.path, message)
