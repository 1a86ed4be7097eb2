"""The rollback image is named, not fixed.

A tag can be moved to another image. A digest cannot.

Example that is reported:

```yaml
versions: {rollback: {image: "cell-image:v4"}}
```

Example that is accepted:

```yaml
versions: {rollback: {image: "sha256:9f2c1a77"}}
```

Fix: write the digest, `sha256:…`.

Source: chapter 4, section 4, table: lock or container digest.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.diagnostics import Severity
from cellc.graph.cell_graph import CellGraph
from cellc.graph.responsibilities import UNKNOWN
from cellc.rule import Finding
from cellc.rules.define import define
from cellc.rules.finding import found


def check(graph: CellGraph) -> Iterator[Finding]:
    """Yield an image that is no digest."""
    image = graph.cell.spec.versions.rollback.image
    if image != UNKNOWN and "sha256:" not in image:
        message = f"the rollback image `{image}` is a name that can be moved"
        yield found(graph, ("versions", "rollback", "image"), message, "write its digest, `sha256:…`")


RULE = define("rollback-without-digest", Severity.ERROR, check, __doc__, assumes=("floating-version",))
