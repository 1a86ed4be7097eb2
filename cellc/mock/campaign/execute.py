"""Executes one run of a campaign, in whatever process."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence

from cellc.mock.campaign.limits import check_limits
from cellc.mock.campaign.limits_report import LimitsReport
from cellc.mock.campaign.run import CampaignRun, RunEnd
from cellc.mock.cell import MockCell
from cellc.mock.control.journal import CommandJournal, CommandSamples, Interruption
from cellc.mock.errors import MockError
from cellc.mock.plant import Plant
from cellc.mock.record import to_json_lines
from cellc.mock.result import RehearsalResult

CRASHED = "crashed"
"""Outcome of a run that ended in an exception of the mock; no fault may have it."""


def execute(cell: MockCell, run: CampaignRun, seed: int) -> RunEnd:
    """Execute a run; the same cell, run and seed give the same end to the last bit.

    Raises:
        MockError: a fault names what the contract does not have.
    """
    journals: list[CommandJournal] = []

    def watch(plant: Plant) -> None:
        for server in plant.control.servers():
            server.journal.listening = True
            journals.append(server.journal)

    try:
        result = cell.rehearse(run.entry, seed=seed, watch=watch)
    except MockError:
        raise
    except Exception as bug:  # a run that breaks the mock must not hide the runs after it
        return RunEnd(run, _crashed(run), LimitsReport(), "", f"{type(bug).__name__}: {bug}")
    taken = [journal.take() for journal in journals]
    samples = [each for found, _ in taken for each in found]
    interruptions = [each for _, found in taken for each in found]
    limits = check_limits(cell.contract, samples, interruptions)
    return RunEnd(run, result, limits, _digest(result, samples, interruptions))


def _crashed(run: CampaignRun) -> RehearsalResult:
    return RehearsalResult(
        name=run.identifier,
        outcome=CRASHED,
        expected=run.entry.expect,
        sim_time_s=0.0,
        response_s=None,
        within_s=run.within_s,
        attempts=(),
        bringup=(),
        findings=(),
    )


def _digest(result: RehearsalResult, samples: Sequence[CommandSamples], interruptions: Sequence[Interruption]) -> str:
    digest = hashlib.sha256(to_json_lines(result.attempts).encode())
    for each in samples:
        digest.update("\0".join((each.controller, *each.interfaces)).encode())
        digest.update(each.stamps_ns.tobytes() + each.values.tobytes())
    digest.update(repr((interruptions, result.outcome, result.response_s, result.findings)).encode())
    return digest.hexdigest()[:16]
