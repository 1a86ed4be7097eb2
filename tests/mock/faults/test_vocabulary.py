"""The kinds of faults and the outcomes are the same words wherever they are listed."""

from __future__ import annotations

from cellc.compiler.rules.evidence.outcomes import _LAYERS
from cellc.compiler.spec import faults
from cellc.compiler.spec.faults import FAULT_KEYS, FaultFields
from cellc.contract.vocabulary import FaultKind
from cellc.mock import MockCell
from cellc.mock.faults.registry import FAULTS, possible_faults


def test_every_kind_of_fault_has_its_shape_in_the_spec_its_builder_and_its_layer() -> None:
    kinds = set(FaultKind)
    shapes = [shape for shape in vars(faults).values() if isinstance(shape, type) and issubclass(shape, FaultFields)]
    own = {next(iter(shape.__annotations__)) for shape in shapes if shape is not FaultFields}
    assert own == kinds
    assert set(_LAYERS) == kinds


def test_every_kind_of_fault_is_registered_once() -> None:
    assert sorted(fault.kind for fault in FAULTS) == sorted(FaultKind)


def test_cell_of_the_chapter_can_meet_every_kind_of_fault(cell: MockCell) -> None:
    acts_of_people = {"program_stop", "program_start", "jog"}  # stale_set_points is all three, in that order
    of_digital_signals = {"silent_sensor"}  # the cell has none; tests/mock/test_switched.py has
    met = {case.entry.kind for case in possible_faults(cell.contract)}
    assert met == set(FAULT_KEYS) - acts_of_people - of_digital_signals


def test_rule_expects_of_a_fault_what_the_mock_makes_of_it(cell: MockCell) -> None:
    for case in possible_faults(cell.contract):
        outcomes = {outcome for end in case.endings.values() for outcome in end.outcomes}
        assert outcomes & set(_LAYERS[case.entry.kind]), case.name
