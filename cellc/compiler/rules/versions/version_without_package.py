"""The word before a version is not the name of a package.

The bring-up and gate G0 read the installed version of that package: a command takes the word as it is written, and
takes one that begins with a dash as an option.

Example that is reported:

```yaml
devices:
  arm: {sdk: --all 1.6.0}  # expect at sdk
```

Example that is accepted:

```yaml
devices:
  arm: {sdk: demo_arm_sdk 1.6.0}
```

Fix: write the package and its version, such as `package 1.2.3`.

Source:

- https://github.com/ros-infrastructure/rep/blob/master/rep-0144.rst (as of 2026-11-23): names of packages
- docs/principles.md#pinned-versions
"""

from __future__ import annotations

from cellc.compiler.graph.versions import cell_pins, device_pins
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.pins import pinned_package

_PACKAGED = ("rmw", "driver", "sdk", "description")


@rule(Severity.ERROR, assumes=("unknown-rmw",))
def check(graph: CellGraph) -> Findings:
    """Yield parts of the tuple whose first of two words is not the name of a package."""
    for pin in (*cell_pins(graph.cell), *device_pins(graph.cell)):
        words = pin.text.split()
        if pin.part in _PACKAGED and len(words) == 2 and not pinned_package(pin.text):
            message = f"`{pin.part}` of `{pin.holder}` must begin with the name of a package, got `{words[0]}`"
            yield found(graph, pin.path, message)
