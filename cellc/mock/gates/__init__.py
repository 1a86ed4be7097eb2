"""Gates L6, G1 and G2 and the interface checklist, each line judged by the evidence of runs and of the folder.

What the mock cannot show stays UNKNOWN; no line says anything about hardware.
"""

from cellc.mock.gates.gate import GateCheck, GateResult, Verdict
from cellc.mock.gates.runs import (
    NO_PHYSICS,
    JudgedRun,
    PhysicsRuns,
    judged_campaign,
    judged_rehearsals,
    rehearsed_with_masses,
)
from cellc.mock.gates.sign import sign_gates

__all__ = [
    "NO_PHYSICS",
    "GateCheck",
    "GateResult",
    "JudgedRun",
    "PhysicsRuns",
    "Verdict",
    "judged_campaign",
    "judged_rehearsals",
    "rehearsed_with_masses",
    "sign_gates",
]
