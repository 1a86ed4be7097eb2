"""A cell has the name of another package.

The generated package has the name of its cell. In a workspace, colcon and ament take it for the installed package
of this name: whatever needs that one finds neither its programs nor its messages, or does not build.

Example that is reported:

```yaml
cell: sensor_msgs  # expect at cell
```

Example that is accepted:

```yaml
cell: sensor_bench
```

Fix: give the cell a name that no package has, such as the name of its place or its task.

Source:

- https://docs.ros.org/en/jazzy/Tutorials/Beginner-Client-Libraries/Creating-A-Workspace/Creating-A-Workspace.html
  (as of 2026-11-23): what an overlay has goes before what lies under it
- docs/principles.md#facts-of-the-catalog
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.graph.versions import is_known_package
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rule


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield a cell that is named after a package that it uses, or that the catalog knows."""
    name = graph.cell.name
    users = [path for package, path in _packages(graph) if package == name]
    if users or is_known_package(name):
        related = tuple(Related("the cell uses that package here", graph.cell.locate(*path)) for path in users[:1])
        yield found(graph, ("cell",), f"`{name}` must not be the name of another package", related=related)


def _packages(graph: CellGraph) -> Iterator[tuple[str | None, YamlPath]]:
    """Yield the packages that a cell names, and its devices."""
    cell = graph.cell
    yield from ((node.package, node.path) for node in cell.nodes)
    yield from ((controller.package, controller.path) for controller in cell.controllers)
    yield from ((group.solver.package, group.path) for group in cell.groups)
    yield from ((pipeline.package, ("motion", "pipelines")) for pipeline in cell.pipelines)
    for device in cell.devices:
        of_vendor = device.packages
        yield from ((name, device.path) for name in (of_vendor.driver, of_vendor.sdk, of_vendor.description))
        yield from ((program.package, device.path) for program in device.programs)
        if device.kinematics is not None:
            yield device.kinematics.package, device.path
