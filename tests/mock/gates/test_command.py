"""Gates on the command line: every line with its evidence, and an exit code."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cellc.contract.contract import Contract
from cellc.mock.command import campaign
from cellc.mock.faults.cases import FaultCase
from cellc.mock.faults.registry import possible_faults
from cellc.mock.task.context import TaskContext
from tests.cli.run import MINIMAL, run


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> str:
    output = tmp_path_factory.mktemp("generated")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return (Path(output) / "minimal").as_posix()


@pytest.fixture(autouse=True)
def _few_faults(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let the campaign have two kinds of fault: this is about what is printed."""

    def few(contract: Contract) -> tuple[FaultCase, ...]:
        return tuple(case for case in possible_faults(contract) if case.entry.kind in ("cancel", "protective_stop"))

    monkeypatch.setattr(campaign, "possible_faults", few)


def test_gates_are_printed_and_told_to_programs(folder: str) -> None:
    told = json.loads(run("gates", folder, "--json", "--jobs", "1").out)
    verdicts = {gate["gate"]: gate["verdict"] for gate in told["gates"]}
    assert list(verdicts) == ["S2", "L6", "G1", "G2"]
    assert "failed" not in verdicts.values()
    faults = [check for gate in told["gates"] for check in gate["checks"] if "Every fault" in check["text"]]
    assert [check["verdict"] for check in faults] == ["passed"]
    ran = run("gates", folder, "--jobs", "1")
    assert ran.code == 0
    for gate in told["gates"]:
        assert f"{gate['gate']} {gate['title']} ({gate['state']}): {gate['verdict']}" in ran.out
        assert gate["signature"] in ran.out


def test_gate_fails_where_a_watchdog_is_missing(folder: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TaskContext, "check_cell", lambda self: None)
    ran = run("gates", folder, "--jobs", "1")
    assert ran.code == 1
    assert "  FAILED   Every fault at every step ends in a named outcome within its bound" in ran.out
