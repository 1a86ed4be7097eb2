"""``rehearsals.json``: what the mock executes, and the outcome that each run must end in.

Format 2, ``cellc.contract.rehearsals``: every name resolved, times in simulated seconds. Read by ``cellc.mock``. Left
out: ``use``; a rehearsal that takes another's steps carries its own copy.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.artifact import Artifact
from cellc.compiler.cell.motion import Fault, Rehearsal, Step
from cellc.compiler.deploy.deployment import Deployment
from cellc.compiler.deploy.files import REHEARSALS
from cellc.compiler.formats.json_text import render
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.grips import gripped_parts
from cellc.contract.diagnostics import YamlPath
from cellc.contract.rehearsals import FaultEntry, RehearsalEntry, Rehearsals, StepEntry


def emit(graph: CellGraph, plan: Deployment) -> Iterator[Artifact]:
    """Yield the rehearsals."""
    parts = gripped_parts(graph.cell, graph.frames)
    entries = tuple(_rehearsal(rehearsal, parts) for rehearsal in graph.cell.rehearsals)
    model = Rehearsals(format=2, rehearsals=entries)
    yield Artifact(REHEARSALS, render(model))


def _rehearsal(rehearsal: Rehearsal, parts: Mapping[YamlPath, str]) -> RehearsalEntry:
    return RehearsalEntry.model_validate(
        {
            "name": rehearsal.name,
            "steps": tuple(_step(step, parts) for step in rehearsal.steps),
            "faults": tuple(map(_fault, rehearsal.faults)),
            "expect": rehearsal.expect,
            "within_s": rehearsal.within_s,
            "timeout_s": rehearsal.timeout_s,
            "bring_up": rehearsal.bring_up,
        }
    )


def _step(step: Step, parts: Mapping[YamlPath, str]) -> StepEntry:
    return StepEntry.model_validate(
        {
            "kind": step.kind,
            "target": step.name,
            "command": step.command,
            "part": parts.get(step.path),
            "state": step.state,
            "duration_s": step.duration_s,
        }
    )


def _fault(fault: Fault) -> FaultEntry:
    event, by = fault.event, fault.kind.by
    return FaultEntry.model_validate(
        {
            "kind": fault.kind,
            "target": fault.name,
            "at_s": fault.at_s,
            "event": None if event is None else {"step": event.step, "when": event.when, "after_s": event.after_s},
            "phase": fault.phase,
            "lasting_s": fault.lasting_s,
            "cycles": fault.cycles,
            **({} if by is None else {by.amount.field: fault.amount}),
        }
    )
