"""A name becomes a file or folder that Windows cannot hold.

Files and folders of the generated package are named after the cell, its hosts, controller managers and nodes. Windows
takes `con`, `prn`, `aux`, `nul`, `com0` to `com9` and `lpt0` to `lpt9` for devices, in any case and with any ending:
Git cannot check out a repository with such a file there, not even the rest of it.

Example that is reported:

```yaml
cell: aux  # expect at cell
```

Example that is accepted:

```yaml
cell: auxiliary
```

Fix: write the name out, or add a word to it.

Source: https://learn.microsoft.com/en-us/windows/win32/fileio/naming-a-file
(as of 2026-11-23): naming conventions
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, YamlPath, found, rule
from cellc.contract.file_names import opens_a_device


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield names that files are named after and that are devices of Windows."""
    for name, path in _names(graph):
        if opens_a_device(name):
            yield found(graph, path, f"`{name}` must not be the name of a file: Windows keeps it for a device")


def _names(graph: CellGraph) -> Iterator[tuple[str, YamlPath]]:
    """Yield each name that a file begins with, once for each place."""
    cell = graph.cell
    yield cell.name, ("cell",)
    yield from ((name, ("hosts", name)) for name in cell.hosts)
    named = {(device.name, device.path) for device in cell.devices}
    named |= {(manager.name, manager.path) for manager in cell.managers}
    # The file of a node begins with the first part of its full name; that of a device's node is often the device.
    own = {(node.full_name.split("/")[1], node.path) for node in cell.nodes}
    yield from sorted(named | own, key=str)
