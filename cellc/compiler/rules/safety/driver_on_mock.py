"""A node that starts on the mock is a driver of real hardware.

Nodes of the spec, and those of `device.yaml` with `provides: every_target`, start on the mock, and no gate is
before it. A program of a package that drives devices, or a controller manager with a description of its own, opens its
connection there and needs no word of the cell for it. A statement under `mock_programs` or `mock_plugins` cannot excuse
what the catalog knows to reach a device.

Example that is reported:

```yaml
nodes:
  task: {run: controller_manager/ros2_control_node}  # expect at run
```

Example that is accepted:

```yaml
nodes:
  task: {run: cell_tasks/pick_place}
```

Fix: leave drivers to `nodes:` of `device.yaml` with `provides: real`, and the description to the launch file.

Source: docs/principles.md#mock-and-real
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import Node, NodeSource
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule

_DESCRIPTION = "robot_description"
_MANAGER = "ros2_control_node"


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield nodes and mock plugins that are known to reach a device, and nodes whose parameters name hardware."""
    cell, real_plugins = graph.cell, _real_plugins(graph.cell)
    drivers, programs = _driver_packages(cell), _real_programs(cell)
    for node in cell.nodes:
        if not node.real_only and node.source is not NodeSource.STANDARD:
            yield from (found(graph, path, message) for path, message in _reasons(cell, node, drivers, programs))
    for device in cell.devices:
        plugin = "" if device.hardware is None else device.hardware.plugins["mock"]
        package = plugin.partition("/")[0]
        if package in cell.hardware_packages or plugin in real_plugins:
            message = f"the mock of `{device.name}` is `{plugin}`, of a package that reaches real hardware"
            yield found(graph, (*device.path, "model"), message)


def _reasons(
    cell: Cell, node: Node, drivers: frozenset[str], programs: frozenset[str]
) -> Iterator[tuple[YamlPath, str]]:
    own = node.source is NodeSource.SPEC
    program = f"{node.package}/{node.executable}"
    packages = cell.hardware_packages | (drivers if own else frozenset())
    drives = node.package in packages or program in programs or node.executable.endswith("ros2_control_node")
    if drives:
        message = f"`{node.name}` runs `{program}` on the mock, a driver of real hardware"
        yield (*node.path, "run" if own else "model"), message
    for name, value in node.parameters.items():
        texts = value if isinstance(value, tuple) else (value,)
        described = any("<ros2_control" in text or "<plugin" in text for text in texts if isinstance(text, str))
        if described or name.rpartition(".")[2] == _DESCRIPTION:
            message = f"`{node.name}` gets hardware to drive from `{name}` on the mock"
            yield (*node.path, *(("parameters", name) if own else ("model",))), message


def _driver_packages(cell: Cell) -> frozenset[str]:
    """Return the packages that the devices of the cell call their drivers."""
    return frozenset(device.packages.driver for device in cell.devices if device.packages.driver is not None)


def _real_programs(cell: Cell) -> frozenset[str]:
    return frozenset(f"{node.package}/{node.executable}" for node in cell.nodes if node.real_only)


def _real_plugins(cell: Cell) -> frozenset[str]:
    components = (device.hardware for device in cell.devices)
    return frozenset(
        component.plugins["real"] for component in components if component is not None and "real" in component.plugins
    )
