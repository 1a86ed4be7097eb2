"""The TCP of a robot is not fixed to its tool frame.

The robot holds its TCP as a fixed transform from the frame where tools mount. A frame elsewhere in the cell, on another
arm, or one that a node publishes cannot be set in it; the point typed in at the pendant is then another one.

Example that is reported:

```yaml
devices: {arm: {tcp: fixture_A}}  # expect at tcp
```

Example that is accepted:

```yaml
devices: {arm: {tcp: tcp}}
```

Fix: name a frame that hangs on the tool frame of this arm by fixed transforms.

Source: https://gavanderhoorn.github.io/rep/rep-0199.html (draft of 2019-01-11): tools mount at tool0, child of flange
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("frame-cycle",))
def check(graph: CellGraph) -> Findings:
    """Yield TCPs that no fixed transform places in the tool frame of their arm."""
    for device in graph.cell.devices:
        if device.tcp is None:
            continue
        path = (*device.path, "tcp")
        if device.tool_frame is None:
            yield found(graph, path, f"`{device.name}` has no frame where tools mount")
            continue
        chain = [frame.name for frame in graph.frames.chain(device.tcp)]
        tool = device.tool_frame in chain
        between = graph.frames.chain(device.tcp)[: chain.index(device.tool_frame)] if tool else ()
        if not tool or any(frame.moving or frame.transform_to_parent is None for frame in between):
            message = f"the TCP of `{device.name}` must hang on `{device.tool_frame}` by fixed transforms"
            yield found(graph, path, f"{message}, got `{device.tcp}`")
