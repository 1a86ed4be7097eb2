"""There is no image and configuration to go back to.

When the new configuration fails on Friday evening, the way back must be a replay and not a reinstallation.

Example that is reported:

```yaml
versions: {rollback: {image: UNKNOWN}}  # expect at image
```

Example that is accepted:

```yaml
versions: {rollback: {image: "sha256:9f2c1a77"}}
```

Fix: archive the last image that ran, and write its digest and the identifier of its configuration.

Source: docs/principles.md#rollback
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_ANSWERS = {
    "image": "the digest of the last image that ran",
    "configuration": "the id of the last configuration that ran, such as `cfg-0123456789ab`",
}


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield the unknown parts of the rollback in one finding."""
    rollback = graph.cell.versions.rollback
    parts = (("image", rollback.image), ("configuration", rollback.configuration))
    missing = [part for part, text in parts if text == UNKNOWN]
    if missing:
        names = " and ".join(f"`{part}`" for part in missing)
        path = ("versions", "rollback", missing[0])
        message = f"the rollback {names} {'are' if len(missing) > 1 else 'is'} UNKNOWN"
        yield found(graph, path, message, f"write {' and '.join(_ANSWERS[part] for part in missing)}")
