"""Every arm of the catalog says how people move one joint of it by hand, and gate G6 has that way."""

from __future__ import annotations

import pytest

from cellc.compiler.catalog.load import device_names
from tests.cells import EVERY_CELL, built, device_of

_ARMS = tuple(name for name in device_names() if device_of(name).model.kind == "arm")


@pytest.mark.parametrize("name", _ARMS)
def test_an_arm_states_its_jog_with_a_source(name: str) -> None:
    jog = device_of(name).model.jog
    assert jog is not None
    assert jog.source
    # People read the angle somewhere: in the joint states of a driver that runs, or where the fact says.
    assert jog.driver_runs or "read" in jog.does.lower()


@pytest.mark.parametrize("cell", sorted(set(EVERY_CELL) - {"rail_arm"}))
def test_gate_g6_has_the_way_of_each_arm_that_moves_first(cell: str) -> None:
    graph, texts = built(cell).graph, built(cell).texts
    gate = texts["gates/promotion.md"].split("\n## G6")[1].split("\n## G7")[0]
    for first in graph.cell.bringup.first_motions:
        device = graph.cell.device(first.device)
        if device.kind == "arm":
            assert device.procedures.jog is not None
            assert device.procedures.jog in gate.replace("\\", "")
