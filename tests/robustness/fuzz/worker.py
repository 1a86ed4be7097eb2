"""A process that judges inputs one after the other, under limits of time and memory."""

from __future__ import annotations

import json
import os
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from tests.robustness.fuzz.inputs import make_input
from tests.robustness.fuzz.oracle import Find, Sandbox, judge

LONGEST_S, LONGEST_WAIT_S = 10.0, 40.0
"""What an input may take of the processor, which other programs do not lengthen, and of the clock."""

MOST_BYTES = 1 << 30


class _TooLongError(BaseException):
    """Raised by the clock wherever the input is."""


def judge_alone(kind: str, number: int, sandbox: Sandbox) -> tuple[list[Find], float, int]:
    """Judge an input within the limits.

    Returns:
        What does not hold, the time of the processor in s, and the peak of the resident memory in bytes.
    """
    found, took, peak = _judged(kind, number, sandbox, in_child=False)
    if any(finding.wrong in ("hang", "memory") or "MemoryError" in finding.text for finding in found):
        found, took, peak = _judged(kind, number, sandbox, in_child=True)
    return found, took, peak


def _judged(kind: str, number: int, sandbox: Sandbox, *, in_child: bool) -> tuple[list[Find], float, int]:
    given = make_input(kind, number)
    _forget_peak()
    begin = time.process_time()
    try:
        with _alarms():
            found = judge(given, sandbox, in_child=in_child)
    except _TooLongError:
        found = [Find("hang", f"took longer than {LONGEST_S:g} s of the processor, or {LONGEST_WAIT_S:g} s")]
    took, peak = time.process_time() - begin, _peak()
    if peak > MOST_BYTES:
        found.append(Find("memory", f"{peak / 2**20:.0f} MB"))
    return found, took, peak


@contextmanager
def _alarms() -> Iterator[None]:
    def ring(signum: int, frame: FrameType | None) -> None:
        raise _TooLongError

    clocks = ((signal.SIGPROF, signal.ITIMER_PROF, LONGEST_S), (signal.SIGALRM, signal.ITIMER_REAL, LONGEST_WAIT_S))
    for number, clock, seconds in clocks:
        signal.signal(number, ring)
        signal.setitimer(clock, seconds)
    try:
        yield
    finally:
        for _, clock, _ in clocks:
            signal.setitimer(clock, 0.0)


def _forget_peak() -> None:
    """Begin a new peak, where the system knows how (Linux, proc(5), clear_refs)."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def _peak() -> int:
    try:
        status = Path("/proc/self/status").read_text()
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return next(int(line.split()[1]) * 1024 for line in status.splitlines() if line.startswith("VmHWM"))


def main() -> None:
    """Judge what standard input asks for, a line of JSON ``[kind, first, last]`` each, and answer in lines of JSON."""
    out = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)  # what the compiler prints is no answer
    with tempfile.TemporaryDirectory() as name:
        sandbox = Sandbox(Path(name))
        for line in sys.stdin:
            kind, first, last = json.loads(line)
            for number in range(first, last):
                print(json.dumps({"begin": [kind, number]}), file=out)
                found, took, peak = judge_alone(kind, number, sandbox)
                told = [[finding.wrong, finding.text] for finding in found]
                print(json.dumps({"end": [kind, number], "found": told, "s": took, "mb": peak / 2**20}), file=out)
            print(json.dumps({"done": [kind, first, last]}), file=out)


if __name__ == "__main__":
    main()
