"""Two devices are switched by one output.

The lamp lights and the gripper opens. Nothing refuses it: both share one interface, and a client that sets it for one
of them sets the other.

Example that is reported:

```yaml
# a cell of wired outputs
devices:
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
         switching: {outputs: {light: io/io/out_0}}}
  beacon: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 2 m}, revision: A,
           switching: {outputs: {light: io/io/out_0}}}  # expect at light
```

Example that is accepted:

```yaml
# a cell of wired outputs
devices:
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
         switching: {outputs: {light: io/io/out_0}}}
  beacon: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 2 m}, revision: A,
           switching: {outputs: {light: io/io/out_1}}}
```

Fix: wire each to an output of its own.

Source: docs/principles.md#digital-signals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second use of an output, by another device or by the same."""
    first: dict[str, YamlPath] = {}
    for device in graph.cell.devices:
        outputs = {} if device.switched is None else device.switched.outputs
        for name, interface in outputs.items():
            path = (*device.path, "switching", "outputs", name)
            owner = first.setdefault(interface, path)
            if owner != path:
                message = f"`{device.name}` must have an output of its own, got `{interface}` of `{owner[1]}`"
                yield found(graph, path, message, related=(Related("first used here", graph.cell.locate(*owner)),))
