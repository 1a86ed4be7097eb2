"""Tests in a process of their own, which begins with what this one has loaded, in a copy of the checkout."""

from __future__ import annotations

import os
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path

ENDLESS = -1


def apart(tree: Path, log: Path, work: Callable[[], int], seconds: float) -> int:
    """Do work in a process of its own; return what it returns, or that it took longer than it may."""
    child = os.fork()
    if not child:
        _begin(tree, log, seconds)
        code = 70
        try:
            code = work()
        except Exception:  # the log tells it
            traceback.print_exc()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
    until = time.monotonic() + 6 * seconds  # other programs may have the machine
    while True:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            _end_group(child)
            ended = os.waitstatus_to_exitcode(status)
            return ENDLESS if ended in (-signal.SIGXCPU, -signal.SIGKILL) else ended
        if time.monotonic() > until:
            _end_group(child)
            os.waitpid(child, 0)
            return ENDLESS
        time.sleep(0.02)


def _begin(tree: Path, log: Path, seconds: float) -> None:
    os.setpgrp()  # not a session: the scheduler would take each for another user
    out = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    for stream in (1, 2):
        os.dup2(out, stream)
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 1, int(seconds) + 2))
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    os.environ["PYTHONPATH"] = str(tree)


def _end_group(leader: int) -> None:
    try:
        os.killpg(leader, signal.SIGKILL)
    except ProcessLookupError:
        return
