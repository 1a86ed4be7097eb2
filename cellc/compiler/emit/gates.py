"""``gates/promotion.md`` and ``gates/network.md``: G0–G7 and L1–L6 for this cell.

``gates/gates.json`` is what they have set in robots, and what is known of the versions, as data.

Markdown checklists for the people at the cell. Commands read, or start what is authorized at that gate; steps of a
vendor's procedure, which enable or move anything, are words. The page is copied into the evidence folder of an attempt,
filled in there and signed.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import NETWORK_CHECKLIST, PROMOTION_CHECKLIST
from cellc.compiler.deploy.gates import Check, Gate
from cellc.compiler.formats.escape import code, markdown, markdown_comment
from cellc.compiler.formats.json_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.versions import compatibility
from cellc.contract.gates import GATES, Gates, GateSetting, PinAnswer

_PROMOTION = (
    "Pass the gates in order and record the evidence of each. Skip none. If a gate fails, repeat it from its first "
    "line."
)
_NETWORK = (
    "Pass the layers from the cable up, with drives disabled. Fix each failure in its own layer. Do not relax a "
    "firewall, a watchdog or a limit in order to pass."
)
_WHERE = (
    "Run commands in the folder that contains `cells/` and `generated/`, in a shell set up as in `README.md`. Set `E` "
    "to the evidence folder of this attempt. Leave the shells of launches and recordings open. If a command times out "
    "or finds no node, run it once more before you record a failure. If no command writes the evidence file, write it "
    "by hand."
)


_RESULT = "Result (passed or stopped): ________ Name: ________________ Date, time: ________________ Signature: ________"


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield both checklists, and what they hold as data."""
    name = graph.cell.name
    promotion = _page(plan, f"{name}: From the manifest to a trajectory", _PROMOTION, plan.promotion)
    network = _page(plan, f"{name}: From the cable to the command path", _NETWORK, plan.network)
    yield Artifact(PROMOTION_CHECKLIST, promotion)
    yield Artifact(NETWORK_CHECKLIST, network)
    checks = (check for gate in (*plan.promotion, *plan.network) for check in gate.checks)
    settings = list[GateSetting]()
    for setting in (check.setting for check in checks if check.setting is not None):
        settings += () if setting in settings else (setting,)
    versions = tuple(
        PinAnswer(holder=judged.pin.holder, part=judged.pin.part, answer=judged.answer.value, reason=judged.evidence)
        for judged in compatibility(graph.cell)
    )
    yield Artifact(GATES, render(Gates(format=1, settings=tuple(settings), versions=versions)))


def _page(plan: Deployment, title: str, text: str, gates: tuple[Gate, ...]) -> str:
    blocks = [markdown_comment(plan.header.text), f"# {title}", f"{text} {_WHERE}", *(_gate(gate) for gate in gates)]
    return "\n\n".join(blocks) + "\n"


def _gate(gate: Gate) -> str:
    passed = f"*{gate.state[0].upper()}{gate.state[1:]}.* Passed when {markdown(gate.shows)}."
    signed = (
        f"Evidence: `{gate.evidence}`. Signed by: {code(gate.owner)}. **Stop on:** {markdown('; '.join(gate.stop))}."
    )
    checks = "\n".join(line for check in gate.checks for line in _check(check, gate.evidence)).rstrip("\n")
    measured = ". ".join(f"{markdown(text[0].upper() + text[1:])}: ________" for text in gate.measured)
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
    """Also write the output of commands into the evidence of the gate."""
    into = f'2>&1 | tee -a "$E/{evidence}"'
    if len(lines) == 1:
        yield f"{{ {lines[0]}; }} {into}" if "|" in lines[0] else f"{lines[0]} {into}"
        return
    yield from ("{", *(f"  {line}" for line in lines), f"}} {into}")
