"""A mesh of the scene is read in its unit; one that is a crumb or a hall then was drawn in another."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rules.examples import Example, diagnose_example

# One triangle that reaches 120 of its units from its origin.
_STL = """solid jig
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 120 0 0
vertex 0 80 0
endloop
endfacet
endsolid jig
"""
_SCENE = "scene:\n  jig: {{parent: world, xyz: 0 6 0 m, mesh: {{file: 'package://jigs/jig.stl'{unit}}}}}\n"


@pytest.mark.parametrize(
    ("unit", "said"),
    [
        (", unit: 1 mm", ""),
        ("", "from 5 mm to 20000 mm, from a small part to a room, in its `unit`"),
        (", unit: 1 m", "got 120000 mm"),
    ],
)
def test_a_mesh_is_as_large_as_its_unit_makes_it(unit: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "jigs").mkdir()
    (tmp_path / "jigs" / "jig.stl").write_text(_STL, encoding="utf-8")
    diagnosed = diagnose_example(Example("yaml", _SCENE.format(unit=unit)), tmp_path)
    found = [item for item in diagnosed if item.code == "implausible-size"]
    assert [said in item.message for item in found] == ([True] if said else [])
    assert [item.code for item in diagnosed if item.code.startswith("mesh")] == []
