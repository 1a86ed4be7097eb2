"""A planning group moves nothing.

Between its base and its tip there is no moving joint, so there is nothing to plan.

Example that is reported:

```yaml
motion:
  groups: {fingers: {base: arm/tool0, tip: tcp}}
```

Example that is accepted:

```yaml
motion:
  groups: {fingers: {base: arm/base_link, tip: tcp}}
```

Fix: choose base and tip at the two ends of the joints.

Source: chapter 4, section 10.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield groups without a joint."""
    for group in graph.cell.groups:
        if not group.joints:
            message = f"there is no moving joint between `{group.base_link}` and `{group.tip_frame}`"
            yield found(graph, group.path, message, "choose base and tip at the two ends of the joints")


RULE = define("group-without-joints", Severity.ERROR, check, __doc__)
