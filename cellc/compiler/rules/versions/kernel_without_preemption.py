"""The kernel is not the one that the scheduling of a host asks for.

`uname -r` ends in `-generic` for Ubuntu's ordinary kernel, which has no PREEMPT_RT. A host that is said to be
preemptible and boots this one runs its control loop with delays of many milliseconds, and nothing says so.

Example that is reported:

```yaml
versions: {kernel: 6.8.0-45-generic}  # expect at kernel
```

Example that is accepted:

```yaml
versions: {kernel: 6.8.1-1015-realtime}
```

Fix: pin the kernel that `uname -r` prints there, such as `6.8.1-1015-realtime`, or correct `scheduling`.

Source: docs/principles.md#the-control-link
"""

from __future__ import annotations

import re

from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_ORDINARY = re.compile(r"-(generic|lowlatency|azure|aws|oem|virtual|amd64|cloud|raspi)\b")


@rule(Severity.WARNING)
def check(graph: CellGraph) -> Findings:
    """Yield a kernel of an ordinary flavour where a host is said to be preemptible."""
    ordinary = _ORDINARY.search(graph.cell.versions.kernel)
    hosts = [host for host in graph.cell.hosts.values() if host.scheduling == "preempt_rt"]
    if ordinary is None or not hosts:
        return
    names = ", ".join(f"`{host.name}`" for host in hosts)
    message = f"the kernel of {names} must be a real-time one, got `{graph.cell.versions.kernel}`"
    related = tuple(Related("said to be preempt_rt", graph.cell.locate(*host.path, "scheduling")) for host in hosts)
    yield found(graph, ("versions", "kernel"), message, related=related)
