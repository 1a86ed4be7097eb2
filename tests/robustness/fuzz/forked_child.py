"""The confined children of cellc as forks of this process: the same code under the same limits, without its start.

Starting an interpreter takes longer than judging ten inputs.
"""

from __future__ import annotations

import os
import signal
import sys
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

from cellc.robot.description import confined_child, mesh_child, mesh_numbers, xacro_expansion

_ASKING = (mesh_numbers, xacro_expansion)
_CHILDREN = {module.__name__: module for module in (mesh_child, xacro_expansion)}


@contextmanager
def forking() -> Iterator[None]:
    """Let what is asked of a child be answered by a fork."""
    before = confined_child.ask_child
    _set(_ask_fork)
    try:
        yield
    finally:
        _set(before)


def _set(ask: object) -> None:
    for module in _ASKING:
        vars(module)["ask_child"] = ask


def _ask_fork(module: str, request: bytes, wall_seconds: float = confined_child.HANG_S) -> bytes:
    with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as answer:
        given.write(request)
        given.seek(0)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the threads of numpy stay behind; a fork does not compute with them
            child = os.fork()
        if child == 0:
            _be_child(module, given.fileno(), answer.fileno())
        try:
            _, status = os.waitpid(child, 0)
        except BaseException:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            raise
        answer.seek(0)
        written = answer.read()
    if os.waitstatus_to_exitcode(status) != 0:
        raise confined_child.ChildEndedError("takes more time or memory than it may use", written)
    return written


def _be_child(module: str, given: int, answer: int) -> None:
    """Run the child's program as if it had been started; never returns."""
    code = 1
    try:
        for number in (signal.SIGALRM, signal.SIGPROF, signal.SIGINT):
            signal.signal(number, signal.SIG_DFL)
        warnings.resetwarnings()
        os.dup2(given, 0)
        os.dup2(answer, 1)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
        sys.stdin = os.fdopen(0, closefd=False)  # the process ends with it
        sys.stdout = os.fdopen(1, "w", closefd=False)
        program = _CHILDREN.get(module) or import_module(module)
        program.main()
        sys.stdout.flush()
        code = 0
    finally:
        os._exit(code)
