#!/usr/bin/env python3
"""Runs a program that the cell requires, and ends the launch when the program ends.

    required -- PROGRAM ARGUMENT...

It is the launch prefix of a node where launch itself has no option for this: a launch whose controller manager has
ended keeps everything else running, and every process that calls the manager waits forever. The launch gets SIGINT, as
from Ctrl-C. A program that was asked to end ends nothing but itself.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from functools import partial

# Of the child: it gets SIGINT when this program is gone, killed too (prctl(2), PR_SET_PDEATHSIG).
END_WITH_PARENT = partial(ctypes.CDLL(None).prctl, 1, signal.SIGINT) if sys.platform == "linux" else None


def main(arguments: Sequence[str]) -> int:
    """Run the program; return its exit status."""
    command = arguments[arguments.index("--") + 1 :]
    launch = os.getppid()
    asked: list[int] = []
    started: list[subprocess.Popen[bytes]] = []

    def pass_on(number: int, _: object) -> None:
        asked.append(number)
        for child in started:
            child.send_signal(number)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, pass_on)
    child = subprocess.Popen(command, preexec_fn=END_WITH_PARENT)
    started.append(child)
    for early in asked:  # while it was being started
        child.send_signal(early)
    status = child.wait()
    if not asked and os.getppid() == launch:
        print(f"{command[0]} ended with {status}; ending the launch that requires it", file=sys.stderr, flush=True)
        os.kill(launch, signal.SIGINT)
    return status if status >= 0 else 128 - status


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
