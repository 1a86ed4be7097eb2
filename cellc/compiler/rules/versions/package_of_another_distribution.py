"""A pinned package belongs to another distribution.

Packages of ROS are versioned by distribution: the major number of ros2_control, MoveIt or the middleware tells which.
Mixed, they do not build, or they load plugins with another binary interface.

Example that is reported:

```yaml
versions: {ros2_control: 2.54.0}  # expect at ros2_control
```

Example that is accepted:

```yaml
versions: {ros2_control: 4.47.0}
```

Fix: pin the line that the distribution releases.

Source:

- https://github.com/ros/rosdistro (as of 2026-08-22): distribution files
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from cellc.compiler.graph.releases import was_released
from cellc.compiler.graph.versions import cell_pins, distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule
from cellc.contract.pins import version_numbers


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield ros2_control, MoveIt and middleware pins of another major version than the distribution ever released."""
    facts = distribution(graph.cell)
    for pin in cell_pins(graph.cell) if facts is not None else ():
        package = pin.text.split()[0] if pin.part == "rmw" else pin.part
        released = facts.packages.get(package, "") if facts is not None else ""
        ours, theirs = version_numbers(pin.text), version_numbers(released)
        # MoveIt and rmw_zenoh stay below 3 for years: their second number is what changes with the distribution.
        digits = 2 if theirs[:1] <= (2,) and package in ("moveit", "rmw_zenoh_cpp") else 1
        of_another = pin.known and ours and theirs and ours[:digits] != theirs[:digits]
        if of_another and not was_released(graph.cell.distro, package, pin.text):
            message = f"`{pin.text}` is not of {graph.cell.distro}, which releases `{package}` {released}"
            yield found(graph, pin.path, message, f"pin the line of {released}")
