"""A text of the spec contains a credential.

An address with a password in it, a private key or a token of a code host is a secret under any key. The
spec is reviewed, copied and compiled into files that everybody on the host can read.

Example that is reported:

```yaml
nodes:
  task: {parameters: {stream: "rtsp://viewer:hunter2@10.10.0.40/live"}}  # expect at stream
```

Example that is accepted:

```yaml
nodes:
  task: {parameters: {stream: "rtsp://10.10.0.40/live"}}
```

Fix: take it out, change it, and give the node the name of a file or of an environment variable that holds the new one.

Source:

- docs/principles.md#secrets
- https://www.rfc-editor.org/rfc/rfc3986#section-3.2.1
  (2005-01): a password in the user information of an address is deprecated
"""

from __future__ import annotations

import re

from cellc.compiler.rules.kit import CellGraph, Findings, Severity, found, rule

_CREDENTIALS = (
    ("an address with a password", re.compile(r"(?<=[A-Za-z0-9+.-])://[^/\s:@]*:[^/\s@]+@")),
    ("a private key", re.compile(r"-----BEGIN [A-Z ]*PRIVATE KEY-----")),
    ("an access token", re.compile(r"\b(?:gh[opsu]_[A-Za-z0-9]{36}|glpat-[A-Za-z0-9_-]{20}|AKIA[A-Z0-9]{16})\b")),
)


@rule(Severity.ERROR, assumes=("secret-in-spec",))
def check(graph: CellGraph) -> Findings:
    """Yield texts that look like a credential, wherever they stand."""
    for path, text in graph.cell.places.texts.items():
        kind = next((kind for kind, pattern in _CREDENTIALS if pattern.search(text)), None)
        if kind is not None:
            message = f"the text holds {kind}"
            yield found(graph, path, message)
