"""The spec contains a secret.

The spec is reviewed, copied and compiled into parameter files that everybody on the host can read.

Example that is reported:

```yaml
nodes:
  task: {parameters: {api_token: 9f2c1a77}}  # expect at api_token
```

Example that is accepted:

```yaml
nodes:
  task: {parameters: {api_token_file: /run/secrets/task}}
```

Fix: give the node the name of a file or of an environment variable that holds it.

Source: docs/principles.md#secrets
"""

from __future__ import annotations

import re

from cellc.compiler.cell.interface import NodeSource
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_SECRET = re.compile(r"(?i)(^|_|\.)(password|passwd|passphrase|secret|token|api_?key|private_?key|credential)s?$")


@rule(Severity.ERROR)
def check(graph: CellGraph) -> Findings:
    """Yield parameters of nodes and controllers whose name says that they are secret and that hold a text."""
    for node in graph.cell.nodes:
        if node.source is not NodeSource.SPEC:
            continue
        for name, value in node.parameters.items():
            if value and isinstance(value, str) and _SECRET.search(name):
                path = (*node.path, "parameters", name)
                message = f"parameter `{name}` of `{node.name}` holds a secret"
                yield found(graph, path, message)
    for written in written_parameters(graph.cell):
        if written.value and isinstance(written.value, str) and _SECRET.search(written.name):
            message = f"parameter `{written.name}` of `{written.controller.name}` holds a secret"
            yield found(graph, written.path, message)
