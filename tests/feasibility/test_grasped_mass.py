"""The part that a gripper takes is what joints behind springs carry, by the mass that the spec states of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph.control_laws import control_laws
from tests.cells import graph_of, spec_text, there, written

_GRASP = "grasp: {width: 70 mm, tolerance: 2 mm, mass: 0.1 kg}"


def _part_kg(cell: Cell) -> float:
    return there(control_laws(cell)["arm"].part).mass_kg


def _cell(folder: Path, grasp: str, payload: str = "payload: {mass: 0.92 kg,") -> Cell:
    text = spec_text("fr3_hand")
    assert text.count(_GRASP) == 1
    changed = text.replace(_GRASP, grasp).replace("payload: {mass: 0.92 kg,", payload)
    return graph_of(written(folder, changed)).cell


@pytest.mark.parametrize("mass_kg", [0.1, 0.45])
def test_stated_mass_of_a_grasp_is_carried(mass_kg: float, tmp_path: Path) -> None:
    cell = _cell(tmp_path, _GRASP.replace("0.1 kg", f"{mass_kg} kg"))
    assert _part_kg(cell) == pytest.approx(mass_kg)


def test_part_of_the_payload_counts_before_it(tmp_path: Path) -> None:
    assert _part_kg(_cell(tmp_path, _GRASP, "payload: {part: 0.3 kg, mass: 0.92 kg,")) == pytest.approx(0.3)
