"""A child process of bounded processor time, memory and output, which reads untrusted input.

What it may do is counted in work, so that a slow or busy machine answers as a fast one does: the clock ends a child
that hangs, and nothing else. A wrong file can make a reader loop, fill the memory or crash; then only the child ends,
and its parent tells so. These are bounds and no sandbox: the child runs as the user, and code that took it over could
do what the user may do.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from cellc.contract.errors import CellcError
from cellc.contract.store.swap import temporary_file

HANG_S = 1800
"""Seconds by the clock after which a child hangs, however busy the machine is; its parent may have been killed too."""


class ChildEndedError(CellcError):
    """The child did not end well; the text says what it needed more of than it may use.

    Attributes:
        answer: what it had written until then.
    """

    def __init__(self, message: str, answer: bytes) -> None:
        super().__init__(message)
        self.answer = answer


def ask_child(module: str, request: bytes, wall_seconds: float = HANG_S) -> bytes:
    """Run a module of cellc as a child, and return what it wrote to stdout before it ended well.

    What it writes to stderr is dropped: libraries print there what a hostile file has them print. A Ctrl-C reaches
    parent and child together, and a parent that is interrupted alone ends its child.

    Raises:
        ChildEndedError: it used up a limit, or crashed.
    """
    with temporary_file() as answer:
        try:
            child = subprocess.run(
                [sys.executable, "-m", module],
                input=request,
                stdout=answer,
                stderr=subprocess.DEVNULL,
                # `-m` puts the current folder first on the import path: it must not be one that untrusted files filled.
                cwd=Path(__file__).resolve().parents[3],
                # Threads of numpy would count against the memory.
                env={**os.environ, "PYTHONHASHSEED": "0", "OPENBLAS_NUM_THREADS": "1"},
                timeout=wall_seconds,
                check=False,
            )
            ended = "" if child.returncode == 0 else "takes more time or memory than it may use"
        except subprocess.TimeoutExpired:
            ended = f"hangs: it has not ended after {wall_seconds:g} s"
        answer.seek(0)
        content = answer.read()
    if ended:
        raise ChildEndedError(ended, content)
    return content


def confine_this_process(cpu_seconds: int, memory_bytes: int, file_bytes: int) -> None:
    """Bound this process, a child, before it reads untrusted input.

    Args:
        file_bytes: size of its answer, and of each other file that it writes.
    """
    try:
        import resource
    except ImportError:  # not a POSIX system: the parent's wall time is the limit
        return
    bounds = (
        (resource.RLIMIT_CPU, cpu_seconds),
        (resource.RLIMIT_AS, memory_bytes),
        (resource.RLIMIT_FSIZE, file_bytes),
        (resource.RLIMIT_CORE, 0),
    )
    for kind, amount in bounds:
        hard = resource.getrlimit(kind)[1]
        allowed = amount if hard == resource.RLIM_INFINITY else min(amount, hard)
        resource.setrlimit(kind, (allowed, allowed))
    signal.alarm(HANG_S)
    sys.addaudithook(_refuse_leaving)


def _refuse_leaving(event: str, _: tuple[object, ...]) -> None:
    """Refuse that Python code of the child talks to the network or starts a program."""
    if event.startswith(("socket.", "subprocess.", "os.exec", "os.posix_spawn", "os.spawn", "os.system", "os.fork")):
        raise PermissionError(f"`{event}` is refused to a child that reads untrusted files")
