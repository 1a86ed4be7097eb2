"""The child process of an expansion: reads one request from stdin, answers on stdout, within limits of its own."""

from __future__ import annotations

import json
import os
import sys

from cellc.description.xacro_expander import encode
from cellc.description.xacro_expansion import expand_here

CPU_SECONDS = 8
MEMORY_BYTES = 1024 * 1024 * 1024


def main() -> None:
    """Expand what stdin asks for."""
    _limit_resources()
    request = json.load(sys.stdin)
    os.chdir(request["folder"])  # names in diagnostics stay those that the user wrote
    json.dump(encode(expand_here(request["file"], request["arguments"], request["root"])), sys.stdout)


def _limit_resources() -> None:
    try:
        import resource
    except ImportError:  # not a POSIX system: the parent's wall time is the limit
        return
    for kind, amount in ((resource.RLIMIT_CPU, CPU_SECONDS), (resource.RLIMIT_AS, MEMORY_BYTES)):
        hard = resource.getrlimit(kind)[1]
        allowed = amount if hard == resource.RLIM_INFINITY else min(amount, hard)
        resource.setrlimit(kind, (allowed, hard))


if __name__ == "__main__":
    main()
