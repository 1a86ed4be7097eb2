"""A combination is in no version matrix.

Nobody has said that it works, and nobody that it does not. It stays UNKNOWN until a test of this tuple says so.

Example that is reported:

```yaml
devices: {arm: {driver: demo_arm_driver 3.1.0}}  # expect at driver
```

Example that is accepted:

```yaml
devices: {arm: {driver: demo_arm_driver 3.8.0}}
```

Fix: pin a version of the matrix, or test the tuple on the mock and with drives disabled, and keep the evidence.

Source: docs/principles.md#pinned-versions
"""

from __future__ import annotations

from cellc.pins import is_commit, last_word, same_version, version_number
from cellc.rules.kit import CellGraph, Findings, Severity, found, rule


@rule(Severity.BLOCKER)
def check(graph: CellGraph) -> Findings:
    """Yield drivers, SDKs and descriptions that no row knows, unless they are of the line of another distribution."""
    for device in graph.cell.devices:
        for part in ("driver", "sdk", "description"):
            text = device.versions.part(part)
            rows = [row for row in device.version_rows if row.part == part and row.known]
            here = {name for row in rows if row.distro in (None, graph.cell.distro) for name in row.known}
            elsewhere = {_line(name) for row in rows for name in row.known} - {_line(name) for name in here}
            ours = version_number(text)
            versioned = ours or is_commit(last_word(text))
            known = any(same_version(text, name) for name in here)
            if not versioned or not rows or known or (ours and here and _line(ours) in elsewhere):
                continue
            names = ", ".join(sorted(here)) or "none"
            message = f"`{text}` of `{device.name}` is not in the matrix of {graph.cell.distro}, which knows {names}"
            yield found(graph, (*device.path, part), message)


def _line(version: str) -> str:
    return version.split(".")[0]
