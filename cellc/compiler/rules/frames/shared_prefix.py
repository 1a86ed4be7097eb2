"""Two devices have links and joints of the same names.

Both descriptions are published under one prefix: tf2 mixes their frames, and one controller claims the joints of the
other arm. Every later error about a doubled frame or claim follows from this one.

Example that is reported:

```yaml
devices:
  second_arm: {model: ./demo_arm, mount: {parent: world, xyz: 0 3 0.8 m}, revision: A,
               prefix: arm_,  # expect at prefix
               firmware: controller 5.21.0, driver: demo_arm_driver 3.8.0, sdk: demo_arm_client 2.14.1,
               description: demo_arm_description 3.5.1, limits: {velocity: 50 %, acceleration: 50 %}}
```

Example that is accepted:

```yaml
devices:
  second_arm: {model: ./demo_arm, mount: {parent: world, xyz: 0 3 0.8 m}, revision: A,
               prefix: second_,
               firmware: controller 5.21.0, driver: demo_arm_driver 3.8.0, sdk: demo_arm_client 2.14.1,
               description: demo_arm_description 3.5.1, limits: {velocity: 50 %, acceleration: 50 %}}
```

Fix: give each of the devices a `prefix:` of its own, or leave it out.

Source: docs/principles.md#one-authority-for-each-frame
"""

from __future__ import annotations

from cellc.compiler.cell.device import Device
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield the second device of those with a link in common, with all others that have one."""
    owners: dict[str, Device] = {}
    reported: set[str] = set()
    for device in graph.cell.devices:
        links = [link.name for link in device.description.links]
        first = next((owners[name] for name in links if name in owners), None)
        if first is not None and device.name not in reported:
            reported.add(device.name)
            shared = [name for name in links if owners.get(name) is first]
            more = f" and {len(shared) - 1} more" if len(shared) > 1 else ""
            prefix = f"prefix `{device.prefix}`" if device.prefix else "empty prefix"
            message = f"`{device.name}` must have names of its own, but with its {prefix} link `{shared[0]}`{more}"
            related = (Related("the other device", graph.cell.locate(*first.path, "prefix")),)
            path = (*device.path, "prefix")
            yield found(graph, path, f"{message} is also one of `{first.name}`", related=related)
        for name in links:
            owners.setdefault(name, device)
