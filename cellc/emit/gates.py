"""``gates/promotion.md`` and ``gates/network.md``: G0–G7 and L1–L6 of chapter 4 for this cell.

Markdown checklists for the people at the cell. Commands read, or start what is released at that gate; what enables or
moves anything is a step of the vendor's procedure and stands here as words. Left out: results, which belong into the
evidence folder of an attempt.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.deploy.gates import Check, Gate, promotion_gates
from cellc.deploy.network_gates import network_gates
from cellc.formats.header import Header
from cellc.graph.cell_graph import CellGraph

_PROMOTION = (
    "Gates are passed in order, each with its evidence, and none is skipped. A gate that stops is entered again from "
    "its first line."
)
_NETWORK = (
    "Layers are passed from the cable up, with drives disabled. A layer that fails is mended at that layer: no "
    "firewall, watchdog or limit is weakened to pass one."
)


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield both checklists."""
    cell = graph.cell
    for name, title, text, gates in (
        ("promotion", "From the manifest to a trajectory", _PROMOTION, promotion_gates(cell, header)),
        ("network", "From the cable to the command path", _NETWORK, network_gates(graph)),
    ):
        yield Artifact(f"gates/{name}.md", _page(header, f"{cell.name}: {title}", text, gates))


def _page(header: Header, title: str, text: str, gates: tuple[Gate, ...]) -> str:
    where = (
        "Commands run in the folder that holds `cells/` and `generated/`, with `E` set to the folder of the attempt; "
        "`README.md` leads through the gates."
    )
    blocks = [f"<!--\n{header.text}\n-->", f"# {title}", f"{text} {where}", *map(_gate, gates)]
    return "\n\n".join(blocks) + "\n"


def _gate(gate: Gate) -> str:
    lines = [
        f"## {gate.code} {gate.title}",
        "",
        f"State: {gate.state}. Signed by: {gate.owner}. Evidence: `evidence/<attempt_id>/{gate.evidence}`.",
        "",
        *(line for check in gate.checks for line in _check(check)),
        *([""] if gate.checks and not gate.checks[-1].commands else []),
        f"**Stop, and do not go on, on:** {'; '.join(gate.stop)}.",
    ]
    return "\n".join(lines)


def _check(check: Check) -> Iterator[str]:
    yield f"- [ ] {check.text}"
    if check.commands:
        yield ""
        yield "  ```sh"
        yield from (f"  {line}" for command in check.commands for line in command.splitlines())
        yield "  ```"
        yield ""
