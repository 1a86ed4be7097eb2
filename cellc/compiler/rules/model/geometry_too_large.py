"""The shapes of a cell, or its poses and goals, cost more than may be computed.

Every pair of collision shapes is looked at, and pairs grow with the square of the shapes: a device of a thousand boxes
makes half a million pairs, a semantic description of 60 MB, and minutes in `move_group` too. A hostile description of a
few lines takes a machine down. Bounded are the pairs, and the processor time of checking them and of searching for
goals; docs/limits.md has the figures.

Example that is reported:

```yaml
devices:
  stage: {model: ./crowd, revision: A, firmware: stage 1.0.0}  # two links of 100 boxes each
# expect at motion.groups
```

Example that is accepted:

```yaml
devices:
  stage: {model: ./stage, revision: A, firmware: stage 1.0.0}
```

Fix: use fewer and larger shapes in `<collision>` and in `scene`, or raise the limit.

Source: docs/principles.md#how-geometry-is-checked
"""

from __future__ import annotations

from cellc.compiler.feasibility import motion_answer
from cellc.compiler.rules.geometry import SOUND_MODEL, USABLE_MESHES, beyond_limits
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, rule


@rule(Severity.ERROR, assumes=(*SOUND_MODEL, *USABLE_MESHES))
def check(graph: CellGraph) -> Findings:
    """Yield the limit that the geometry is beyond."""
    yield from beyond_limits(graph, motion_answer(graph))
