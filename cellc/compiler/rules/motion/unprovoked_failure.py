"""A rehearsal expects a failure that nothing provokes.

Without an injected fault the run succeeds, or it fails for an unintended reason. The same holds for a fault
that comes when the run is over, and for a frozen camera other than the one that the parts are detected with.

Example that is reported:

```yaml
rehearsals:
  odd: {steps: [move: home], expect: stale_state}  # expect at expect
```

Example that is accepted:

```yaml
rehearsals:
  odd: {steps: [move: home, detect: object, move: pick], inject: {freeze: camera, at: 1 s}, expect: stale_state}
```

Fix: add `inject:` with the fault that leads to the expected outcome.

Source: docs/principles.md#rehearsals
"""

from __future__ import annotations

from cellc.compiler.cell.motion import Rehearsal
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.WARNING, assumes=("object-under-another-camera",))
def check(graph: CellGraph) -> Findings:
    """Yield rehearsals that expect a failure and inject nothing, or nothing that can lead to it."""
    for rehearsal in graph.cell.rehearsals:
        if rehearsal.expect == "succeeded":
            continue
        if not rehearsal.faults:
            message = f"`{rehearsal.name}` expects `{rehearsal.expect}`, but nothing provokes it"
            yield found(graph, (*rehearsal.path, "expect"), message)
        elif all((fault.at_s or 0.0) >= rehearsal.timeout_s for fault in rehearsal.faults):
            fault = rehearsal.faults[0]
            message = f"a fault of `{rehearsal.name}` must come before its timeout, {rehearsal.timeout_s:g} s,"
            yield found(graph, fault.path, f"{message} got {fault.at_s:g} s")
        elif rehearsal.expect == "stale_state":
            yield from _other_camera(graph, rehearsal)


def _other_camera(graph: CellGraph, rehearsal: Rehearsal) -> Findings:
    """Yield the only fault where it freezes a camera, and all that is detected is seen by others."""
    frames = {device.name: set(device.frames.values()) for device in graph.cell.devices if device.camera is not None}
    seen = [graph.frames.get(step.name) for step in rehearsal.steps if step.kind == "detect"]
    used = {name for name, own in frames.items() for frame in seen if frame is not None and frame.parent in own}
    fault = rehearsal.faults[0]
    alone = len(rehearsal.faults) == 1 and fault.kind == "freeze" and fault.name in frames
    if alone and used and fault.name not in used:
        message = f"`{rehearsal.name}` must freeze `{'` or `'.join(sorted(used))}`, by which it detects, got"
        yield found(graph, fault.path, f"{message} `{fault.name}`")
