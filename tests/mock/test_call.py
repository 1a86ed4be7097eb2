"""The step `call`: a service is asked, and an answer that stays away ends the rehearsal in a bounded time."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from cellc.contract.attempt import AttemptRecord
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry, FaultEvent, RehearsalEntry, StepEntry
from cellc.contract.steps import StepKind
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock import load
from cellc.mock.cell import cell_of
from cellc.mock.folder import GeneratedFolder
from cellc.mock.result import RehearsalResult
from tests.cells import diagnose, spec_text, written

SERVICE = "/arm_io/zero_ftsensor"


@pytest.fixture(scope="module")
def folder(built_folder: Path) -> GeneratedFolder:
    """The folder of cells/ur5e_pick, whose task is a client of the services of arm_io."""
    return load(built_folder).folder


def _run(folder: GeneratedFolder, *faults: FaultEntry, target: str = SERVICE) -> RehearsalResult:
    steps = (StepEntry(kind=StepKind.CALL, target=target), StepEntry(kind="wait", target="", duration_s=0.5))
    entry = RehearsalEntry(name="called", steps=steps, faults=faults, expect=AttemptOutcome.SUCCEEDED, timeout_s=60.0)
    return cell_of(folder).rehearse(entry)


def _first(result: RehearsalResult) -> AttemptRecord:
    return result.attempts[0]


def _stating(folder: GeneratedFolder, **facts: Any) -> GeneratedFolder:
    """Return the folder with other facts of the service."""
    changed = replace(folder.contract.interfaces[SERVICE], **facts)
    interfaces = {**folder.contract.interfaces, SERVICE: changed}
    return replace(folder, contract=folder.contract.model_copy(update={"interfaces": interfaces}))


def _hit(kind: FaultKind, target: str) -> FaultEntry:
    return FaultEntry(kind=kind, target=target, event=FaultEvent(step=1))


def test_service_that_answers_lets_the_task_go_on_at_once(folder: GeneratedFolder) -> None:
    result = _run(folder)
    assert result.outcome == "succeeded"
    assert (_first(result).step, _first(result).outcome) == (f"call {SERVICE}", "succeeded")
    assert _first(result).ended_ns - _first(result).started_ns < 50_000_000


@pytest.mark.parametrize("hit", [_hit(FaultKind.UNRESPONSIVE, "arm_io"), _hit(FaultKind.MISMATCH_QOS, SERVICE)])
def test_service_that_does_not_answer_is_given_up_when_its_timeout_is_over(
    folder: GeneratedFolder, hit: FaultEntry
) -> None:
    ended = _first(_run(_stating(folder, timeout_s=0.25), hit))
    assert (ended.outcome, ended.fault_code) == ("timeout", f"no answer from {SERVICE} within 0.25 s")
    assert ended.ended_ns - ended.started_ns < 300_000_000


def test_service_without_a_timeout_is_given_up_after_a_second(folder: GeneratedFolder) -> None:
    ended = _first(_run(folder, _hit(FaultKind.UNRESPONSIVE, "arm_io")))
    assert ended.fault_code == f"no answer from {SERVICE} within 1 s"


def test_client_that_goes_on_without_an_answer_waits_for_it_first(folder: GeneratedFolder) -> None:
    stated = _stating(folder, timeout_s=0.25, on_timeout="continue")
    result = _run(stated, _hit(FaultKind.UNRESPONSIVE, "arm_io"))
    assert result.outcome == "succeeded"
    assert _first(result).ended_ns - _first(result).started_ns >= 250_000_000


def test_task_that_is_no_client_is_the_wrong_owner(folder: GeneratedFolder) -> None:
    ended = _first(_run(_stating(folder, sinks=())))
    assert (ended.outcome, ended.fault_code) == ("wrong_owner", f"task is not a client of {SERVICE}")


def test_name_of_no_service_is_refused(folder: GeneratedFolder) -> None:
    assert _first(_run(folder, target="/move_action")).outcome == "goal_rejection"


def test_service_that_nobody_offers_is_found_where_it_is_called(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace("steps: [", "steps: [call: /arm_io/zero_ftsenso, ", 1)
    found = [diagnosis for diagnosis in diagnose(written(tmp_path, text)) if diagnosis.code == "unknown-interface"]
    assert [finding.span.line for finding in found] == [text[: text.index("zero_ftsenso,")].count("\n") + 1]
    assert f"`{SERVICE}`" in found[0].help
