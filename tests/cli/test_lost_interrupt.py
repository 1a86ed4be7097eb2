"""Ctrl-C that a callback of the interpreter swallows is raised again."""

from __future__ import annotations

import subprocess
import sys

_PROGRAM = """
import os, signal, sys, time, weakref
from cellc.contract.signals import run_program
class Thing: pass
def in_a_callback(_): os.kill(os.getpid(), signal.SIGTERM)
def program():
    thing = Thing()
    reference = weakref.ref(thing, in_a_callback)
    del thing
    for _ in range(100): time.sleep(0.01)
    return 0
sys.exit(run_program(program))
"""


def test_interrupt_in_a_callback_of_a_reference_is_raised_again() -> None:
    ran = subprocess.run([sys.executable, "-c", _PROGRAM], capture_output=True, text=True, check=False)
    told = "error: interrupted by SIGTERM; nothing was left half-written\n"
    assert (ran.returncode, ran.stderr) == (143, told)
