"""Ctrl-C that a callback of the interpreter swallows is raised again."""

from __future__ import annotations

import subprocess
import sys

_PROGRAM = """
import sys, time, weakref
from cellc.__main__ import raise_lost_interrupts
raise_lost_interrupts()
class Thing: pass
def interrupted(_): raise KeyboardInterrupt
thing = Thing()
reference = weakref.ref(thing, interrupted)
try:
    del thing
    for _ in range(100): time.sleep(0.01)
    print("lost")
except KeyboardInterrupt:
    print("raised again")
"""


def test_interrupt_in_a_callback_of_a_reference_is_raised_again() -> None:
    ran = subprocess.run([sys.executable, "-c", _PROGRAM], capture_output=True, text=True, check=True)
    assert (ran.stdout, ran.stderr) == ("raised again\n", "")
