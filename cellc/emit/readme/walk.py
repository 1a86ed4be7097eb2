"""The way through the gates: one table that fits a screen, then each gate with its commands, evidence and stop."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import groupby

from cellc.cell.cell import Cell
from cellc.deploy.gates import Check, Gate, promotion_gates, starts
from cellc.deploy.network_gates import network_gates
from cellc.formats.header import Header
from cellc.graph.cell_graph import CellGraph

_HEAD = ("gate", "what it shows", "first command", "evidence", "signed by", "stop on")
_INSIDE = "G3"  # the layers are passed in the middle of this gate


def overview(graph: CellGraph, header: Header) -> str:
    """Return the gates as a table, the layers of the network apart."""
    rows = [_row(gate) for gate in promotion_gates(graph.cell, header)]
    layers = [_row(layer) for layer in network_gates(graph)]
    between = f"{_INSIDE} is passed layer by layer, from the cable to the command path:"
    return "\n\n".join((_table(rows), between, _table(layers)))


def walk(graph: CellGraph, header: Header) -> Iterator[str]:
    """Yield the blocks of each gate in order, the layers after the gate that they belong to."""
    for gate in promotion_gates(graph.cell, header):
        yield from _section(gate, "###")
        if gate.code == _INSIDE:
            for layer in network_gates(graph):
                yield from _section(layer, "####")


def shell_of(cell: Cell) -> str:
    """Return what every shell needs once: the built package, the host's environment, the folder of the attempt."""
    environments = [f"source generated/{cell.name}/middleware/{host}.sh  # on {host}" for host in cell.hosts]
    return fenced(
        (
            f"colcon build --base-paths generated --packages-select {cell.name}  # once",
            "source install/setup.bash",
            *environments,
            'export E=evidence/attempt-001 && mkdir -p "$E"  # a new folder for each attempt',
        )
    )


def fenced(lines: Iterable[str]) -> str:
    """Return lines as a block for a shell."""
    return "\n".join(["```sh", *lines, "```"])


def _row(gate: Gate) -> tuple[str, ...]:
    anchor = f"{gate.code} {gate.title}".lower().replace(",", "").replace(" ", "-")
    # Up to a pipe, whose bar would end the cell.
    command = f"`{gate.key_command.partition(' | ')[0]}`" if gate.key_command else "by people"
    return (
        f"[{gate.code}](#{anchor}) {gate.title}",
        gate.shows,
        command,
        gate.evidence,
        gate.owner,
        "; ".join(gate.stop),
    )


def _table(rows: list[tuple[str, ...]]) -> str:
    return "\n".join(f"| {' | '.join(cells)} |" for cells in (_HEAD, ("---",) * len(_HEAD), *rows))


def _section(gate: Gate, level: str) -> Iterator[str]:
    yield f"{level} {gate.code} {gate.title}"
    yield f"*{gate.state[0].upper()}{gate.state[1:]}.* Passed when {gate.shows}."
    # Runs of one kind, so that the order of the checks stays the order of the steps.
    for kind, checks in groupby(gate.checks, key=_kind):
        yield _ABOUT[kind]
        yield _BLOCKS[kind](gate, list(checks))
    yield f"Evidence `{gate.evidence}`, signed by {gate.owner}. **Stop on:** {'; '.join(gate.stop)}."


def _kind(check: Check) -> str:
    if not check.commands:
        return "people"
    return "start" if any(map(starts, check.commands)) else "read"


def _start(gate: Gate, checks: list[Check]) -> str:
    return fenced(_lines(checks))


def _read(gate: Gate, checks: list[Check]) -> str:
    return fenced(("{", *_lines(checks), f'}} 2>&1 | tee -a "$E/{gate.evidence}"'))


def _people(gate: Gate, checks: list[Check]) -> str:
    return "\n".join(f"- {check.text}" for check in checks)


_ABOUT = {
    "people": "People look, do and write down:",
    "start": "Start, each in a shell that stays open:",
    "read": "Read, into the evidence:",
}
_BLOCKS: Mapping[str, Callable[[Gate, list[Check]], str]] = {"people": _people, "start": _start, "read": _read}


def _lines(checks: list[Check]) -> Iterator[str]:
    for check in checks:
        yield f"# {check.text}"
        yield from (line for command in check.commands for line in command.splitlines())
