"""One table for each arm says what the real one does, and it is what the mock is given to play."""

from __future__ import annotations

import json
from collections.abc import Mapping

import pytest

from cellc.compiler.catalog.load import device_names
from cellc.tools.browse.page import behavior, page
from tests.cells import built, device_of, there

_ARMS = tuple(name for name in device_names() if device_of(name).model.kind == "arm")
_ROWS = ("pause", "resume", "lost link", "reconnect", "hold of a claim", "jog")
_CELLS = {"ur5e_pick": "arm", "fr3_hand": "arm", "gen3_2f": "arm", "openarm_bimanual": "left"}
_MOMENTS = {
    "pause": "program_pause",
    "resume": "program_resume",
    "lost link": "link_lost",
    "reconnect": "reconnect",
    "hold of a claim": "claim",
}


def _rows(name: str) -> Mapping[str, tuple[object, ...]]:
    return {str(row[0]): tuple(row) for row in behavior(device_of(name).model)}


@pytest.mark.parametrize("name", _ARMS)
def test_each_arm_has_one_table_with_every_row_and_its_sources(name: str) -> None:
    rows = _rows(name)
    assert set(_ROWS) <= set(rows)
    assert any(row.startswith("law of ") for row in rows)
    stops = {state.name for state in there(device_of(name).model.safety).states if state.stops}
    assert stops
    assert stops <= set(rows)
    assert [row for row in rows.values() if not row[-1] and "pass through no program" not in str(row[-2])] == []
    assert page(device_of(name)).count("## What the real robot does") == 1


@pytest.mark.parametrize("cell", _CELLS)
def test_the_table_is_what_the_mock_plays(cell: str) -> None:
    device = json.loads(built(cell).texts["contract.json"])["devices"][_CELLS[cell]]
    rows = _rows(device["model"])
    for name, stop in device["stops"].items():
        assert rows[name][1:3] == (stop.get("motion", "none"), stop["leaves"])
        assert str(rows[name][4]).endswith(f"ends by {stop['left_by']}")
    for name, moment in _MOMENTS.items():
        effect = device["effects"].get(moment)
        if effect is not None:
            assert rows[name][1:3] == (effect.get("motion", "none"), effect.get("leaves") or "")
