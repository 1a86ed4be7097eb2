"""What bash runs of a script: the words of each command, and no program is there to be run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

_BASH = shutil.which("bash") or "bash"
_HEAD = r"""
command_not_found_handle() {
  if [ -p /dev/stdin ]; then while IFS= read -r _; do :; done; fi # one after another, so that no lines mix
  printf '%s\0' "$@" $'\n' >> "$LOG"
}
needs() { command_not_found_handle needs "$@"; }
act() { command_not_found_handle act "$@"; }
cd() { command_not_found_handle cd "$@"; }
source() { command_not_found_handle source "$@"; }
. () { command_not_found_handle source "$@"; }
exec > /dev/null 2>&1
"""
_FUNCTIONS = re.compile(r"^(\w+)\(\) \{\n.*?^\}\n", re.M | re.S)
_STEPS = re.compile(r"^  (\w+)\) #", re.M)


def commands_of(script: str) -> list[list[str]]:
    """Return every command with its words, in the order in which bash runs them; first whether bash can read it.

    A script with steps is run once for each, its own functions left out.
    """
    steps = _STEPS.findall(script)
    if not steps:
        return _run(script, "")
    body = _FUNCTIONS.sub("", script)
    return [line for step in steps for line in _run(body, step)]


def _run(script: str, step: str) -> list[list[str]]:
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "log"
        log.touch()
        place = {"PATH": "/nothing", "LOG": str(log)}
        command = [_BASH, "-c", f"{_HEAD}\n{script}", "bash", *([step] if step else [])]
        tried = subprocess.run(command, env=place, cwd=folder, stdin=subprocess.DEVNULL, timeout=60, check=False)
        said = log.read_bytes().decode("utf-8", "backslashreplace")
        made = sorted(set(os.listdir(folder)) - {"log"})
    # Where it runs is another folder each time.
    lines = [line.split("\0") for line in said.replace(folder, "/here").split("\n\0")]
    return [[f"ends with {tried.returncode}", *made], *([word for word in line if word] for line in lines)]
