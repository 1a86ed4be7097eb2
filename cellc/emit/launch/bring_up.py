"""``launch/bring_up.bash``: what each step of the bring-up waits for, one condition a line, and what it does then.

Bash, started by the launch files and readable to the people who wait for it. It exists because launch XML has no event
handlers (ros2/launch issue 658), and `lifecycle_node` with its transitions only from Lyrical on (launch_ros pull
request 482): the command-line tools are the same from Humble on. A transition that fails leaves 0 as its exit status
there, so that the next step looks at the state. Left out: enabling drives, which no file of this package does.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cellc.artifact import Artifact
from cellc.cell.cell import Cell
from cellc.deploy.bringup import MOVE, Step, ready_to_move, steps
from cellc.deploy.processes import bring_up_enclave, movers
from cellc.formats.header import Header

FILE = "launch/bring_up.bash"
_TARGETS = ("mock", "real")
_CONDITIONS = Path(__file__).with_name("readiness.bash")


def bring_up(cell: Cell, header: Header) -> Artifact:
    """Return the script of a cell."""
    parts = [
        header.commented("#").rstrip("\n"),
        "set -eu",
        f'step="${{1:?which step: {", ".join(_names(cell))}}}"',
        f'enclave="{bring_up_enclave(cell)}" # of what is asked here, where security is on',
        "",
        _CONDITIONS.read_text(encoding="utf-8").rstrip("\n"),
        "",
        'case "$step" in',
        *(line for step in steps(cell) for line in _step(step)),
        *_move(cell),
        "  *)",
        '    echo "there is no step $step" >&2',
        "    exit 2",
        "    ;;",
        "esac",
    ]
    return Artifact(FILE, "\n".join(parts) + "\n")


def _names(cell: Cell) -> Iterator[str]:
    yield from (step.name for step in steps(cell))
    if movers(cell):
        yield from (f"{MOVE}_{target}" for target in _TARGETS)


def _step(step: Step) -> Iterator[str]:
    yield f"  {step.name}) # {step.stage}"
    yield from (f"    needs {condition}" for condition in step.waits_for)
    yield f"    act {step.command}"
    yield "    ;;"


def _move(cell: Cell) -> Iterator[str]:
    if movers(cell):
        for target in _TARGETS:
            yield f"  {MOVE}_{target}) # by a person; what stands behind the step is started then"
            yield from (f"    needs {condition}" for condition in ready_to_move(cell, target))
            yield "    shift"
            yield '    exec "$@"'
            yield "    ;;"
