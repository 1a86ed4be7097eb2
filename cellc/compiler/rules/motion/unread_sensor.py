"""A motion rests on a switched state that its sensor was not asked for.

A valve that was switched is not a gripper that is closed, and a door that was shut yesterday may be open. The device
has a sensor that is wired, and the first motion after it was switched does not wait for it; of a device that no output
switches, such as a door, the first motion at all.

Example that is reported:

```yaml
# a cell of wired outputs
devices:
  clamp: {model: ./demo_clamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
          switching: {outputs: {valve: io/io/out_0}, inputs: {closed: io/io/in_0}, power_lost: holds}}
rehearsals:
  clamped: {steps: [{set: clamp, state: closed}, move: home]}  # expect at move
```

Example that is accepted:

```yaml
# a cell of wired outputs
devices:
  clamp: {model: ./demo_clamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
          switching: {outputs: {valve: io/io/out_0}, inputs: {closed: io/io/in_0}, power_lost: holds}}
rehearsals:
  clamped: {steps: [{set: clamp, state: closed}, {sense: clamp, state: closed}, move: home]}
```

Fix: add a step that senses the state before the move.

Source: docs/principles.md#digital-signals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the first move of each rehearsal that comes before the sensor of a device is read."""
    sensed = {device.name: one for device in graph.cell.devices if (one := device.switched) is not None and one.inputs}
    reported: set[tuple[YamlPath, str]] = set()
    for rehearsal in graph.cell.rehearsals:
        # What no output switches may be in any state at first; the others are where their outputs have them.
        unread = {name: "" for name, one in sensed.items() if not one.signals}
        for step in rehearsal.steps:
            if step.kind == "set" and step.name in sensed and step.state in sensed[step.name].told_states:
                unread[step.name] = step.state or ""
            elif step.kind == "sense":
                unread.pop(step.name, None)
            elif step.kind == "move":
                for name, state in unread.items():
                    if (step.path, name) not in reported:
                        reported.add((step.path, name))
                        after = f"`{name}` was set to `{state}`" if state else "the cell started"
                        wanted = state or "…"
                        message = f"`{step.name}` is approached after {after} without a look at the sensor of `{name}`"
                        help_ = f"add the step `{{sense: {name}, state: {wanted}}}` before it"
                        yield found(graph, step.path, message, help_)
                unread.clear()
