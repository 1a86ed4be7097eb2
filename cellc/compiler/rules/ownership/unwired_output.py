"""A device is switched by an output that is wired to nothing.

Its states stand in the catalog, and how it is switched is a fact of the cell: without a wire a step that sets it does
nothing.

Example that is reported:

```yaml
devices:
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A}  # expect at lamp
```

Example that is accepted:

```yaml
# a cell of wired outputs
devices:
  lamp: {model: ./demo_lamp, mount: {parent: world, xyz: 0 2 1 m}, revision: A,
         switching: {outputs: {light: io/io/out_0}}}
```

Fix: state the command interface that drives it, as `device/gpio/interface`, under `switching: {outputs: …}`.

Source: docs/principles.md#digital-signals
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield each device with the outputs that it needs and that nothing drives."""
    for device in graph.cell.devices:
        switched = device.switched
        absent = [] if switched is None else [name for name in switched.signals if name not in switched.outputs]
        if absent:
            names = " and ".join(f"`{name}`" for name in absent)
            yield found(graph, (*device.path, "switching", "outputs"), f"nothing drives {names} of `{device.name}`")
