"""A sweep: how often a rehearsal succeeded, its margins, what was drawn, and what explains the failures."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.contract.contract import Contract
from cellc.mock.report_page.axes import Scale, line
from cellc.mock.report_page.html import Child, cards, hint, section, svg, tag
from cellc.mock.sweep.margins import Margin, margins
from cellc.mock.sweep.summary import (
    count_lines,
    drawn_table,
    explained_table,
    explanations,
    margin_table,
    unexplained,
    verdict_line,
)
from cellc.mock.sweep.sweep import Sweep

_WIDTH, _HEIGHT = 200.0, 22.0
_BARS = 50


def sweep_section(sweep: Sweep, contract: Contract) -> Element:
    """Return the section of one sweep."""
    found = explanations(sweep)
    tables = [cards(head, rest) for head, *rest in filter(None, (drawn_table(sweep), explained_table(found)))]
    if ranked := tuple(margins(sweep, contract)):
        names, *rows = margin_table(ranked)
        drawn: list[tuple[Child, ...]] = [(*row, histogram(margin)) for row, margin in zip(rows, ranked, strict=True)]
        tables.insert(0, cards((*names, "best to worst"), drawn))
    legend = (
        "95 % of the runs are as good as the figure below it, or better. A drawing ends at the bound, or at a run "
        "beyond it. Clearance is what the planner knows: from an arm and what it carries to its surroundings, where "
        "the description has that. How a part slips or turns between the fingers is not simulated. The section of a "
        "run that missed its goal shows what the robot believed: that it succeeded."
    )
    lines = [tag("p", text) for text in (*count_lines(sweep), *unexplained(sweep, found))]
    return section(f"Sweep of {sweep.rehearsal}", *lines, *tables, hint(legend))


def sweep_verdict(sweep: Sweep) -> Element:
    """Return the line that says whether enough runs succeed."""
    class_ = {None: "unknown", True: "good", False: "bad"}[sweep.verdict]
    return tag("p", tag("span", verdict_line(sweep), class_=class_))


def histogram(margin: Margin) -> Element:
    """Return how many runs were how near to the bound: the best on the left, the bound on the right."""
    ends = (float(margin.values[0]), float(margin.values[-1]))
    shown = (*ends, *(() if margin.bound is None else (margin.bound,)), *(() if margin.falling else (0.0,)))
    start, end = (max(shown), min(shown)) if margin.falling else (min(shown), max(shown))
    x = Scale(start, end if end != start else start + 1.0, 0.0, _WIDTH)
    drawing = svg(_WIDTH, _HEIGHT, f"{margin.name}, from the best run to the worst", *_drawn(margin, x))
    return tag("td", drawing, class_="spread")


def _drawn(margin: Margin, x: Scale) -> Iterator[Element]:
    width = _WIDTH / _BARS
    counted = Counter(min(_BARS - 1, int(x.place(float(value)) / width)) for value in margin.values)
    most = max(counted.values())
    bound_at = _WIDTH if margin.bound is None else x.place(margin.bound)
    yield line("axis", 0.0, _HEIGHT, _WIDTH, _HEIGHT)
    for place, runs in sorted(counted.items()):
        height = max(1.0, (_HEIGHT - 2.0) * runs / most)
        box = {
            "x": f"{place * width:g}",
            "y": f"{_HEIGHT - height:.4g}",
            "width": f"{width:g}",
            "height": f"{height:.4g}",
        }
        yield tag("rect", class_="runs" if place * width < bound_at else "runs beyond", **box)
    if margin.bound is not None:
        shown_at = min(_WIDTH - 1.0, bound_at)
        yield line("limit", shown_at, 0.0, shown_at, _HEIGHT)
