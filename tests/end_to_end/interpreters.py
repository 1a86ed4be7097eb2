"""The Python interpreters that a test can build with: the running one, and others that have cellc's libraries.

`CELLC_INTERPRETERS` names more, as paths with the separator of the system (a colon on POSIX): interpreters of virtual
environments in which `pip install -e .` was done.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass

SUPPORTED = ("3.10", "3.11", "3.12", "3.13")
_NEEDED = "import click, jsonschema, networkx, numpy, pinocchio, pydantic, ruckig, xacro, yaml, yourdfpy"
_TELL = f"import sys; print('%d.%d' % sys.version_info[:2], flush=True); {_NEEDED}"


@dataclass(frozen=True, slots=True)
class Interpreter:
    """A Python of one of the supported versions; ``why_not`` says why it is of no use, empty where it is."""

    version: str
    path: str
    why_not: str = ""


def interpreters() -> tuple[Interpreter, ...]:
    """Return one for every supported version; of several of one version the running one, then the first that works."""
    known = [_interpreter(path) for path in (sys.executable, *_named())]
    return tuple(
        next(
            (interpreter for interpreter in known if interpreter.version == version and not interpreter.why_not),
            _absent(version, known),
        )
        for version in SUPPORTED
    )


def _named() -> list[str]:
    return [path for path in os.environ.get("CELLC_INTERPRETERS", "").split(os.pathsep) if path]


def _absent(version: str, known: list[Interpreter]) -> Interpreter:
    broken = [
        f"{interpreter.path}: {interpreter.why_not}" for interpreter in known if interpreter.version in (version, "")
    ]
    reason = "; ".join(broken) or f"CELLC_INTERPRETERS names no Python {version}"
    return Interpreter(version, "", reason)


def _interpreter(path: str) -> Interpreter:
    if path == sys.executable:
        return Interpreter(f"{sys.version_info[0]}.{sys.version_info[1]}", path)
    try:
        told = subprocess.run([path, "-c", _TELL], capture_output=True, text=True, timeout=60, check=False)
    except OSError as error:
        return Interpreter("", path, str(error))
    why_not = told.stderr.strip().rpartition("\n")[2] if told.returncode else ""
    return Interpreter(told.stdout.strip(), path, why_not)
