"""``gates/promotion.md`` and ``gates/network.md``: G0–G7 and L1–L6 for this cell.

Markdown checklists for the people at the cell. Commands read, or start what is released at that gate; what enables or
moves anything is a step of the vendor's procedure and stands here as words. The page is copied into the evidence folder
of an attempt, where it is filled in and signed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.deploy.deployment import Deployment
from cellc.deploy.files import NETWORK_CHECKLIST, PROMOTION_CHECKLIST
from cellc.deploy.gates import Check, Gate
from cellc.formats.escape import markdown, markdown_comment
from cellc.graph.cell_graph import CellGraph

_PROMOTION = (
    "Gates are passed in order, each with its evidence, and none is skipped. A gate that stops is entered again from "
    "its first line."
)
_NETWORK = (
    "Layers are passed from the cable up, with drives disabled. A layer that fails is mended at that layer: no "
    "firewall, watchdog or limit is weakened to pass one."
)
_WHERE = (
    "Commands run in the folder that holds `cells/` and `generated/`, in a shell that is set up as `README.md` says, "
    "with `E` set to the folder of the attempt. What starts something needs a shell that stays open. A command that "
    "ends at its timeout, or finds no node, is run once more before its answer counts. An evidence file that no "
    "command writes is written by hand."
)


_RESULT = "Result (passed or stopped): ________ Name: ________________ Date, time: ________________ Signature: ________"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield both checklists."""
    name = graph.cell.name
    promotion = _page(plan, f"{name}: From the manifest to a trajectory", _PROMOTION, plan.promotion)
    network = _page(plan, f"{name}: From the cable to the command path", _NETWORK, plan.network)
    yield Artifact(PROMOTION_CHECKLIST, promotion)
    yield Artifact(NETWORK_CHECKLIST, network)


def _page(plan: Deployment, title: str, text: str, gates: tuple[Gate, ...]) -> str:
    blocks = [markdown_comment(plan.header.text), f"# {title}", f"{text} {_WHERE}", *(_gate(gate) for gate in gates)]
    return "\n\n".join(blocks) + "\n"


def _gate(gate: Gate) -> str:
    passed = f"*{gate.state[0].upper()}{gate.state[1:]}.* Passed when {markdown(gate.shows)}."
    signed = (
        f"Evidence `{gate.evidence}`, signed by {markdown(gate.owner)}. **Stop on:** {markdown('; '.join(gate.stop))}."
    )
    checks = "\n".join(line for check in gate.checks for line in _check(check, gate.evidence)).rstrip("\n")
    measured = ". ".join(f"{markdown(one[0].upper() + one[1:])}: ________" for one in gate.measured)
    blocks = (f"## {gate.code} {gate.title}", passed, checks, signed, measured, _RESULT)
    return "\n\n".join(block for block in blocks if block)


def _check(check: Check, evidence: str) -> Iterator[str]:
    yield f"- [ ] {markdown(check.text)}"
    if check.commands:
        lines = [line for command in check.commands for line in command.splitlines()]
        yield ""
        yield "  ```sh"
        yield from (f"  {line}" for line in (lines if check.starts else _kept(lines, evidence)))
        yield "  ```"
        yield ""


def _kept(lines: list[str], evidence: str) -> Iterator[str]:
    """Write what is read into the evidence of the gate as well."""
    into = f'2>&1 | tee -a "$E/{evidence}"'
    if len(lines) == 1:
        yield f"{{ {lines[0]}; }} {into}" if "|" in lines[0] else f"{lines[0]} {into}"
        return
    yield from ("{", *(f"  {line}" for line in lines), f"}} {into}")
