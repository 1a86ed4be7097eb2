"""A gate cites the sweep by which it judges a rate of success, and knows nothing before one was made."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cellc.mock import MockCell
from cellc.mock.gates import GateCheck, Verdict, sign_gates
from cellc.mock.sweep.figures import interval
from cellc.mock.sweep.runs import SweepRun, SweepRuns
from cellc.mock.sweep.sweep import Sweep, uncertainty_of
from tests.cli.run import run
from tests.mock.gates.conftest import line


def _judged(pick: MockCell, *sweeps: Sweep) -> GateCheck:
    mock_gate = next(gate for gate in sign_gates(pick.folder, (), 0, sweeps) if gate.gate == "G2")
    return line(mock_gate, "pick_and_place succeeds in 0.99 of its runs or more")


def _swept(pick: MockCell, verdict: bool | None) -> Sweep:
    runs = SweepRuns.listed(SweepRun(number, "succeeded", number > 0, {}, None, "") for number in range(800))
    drawn = uncertainty_of(pick)
    expected = drawn.expected["pick_and_place"]
    return Sweep("pick_and_place", 7, drawn, 1000, runs, interval(799, 800, 0.95), expected, verdict)


def test_a_rate_without_its_sweep_is_unknown_and_says_what_would_show_it(pick: MockCell) -> None:
    check = _judged(pick)
    assert check.verdict is Verdict.UNKNOWN
    assert check.evidence == (
        "a sweep of pick_and_place that decides it with confidence 0.95: `cellc gates --sweep N`",
    )


@pytest.mark.parametrize(("verdict", "said"), [(True, Verdict.PASSED), (False, Verdict.FAILED)])
def test_a_rate_is_judged_by_its_sweep_which_is_cited(pick: MockCell, verdict: bool, said: Verdict) -> None:
    check = _judged(pick, _swept(pick, verdict))
    assert check.verdict is said
    assert check.evidence == (
        f"pick_and_place: 800 runs with seed 7, 799 succeeded, {pick.contract.configuration_id}",
        # One failure of 800: 0.0032 % to 0.694 % by the quantiles of the beta distribution.
        "success: 99.88 %, between 99.31 % and 100 % with confidence 0.95 (Clopper-Pearson)",
    )


def test_a_sweep_that_decides_nothing_leaves_the_line_unknown(pick: MockCell) -> None:
    check = _judged(pick, _swept(pick, None))
    assert check.verdict is Verdict.UNKNOWN
    assert "`cellc gates --sweep N` above 800; success: 99.88 %" in check.evidence[0]


def test_another_sweep_is_another_signature(pick: MockCell) -> None:
    one = _swept(pick, True)
    other = replace(one, seed=8)
    signatures = {sign_gates(pick.folder, (), 0, sweeps)[-1].signature for sweeps in ((), (one,), (other,))}
    assert len(signatures) == 3


def test_gates_take_a_sweep_and_not_one_rehearsal() -> None:
    assert "No such option" in run("gates", "x/none", "--sweep", "9", "--rehearsal", "a").err
    assert "no such folder" in run("gates", "x/none", "--sweep", "9", "--journal", "y").err
