"""A part of the tuple names a package but no version.

The name of a driver says which driver, not which of its releases. Behavior changes between releases; the name does
not.

Example that is reported:

```yaml
versions: {rmw: rmw_fastrtps_cpp}  # expect at rmw
```

Example that is accepted:

```yaml
versions: {rmw: rmw_fastrtps_cpp 8.4.4}
```

Fix: write the package and its version, such as `package 1.2.3`.

Source: docs/principles.md#pinned-versions
"""

from __future__ import annotations

from cellc.compiler.graph.versions import cell_pins, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.pins import is_commit, last_word, version_number

_NUMBERED = ("os", "kernel", "rmw", "ros2_control", "moveit", "firmware", "driver", "sdk", "description")


@rule(Severity.ERROR, assumes=("floating-version",))
def check(graph: CellGraph) -> Findings:
    """Yield parts of the tuple without a version number."""
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        versioned = version_number(pin.text) or is_commit(last_word(pin.text))
        if pin.known and pin.part in _NUMBERED and not versioned:
            message = f"`{pin.part}` of `{pin.holder}` is `{pin.text}`, without a version"
            yield found(graph, pin.path, message, f"write `{pin.text.split()[0]}` and its version")
