"""The prose of the gates is data: what it names exists, every subject is asked for, and nothing is left unfilled."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from cellc.compiler.deploy.deployment import plan_deployment
from cellc.compiler.deploy.gate_subjects import CELL, FIELDS, ROWS, cell_row
from cellc.compiler.deploy.gates import Line, gate_texts
from cellc.compiler.formats.header import Header
from cellc.contract.vocabulary import GateCode
from tests.cells import CELLS, built

_TEXTS = (*gate_texts().promotion, *gate_texts().network)


def test_every_gate_of_the_vocabulary_has_its_prose() -> None:
    assert [text.code for text in _TEXTS] == [code for code in GateCode if code is not GateCode.S2]
    assert len({text.evidence for text in _TEXTS}) == len(_TEXTS)


def test_every_subject_is_asked_for() -> None:
    lines = [line for text in _TEXTS for line in (*text.checks, *text.stop)]
    closed = {"unmoved"}
    assert {line.of for line in lines} | {line.each for line in lines if line.each} | closed == {*FIELDS, CELL}


@pytest.mark.parametrize("cell", CELLS)
def test_subjects_have_the_fields_that_they_state(cell: str) -> None:
    graph = built(cell).graph
    assert set(cell_row(graph.cell, Header(cell, "cellc build"), GateCode.G0)) == set(FIELDS[CELL])
    for name, rows in ROWS.items():
        assert all(len(values) == len(FIELDS[name]) for values in rows(graph)), name


@pytest.mark.parametrize("cell", CELLS)
def test_no_placeholder_is_left_and_every_gate_checks_and_stops(cell: str) -> None:
    plan = plan_deployment(built(cell).graph)
    for gate in (*plan.promotion, *plan.network):
        assert gate.checks
        assert gate.stop
        said = [check.text for check in gate.checks] + [command for check in gate.checks for command in check.commands]
        assert not [one for one in (*said, *gate.stop, gate.owner) if "{" in one or "None" in one], gate.code


def test_text_that_names_what_its_subject_lacks_is_refused() -> None:
    with pytest.raises(ValidationError, match="`device` has no rate"):
        Line(of="device", text="{device} at {rate}")
    with pytest.raises(ValidationError, match=r"expected one of cell, .*, got `robot`"):
        Line(of="robot", text="it stands")


def test_what_is_stated_around_the_arms_is_measured_in_g1() -> None:
    (gate,) = (gate for gate in plan_deployment(built("ur5e_pick").graph).promotion if gate.code == GateCode.G1)
    said = [check.text for check in gate.checks]
    measured = "Measure around each arm. Compare its"
    assert f"{measured} support with the spec: table, and nothing else within reach." in said
    assert f"{measured} walls with the spec: nothing within reach; the nearest is 3 m away." in said
