"""A cell of several hosts records, and no card carries the recording.

What is recorded travels to the host whose disk takes it. Where no card carries `bag`, it is not decided which host
that is: the recorder is started where somebody happens to sit, and its stream goes over the card that the poses need.

Example that is reported:

```yaml
# a cell of two computers
hosts:
  control_pc: {nics: {bulk: {carries: [camera]}}}
recording: {topics: [/object_pose, /camera/camera/color/image_raw]}  # expect at topics
```

Example that is accepted:

```yaml
# a cell of two computers
hosts:
  control_pc: {nics: {bulk: {carries: [camera, bag]}}}
recording: {topics: [/object_pose, /camera/camera/color/image_raw]}
```

Fix: add `bag` to what a card of the recording host carries.

Source: docs/principles.md#network-in-layers
"""

from __future__ import annotations

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield recordings of several hosts with cards, none of which carries the bag."""
    cell = graph.cell
    with_cards = [host for host in cell.hosts.values() if host.nics]
    if not cell.recording.topics or len(with_cards) < 2 or any("bag" in nic.carries for nic in graph.network.nics):
        return
    free = (nic for nic in graph.network.nics if "control" not in nic.carries)
    related = tuple(Related(f"`{nic.full_name}` may be the one", cell.locate(*nic.path)) for nic in free)
    message = f"a card of one of the {len(with_cards)} hosts must carry `bag`, as topics are recorded"
    yield found(graph, ("recording", "topics"), message, related=related)
