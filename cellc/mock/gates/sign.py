"""Signs the gates by result."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from cellc.contract.vocabulary import GateCode
from cellc.mock.folder import GeneratedFolder
from cellc.mock.gates.command_path import command_path_checks, mock_run_checks
from cellc.mock.gates.gate import GateCheck, GateResult
from cellc.mock.gates.interaction import interaction_checks
from cellc.mock.gates.model import model_checks
from cellc.mock.gates.runs import NO_PHYSICS, GateEvidence, JudgedRun, PhysicsRuns
from cellc.mock.sweep.sweep import Sweep

# Name, title and state of the robot.
_GATES: tuple[tuple[GateCode, str, str, Callable[[GateEvidence], Iterator[GateCheck]]], ...] = (
    (GateCode.S2, "Interface selection checklist", "no hardware connected", interaction_checks),
    (GateCode.L6, "Command path", "mock, or drives off", command_path_checks),
    (GateCode.G1, "Model", "offline", model_checks),
    (GateCode.G2, "Mock", "no hardware connected", mock_run_checks),
)


def sign_gates(
    folder: GeneratedFolder,
    runs: Sequence[JudgedRun],
    seed: int,
    sweeps: Sequence[Sweep] = (),
    physics: PhysicsRuns = NO_PHYSICS,
) -> tuple[GateResult, ...]:
    """Judge every line of the gates that can be judged without hardware.

    Args:
        folder: what was executed.
        runs: its runs; of two with one name the last counts.
        seed: of the runs.
        sweeps: how often rehearsals succeeded where not everything is known exactly.
        physics: its rehearsals with masses.
    """
    evidence = GateEvidence(folder, tuple({run.name: run for run in runs}.values()), tuple(sweeps), physics)
    known = folder.contract.configuration_id
    return tuple(
        GateResult(gate, title, state, known, seed, tuple(_distinct(checks(evidence))), signed=not folder.edited)
        for gate, title, state, checks in _GATES
    )


def _distinct(checks: Iterable[GateCheck]) -> Iterator[GateCheck]:
    """Leave out a line that is there already."""
    seen: set[str] = set()
    for check in checks:
        if check.text not in seen:
            seen.add(check.text)
            yield check
