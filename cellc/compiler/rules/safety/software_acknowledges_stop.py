"""A program may release a stop that a person is to acknowledge.

The spec says that somebody looks before the arm moves again. A node that calls the service which unlocks a protective
stop or clears a fault takes that look away, in the place where it counts.

Example that is reported:

```yaml
interfaces:
  /dashboard/unlock_protective_stop: {service: std_srvs/srv/Trigger, server: move_group,
                                      client: task,  # expect at client
                                      timeout: 5 s, on_timeout: error, on_error: success is false}
```

Example that is accepted:

```yaml
interfaces:
  /dashboard/get_safety_mode: {service: std_srvs/srv/Trigger, server: move_group, client: task,
                               timeout: 5 s, on_timeout: error, on_error: success is false}
```

Fix: leave it to the teach pendant or to a panel that a person presses, and take the client away.

Source: docs/principles.md#recovery
"""

from __future__ import annotations

import re

from cellc.compiler.cell.interface import InterfaceKind
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, found, rule

_RELEASES = frozenset(
    ("acknowledge", "ack", "clear", "close", "recover", "recovery", "release", "reset", "restart", "resume", "unlock")
)
_STOPS = frozenset(
    ("emergency", "error", "errors", "estop", "fault", "faults", "protective", "reflex", "safeguard", "safety", "stop")
)
_BY_HAND = frozenset(("hmi", "operator", "panel", "pendant", "ui", "button"))


@rule(Severity.ERROR, assumes=("automatic-recovery",))
def check(graph: CellGraph) -> Findings:
    """Yield clients of services and actions that release a stop, apart from those that a person presses."""
    acknowledge = ("safety", "recovery", "acknowledge")
    for interface in graph.cell.interfaces:
        words = _words(interface.name.rpartition("/")[2])
        if interface.kind is InterfaceKind.TOPIC or interface.derived:
            continue
        if words.isdisjoint(_RELEASES) or words.isdisjoint(_STOPS):
            continue
        for sink in interface.sinks:
            if _words(sink.node).isdisjoint(_BY_HAND):
                person = graph.cell.safety.recovery.acknowledge
                message = f"`{sink.node}` may call `{interface.name}`, but stops must be acknowledged by `{person}`"
                related = (Related("acknowledged by a person", graph.cell.locate(*acknowledge)),)
                yield found(graph, sink.path, message, related=related)


def _words(name: str) -> frozenset[str]:
    return frozenset(re.findall(r"[a-z]+", re.sub(r"([a-z])([A-Z])", r"\1_\2", name).lower()))
