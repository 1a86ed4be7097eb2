"""A kind of fault is declared once; the mock plays each, and the outcomes that a rule expects are those it ends in."""

from __future__ import annotations

from cellc.contract.faults import FaultKind
from cellc.mock import MockCell
from cellc.mock.faults.registry import FAULTS, possible_faults


def test_every_kind_of_fault_is_played() -> None:
    assert set(FAULTS) == set(FaultKind)


def test_cell_of_the_chapter_can_meet_every_kind_of_fault(cell: MockCell) -> None:
    acts_of_people = {"program_stop", "program_start", "jog"}  # stale_set_points is all three, in that order
    of_digital_signals = {"silent_sensor"}  # the cell has none; tests/mock/test_switched.py has
    met = {case.entry.kind for case in possible_faults(cell.contract)}
    assert met == set(FaultKind) - acts_of_people - of_digital_signals


def test_rule_expects_of_a_fault_what_the_mock_makes_of_it(cell: MockCell) -> None:
    for case in possible_faults(cell.contract):
        outcomes = {outcome for end in case.endings.values() for outcome in end.outcomes}
        assert outcomes & set(case.entry.kind.layers), case.name
