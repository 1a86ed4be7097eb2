"""One gate: what is checked in which state of the robot, the evidence it leaves, and what stops it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Check:
    """One line to tick; ``commands`` read and never change anything at the cell."""

    text: str
    commands: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Gate:
    """A gate of chapter 4.

    Args:
        code: ``G0`` to ``G7``, ``L1`` to ``L6``.
        state: state that the robot or its drives are in.
        evidence: name of the file that the gate must leave.
        owner: who signs, from the spec.
        stop: conditions under which nobody goes on.
    """

    code: str
    title: str
    state: str
    checks: tuple[Check, ...]
    evidence: str
    owner: str
    stop: tuple[str, ...]


def gate_text(gate: Gate) -> str:
    """Return the gate as a section of Markdown."""
    lines = [
        f"## {gate.code} {gate.title}",
        "",
        f"State: {gate.state}. Signed by: {gate.owner}. Evidence: `evidence/<attempt_id>/{gate.evidence}`.",
        "",
        *(line for check in gate.checks for line in _check_lines(check)),
        *([""] if gate.checks and not gate.checks[-1].commands else []),
        f"**Stop, and do not go on, on:** {'; '.join(gate.stop)}.",
    ]
    return "\n".join(lines)


def _check_lines(check: Check) -> Iterator[str]:
    yield f"- [ ] {check.text}"
    if check.commands:
        yield ""
        yield "  ```sh"
        yield from (f"  {command}" for command in check.commands)
        yield "  ```"
        yield ""
