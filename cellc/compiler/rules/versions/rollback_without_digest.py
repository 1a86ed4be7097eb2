"""The rollback image is named, not fixed.

A tag can be moved to another image. A digest cannot.

Example that is reported:

```yaml
versions: {rollback: {image: "cell-image:v4"}}  # expect at image
```

Example that is accepted:

```yaml
versions: {rollback: {image: "sha256:9f2c1a77"}}
```

Fix: write the digest, `sha256:…`.

Source: docs/principles.md#rollback
"""

from __future__ import annotations

from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.ERROR, assumes=("floating-version",))
def check(graph: CellGraph) -> Findings:
    """Yield an image that is no digest."""
    image = graph.cell.versions.rollback.image
    if image != UNKNOWN and "sha256:" not in image:
        message = f"the rollback image must be given by its digest, got `{image}`"
        yield found(graph, ("versions", "rollback", "image"), message)
