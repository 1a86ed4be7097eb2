"""How many lines of a gate passed: counted in one place, by hand here, and only printed by pages and by the command."""

from __future__ import annotations

import pytest

import cellc.mock.report_page.page as page
from cellc.contract.vocabulary import GateCode
from cellc.mock.gates.gate import GateCheck, GateResult, Tally, Verdict, gate_lines

P, F, U = Verdict.PASSED, Verdict.FAILED, Verdict.UNKNOWN


def gate_of(*verdicts: Verdict) -> GateResult:
    checks = tuple(GateCheck(f"line {number}", verdict, ("seen",)) for number, verdict in enumerate(verdicts))
    return GateResult(GateCode("G1"), "Model", "drives off", "id", 0, checks)


@pytest.mark.parametrize(
    ("each", "good", "bad", "all_good"),
    [((), 0, 0, False), ((True,), 1, 0, True), ((False,), 0, 1, False), ((True, False, False), 1, 2, False)],
)
def test_none_is_not_all(each: tuple[bool, ...], good: int, bad: int, all_good: bool) -> None:
    tally = Tally.of(each)
    assert (tally.good, tally.bad, tally.total, tally.all_good) == (good, bad, good + bad, all_good)


def test_page_and_command_name_the_lines_that_passed() -> None:
    gate = gate_of(P, U, F, U, P, U)  # two passed, one failed, three not known
    assert [gate.tally(verdict).good for verdict in Verdict] == [2, 1, 3]
    assert ", 2 of 6 lines passed" in "".join(page.gate_section([gate]).itertext())
    assert next(iter(gate_lines([gate]))) == "G1 Model (drives off): failed; 2 passed, 1 failed, 3 UNKNOWN"
    assert ", 1 of 1 line passed" in "".join(page.gate_section([gate_of(P)]).itertext())


@pytest.mark.parametrize(
    ("verdicts", "of_all"), [((), F), ((P,), P), ((P, U), U), ((P, U, F), F), ((F, P), F), ((U, U), U)]
)
def test_gate_is_as_good_as_its_worst_line(verdicts: tuple[Verdict, ...], of_all: Verdict) -> None:
    assert gate_of(*verdicts).verdict is of_all
