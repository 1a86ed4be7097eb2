"""The name of an owner is used once, and is nearly that of another.

Owners are free texts. A transposed letter makes a team without members: its approval is waited for, or is thought to
be somebody else's.

Example that is reported:

```yaml
owners: {responsibilities: {physical_stop: sfaety}}  # expect at physical_stop
```

Example that is accepted:

```yaml
owners: {responsibilities: {physical_stop: safety}}
```

Fix: write the name as everywhere else.

Source: docs/principles.md#owners-and-approvals
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from difflib import SequenceMatcher

from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.cell.site import UNKNOWN
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_ALIKE = 0.8
_SHORTEST = 4


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield owners that are named once and differ by a letter or two from one that is named more often."""
    named = [(owner, path) for owner, path in _owners(graph) if owner != UNKNOWN]
    times = Counter(owner for owner, _ in named)
    usual = [owner for owner, count in times.items() if count > 1]
    for owner, path in named:
        if times[owner] > 1 or len(owner) < _SHORTEST:
            continue
        near = next(
            (text for text in usual if SequenceMatcher(None, owner.lower(), text.lower()).ratio() >= _ALIKE), None
        )
        if near is not None:
            message = f"owner `{owner}` is named once, and `{near}` {times[near]} times"
            yield found(graph, path, message, f"did you mean `{near}`?")


def _owners(graph: CellGraph) -> Iterator[tuple[str, YamlPath]]:
    """Yield every name of an owner with its place."""
    cell = graph.cell
    for duty, owner in cell.owners.responsibilities.items():
        yield owner, ("owners", "responsibilities", duty)
    for area, owner in cell.owners.approvals.items():
        yield owner, ("owners", "approvals", area)
    yield from ((node.owner, (*node.path, "owner")) for node in cell.nodes if node.source is NodeSource.SPEC)
    yield from ((calibration.owner, (*calibration.path, "owner")) for calibration in cell.calibrations.values())
    yield cell.safety.recovery.owner, ("safety", "recovery", "owner")
    yield cell.safety.recovery.observer, ("safety", "recovery", "observer")
