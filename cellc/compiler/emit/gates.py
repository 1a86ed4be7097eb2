"""``gates/promotion.md`` and ``gates/network.md``: G0–G7 and L1–L6 for this cell.

Markdown checklists for the people at the cell. Commands read, or start what is authorized at that gate; steps of a
vendor's procedure, which enable or move anything, are words. The page is copied into the evidence folder of an attempt,
filled in there and signed.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cellc.compiler.artifact import Artifact
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import NETWORK_CHECKLIST, PROMOTION_CHECKLIST
from cellc.compiler.deploy.gates import Check, Gate, gate_texts
from cellc.compiler.formats.escape import code, markdown, markdown_comment
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.simulated import is_asked


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield both checklists."""
    texts = gate_texts()
    for path, page, gates in (
        (PROMOTION_CHECKLIST, texts.pages["promotion"], plan.promotion),
        (NETWORK_CHECKLIST, texts.pages["network"], plan.network),
    ):
        usage = texts.usage.replace("{cell}", graph.cell.name)
        title, text = f"# {graph.cell.name}: {page.title}", f"{page.text} {usage}"
        text += f" {texts.simulated}" if is_asked(graph.cell) else ""
        blocks = [markdown_comment(plan.header.text), title, text, *(_gate(gate, texts.result) for gate in gates)]
        yield Artifact(path, "\n\n".join(blocks) + "\n")


def _gate(gate: Gate, result: str) -> str:
    passed = f"*{gate.state[0].upper()}{gate.state[1:]}.* Passed when {markdown(gate.shows)}."
    stop = markdown("; ".join(gate.stop))
    signed = f"Evidence: `{gate.evidence}`. Signed by: owner {code(gate.owner)}. **Stop on:** {stop}."
    checks = "\n".join(line for check in gate.checks for line in _check(check, gate.evidence)).rstrip("\n")
    measured = ". ".join(f"{markdown(text[0].upper() + text[1:])}: ________" for text in gate.measured)
    blocks = (f"## {gate.code} {gate.title}", passed, checks, signed, measured, result)
    return "\n\n".join(block for block in blocks if block)


def _check(check: Check, evidence: str) -> Iterator[str]:
    yield f"- [ ] {markdown(check.text)}"
    if check.commands:
        lines = [line for command in check.commands for line in command.splitlines()]
        yield ""
        yield "  ```sh"
        kept = lines if check.starts else _kept(lines, evidence, traced=check.traced)
        yield from (f"  {part}" for line in kept for part in _broken(line))
        yield "  ```"
        yield ""


def _kept(lines: list[str], evidence: str, *, traced: bool) -> Iterator[str]:
    """Also write the output of commands into the evidence of the gate."""
    into = f'2>&1 | tee -a "$E/{evidence}"'
    if len(lines) == 1:
        yield f"{{ {lines[0]}; }} {into}" if "|" in lines[0] else f"{lines[0]} {into}"
        return
    start, end = ("(set -x", ")") if traced else ("{", "}")
    yield from (start, *(f"  {line}" for line in lines), f"{end} {into}")


_WIDE = 80
"""Characters of a line of commands that a page of A4 shows whole."""
_WORD = re.compile(r'2>&1 \| tee -a "[^"]*"|(?:"[^"]*"|\'[^\']*\'|\\.|[^\s"\'\\])+')


def _broken(line: str) -> Iterator[str]:
    """Yield a line of commands as a shell reads it over several lines, each as wide as paper; quotes stay whole."""
    words = _WORD.findall(line)
    indent = line[: len(line) - len(line.lstrip())]
    if len(line) <= _WIDE or indent + " ".join(words) != line or any(word.startswith("#") for word in words):
        yield line
        return
    part, *others = _joined(words)
    part = indent + part
    for other in others:
        if len(part) + len(other) + len(" \\ ") > _WIDE:
            yield part + " \\"
            part = f"{indent}    {other}"
        else:
            part += f" {other}"
    yield part


def _joined(words: list[str]) -> Iterator[str]:
    """Yield words, an option with its value and a pipe with its command as one."""
    parts = list[str]()
    for word in words:
        before = parts[-1] if parts else ""
        if (
            word == "}"
            or before in ("|", "&&", "||", "{")
            or (before.startswith("-") and " " not in before and word[0] not in "-|&2")
        ):
            parts[-1] += f" {word}"
        else:
            parts.append(word)
    yield from parts
