"""What a report is made of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellc.contract.contract import Contract
from cellc.contract.rehearsals import RehearsalEntry
from cellc.mock.campaign.campaign import Campaign
from cellc.mock.evidence.kpis import Kpi
from cellc.mock.evidence.run_trace import TraceResult
from cellc.mock.gates.gate import GateResult
from cellc.mock.result import RehearsalResult


@dataclass(frozen=True, slots=True)
class RunEvidence:
    """What the report knows of one rehearsal; the trace is None where a controller manager never came up.

    Attributes:
        tolerances: path tolerance of each joint that has one, rad or m.
        files: names of the files beside the report.
    """

    entry: RehearsalEntry
    result: RehearsalResult
    trace: TraceResult | None
    kpis: tuple[Kpi, ...]
    tolerances: Mapping[str, float]
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ReportContent:
    """All of one call.

    Attributes:
        notes: what is odd about the generated folder.
        seed: of everything that was drawn.
        campaign: every fault at every step; None where it was not run.
    """

    contract: Contract
    notes: tuple[str, ...]
    seed: int
    runs: tuple[RunEvidence, ...]
    gates: tuple[GateResult, ...]
    campaign: Campaign | None = None
