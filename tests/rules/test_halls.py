"""A hall is no mistake in a unit, and a mistake in a unit is one in a hall too."""

from __future__ import annotations

from pathlib import Path

import pytest

from cellc.compiler.graph.neighbors import Neighbors
from cellc.compiler.pipeline import check
from tests.rules.halls import stations


@pytest.mark.parametrize(
    ("places", "alone"),
    [
        (["0 0 0 m", "20 0 0 m", "40 0 0 m", "59 0 0 m", "59 19 0 m"], []),
        (["0 0 0 m", "15 0 0 m", "36 0 0 m"], ["s2"]),  # 21 m from the next
        (["15 0 0 m", "30 0 0 m", "400 100 850 m"], ["s2"]),
        (["400 100 850 m", "410 100 850 m"], ["s0", "s1"]),  # neighbors of each other, and of nothing else
        (["25 0 0 m"], ["s0"]),
        (["-12 -12 0 m", "-24 -24 0 m", "-45 -24 0 m"], ["s2"]),
    ],
)
def test_a_row_of_stations_is_a_hall(places: list[str], alone: list[str], tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(stations(places), encoding="utf-8")
    found = [each.yaml_path[1] for each in check(file) if each.code == "implausible-distance"]
    assert found == alone


@pytest.mark.parametrize(("distance_m", "names"), [(0.9, "a"), (1.0, "ab"), (3.0, "abc"), (50.0, "abcd")])
def test_neighbors_are_those_within_a_distance(distance_m: float, names: str) -> None:
    things = [((0.0, 0.0, 0.0), "a"), ((-1.0, 0.0, 0.0), "b"), ((0.0, 0.0, 3.0), "c"), ((40.0, 0.0, 0.0), "d")]
    neighbors = Neighbors(things, 1.0)
    assert sorted(name for _, name in neighbors.within(distance_m, of=(0.0, 0.0, 0.0))) == list(names)
    assert sorted(name for _, name in neighbors.take(distance_m, of=(0.0, 0.0, 0.0))) == list(names)
    assert [name for _, name in neighbors.within(100.0, of=(0.0, 0.0, 0.0)) if name in names] == []
