"""Layered drawings: boxes stand apart, lines end at their boxes, and none runs through a box."""

from __future__ import annotations

import random
from itertools import combinations, pairwise

import pytest

from cellc.compiler.formats.layered import PORT, Box, Columns, Layout, Line, layout

_COLUMNS = Columns(tuple(200.0 * number for number in range(5)), 120.0)


def _drawn(boxes: list[Box], lines: list[Line]) -> Layout:
    found = layout(boxes, lines, _COLUMNS)
    layers = {box.key: box.layer for box in boxes}
    for one, other in combinations(found.boxes, 2):
        if layers[one] == layers[other]:
            (y, high), (y2, high2) = found.boxes[one], found.boxes[other]
            assert abs(y - y2) >= (high + high2) / 2, (one, other)
    for line, route in zip(lines, found.routes, strict=True):
        for end, (x, y) in ((line.start, route[0]), (line.end, route[-1])):
            left = _COLUMNS.lefts[layers[end]]
            center, high = found.boxes[end]
            assert x in (left, left + _COLUMNS.width)
            assert abs(y - center) <= high / 2
        onward = [x for x, _ in route]
        assert onward == sorted(onward, reverse=layers[line.end] < layers[line.start])
        # Between the first and the last point, each second piece is the level one across a layer.
        for (x, y), (x2, y2) in zip(route[1:-1:2], route[2:-1:2], strict=True):
            assert (y, abs(x2 - x)) == (y2, _COLUMNS.width)
            crossed = [key for key in layers if _COLUMNS.lefts[layers[key]] == min(x, x2)]
            assert all(abs(y - found.boxes[key][0]) > found.boxes[key][1] / 2 for key in crossed)
    assert all(y - high / 2 >= -1e-6 and y + high / 2 <= found.height + 1e-6 for y, high in found.boxes.values())
    return found


def test_twenty_arms_of_one_task_stand_in_the_order_of_their_controllers() -> None:
    arms = [f"arm_{number:02d}" for number in range(20)]
    boxes = [Box("task", 0, 26.0), *(Box(f"to_{arm}", 1, 26.0) for arm in arms), *(Box(arm, 2, 26.0) for arm in arms)]
    lines = [Line("task", f"to_{arm}", arm) for arm in arms] + [Line(f"to_{arm}", arm, "claims") for arm in arms]
    found = _drawn(boxes, lines)
    assert sorted(arms, key=lambda arm: found.boxes[arm][0]) == arms
    # Twenty goals leave one box, each at a place of its own.
    starts = sorted(route[0][1] for line, route in zip(lines, found.routes, strict=True) if line.start == "task")
    assert all(b - a == pytest.approx(PORT) for a, b in pairwise(starts))


@pytest.mark.parametrize("seed", range(6))
def test_no_line_of_any_graph_runs_through_a_box(seed: int) -> None:
    draw = random.Random(seed)
    boxes = [Box(f"n{number}", draw.randrange(5), draw.choice((26.0, 43.0))) for number in range(24)]
    pairs = [draw.sample(boxes, 2) for _ in range(40)]
    lines = [Line(one.key, other.key, str(number // 2)) for number, (one, other) in enumerate(pairs)]
    assert layout(boxes, lines, _COLUMNS) == _drawn(boxes, lines)


def test_lines_of_one_group_share_their_start_and_boxes_without_lines_stand_below() -> None:
    boxes = [Box("a", 0, 26.0), Box("alone", 1, 26.0), Box("b", 1, 26.0), Box("c", 1, 26.0)]
    found = _drawn(boxes, [Line("a", "b", "1"), Line("a", "c", "1")])
    assert found.routes[0][0] == found.routes[1][0]
    assert found.boxes["alone"][0] > max(found.boxes["b"][0], found.boxes["c"][0])
