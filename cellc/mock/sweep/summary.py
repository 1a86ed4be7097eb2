"""A sweep for people and as JSON: rate, verdict, outcomes, margins, what was drawn, and what explains failures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import partial

import numpy as np

from cellc.contract.contract import Contract
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.diagnostics.wording import aligned, percent
from cellc.contract.uncertainty import WHOLE, Uncertainty
from cellc.mock.sweep.draws import draw, draw_all
from cellc.mock.sweep.figures import METHOD_INTERVAL, METHOD_SENSITIVITY, Explanation, explain
from cellc.mock.sweep.margins import Margin, margins
from cellc.mock.sweep.runs import SweepRun
from cellc.mock.sweep.sweep import Sweep

_SHOWN = 5
_WORDS = {
    "normal": "normal, deviation",
    "isotropic": "normal, deviation in space",
    "uniform": "uniform, within",
}
_QUANTILES = (0.05, 0.5, 0.95, 1.0)
_SHOWN_UNITS: Mapping[str, tuple[str, float]] = {
    "m": ("mm", 1e3),
    "rad": ("deg", 180.0 / np.pi),
    "s": ("ms", 1e3),
    "kg": ("g", 1e3),
    "1": ("%", 100.0),
    "": ("", 1.0),
}


def explanations(sweep: Sweep) -> tuple[Explanation, ...]:
    """Return what explains the failures, the most first."""
    drawn = partial(draw_all, seed=sweep.seed, numbers=sweep.runs.numbers)
    return explain(sweep.uncertainty.quantities, drawn, ~sweep.runs.passed)


def sweep_lines(sweep: Sweep, contract: Contract, replay: Callable[[int], str]) -> Iterator[str]:
    """Yield the summary for people."""
    found = explanations(sweep)
    yield from count_lines(sweep)
    yield from unexplained(sweep, found)
    for table in (margin_table(margins(sweep, contract)), drawn_table(sweep), explained_table(found)):
        yield from aligned(table)
    for run in sweep.failed[:_SHOWN]:
        yield f"FAILED  sweep:{run.number}: {run.outcome}"
        yield f"        replay: {replay(run.number)}"
    if len(sweep.failed) > _SHOWN:
        yield f"        and {len(sweep.failed) - _SHOWN} more; --json names all"
    yield verdict_line(sweep)


def count_lines(sweep: Sweep) -> Iterator[str]:
    """Yield how many runs there were, how many succeeded, and how they ended."""
    runs, succeeded, rate = len(sweep.runs), len(sweep.runs) - len(sweep.failed), sweep.rate
    yield f"{sweep.rehearsal}: {runs} runs with seed {sweep.seed}, {succeeded} succeeded"
    yield (
        f"success: {percent(succeeded / runs)}, between {percent(rate.low)} and {percent(rate.high)} "
        f"with confidence {rate.confidence:.4g} ({METHOD_INTERVAL})"
    )
    counted = sweep.runs.outcomes().most_common()
    yield "outcomes: " + ", ".join(f"{name} {number}" for name, number in counted)


def unexplained(sweep: Sweep, found: Sequence[Explanation]) -> Iterator[str]:
    """Yield why nothing explains the failures, where there are some and nothing does."""
    if sweep.failed and not any(explanation.explains for explanation in found):
        yield f"{_unexplained(sweep)} ({METHOD_SENSITIVITY})"


def _unexplained(sweep: Sweep) -> str:
    """Say why nothing explains the failures, and what would."""
    if not sweep.uncertainty.quantities:
        return "no quantity is drawn that could explain the failures"
    if len(sweep.failed) == len(sweep.runs):
        return "every run failed, so no successful run is left for a comparison"
    nothing = "no drawn quantity explains the failures"
    if len(sweep.runs) < sweep.asked:
        return f"{nothing}; the verdict ended the sweep early; without `success` it makes all {sweep.asked} runs"
    return f"{nothing}; more runs may show more"


Table = Sequence[tuple[str, ...]]
"""Rows of texts, of which the first names the columns; empty where there is nothing to tell."""


def verdict_line(sweep: Sweep) -> str:
    """Return the line that says whether enough runs succeed."""
    expected, runs = sweep.expected, len(sweep.runs)
    if expected is None:
        return f"no verdict: the cell states no expected success rate for `{sweep.rehearsal}`"
    wanted = f"{percent(expected.success)} of the runs must succeed, with confidence {expected.confidence:.4g}"
    if sweep.verdict is None:
        return f"UNKNOWN: {wanted}; {runs} runs do not decide it"
    after = f"certain after {runs} of {sweep.asked} runs" if runs < sweep.asked else f"certain after {runs} runs"
    return f"{'passed' if sweep.verdict else 'FAILED'}: {wanted}; {after}"


def margin_table(found: Iterable[Margin]) -> Table:
    """Return a row for each margin; a share of the runs is as good as its figure, or better."""
    rows = [
        (margin.name, *(_shown(margin.quantile(share), margin.unit) for share in _QUANTILES), _bound(margin))
        for margin in found
    ]
    return [("margins", "best 5 %", "median", "95 %", "worst", "bound"), *rows] if rows else ()


def _bound(margin: Margin) -> str:
    if margin.bound is None:
        return "none stated"
    return f"at {'least' if margin.falling else 'most'} {_shown(margin.bound, margin.unit)}"


def drawn_table(sweep: Sweep) -> Table:
    """Return what is drawn; axes of one thing that are drawn alike share a row."""
    alike: dict[tuple[str, str, str], list[str]] = {}
    for quantity in sweep.uncertainty.quantities:
        thing, _, axis = quantity.name.rpartition(" ")
        thing, axis = (quantity.name, "") if quantity.axis in WHOLE else (thing, axis)
        drawn = f"{_WORDS[quantity.distribution]} {_shown(quantity.spread, quantity.unit)}"
        alike.setdefault((thing, drawn, quantity.source), []).append(axis)
    rows = [(f"{thing} {', '.join(axes)}".strip(), drawn, source) for (thing, drawn, source), axes in alike.items()]
    return [("drawn", "distribution", "by"), *rows] if rows else ()


def explained_table(found: Sequence[Explanation]) -> Table:
    """Return what explains the failures, the most first."""
    rows = []
    for explanation in found:
        if explanation.explains:
            half = "not known" if explanation.halved is None else f"{percent(explanation.halved)} fail"
            rows.append((explanation.name, f"{explanation.statistic:.2f}", f"{explanation.critical:.2f}", half))
    return [("explains failures", "distance", "by chance", "if half as uncertain"), *rows] if rows else ()


def _shown(value: float, unit: str) -> str:
    shown, factor = _SHOWN_UNITS[unit]
    return f"{float(f'{value * factor:.3g}'):.10g} {shown}".rstrip()  # three digits, and no power of ten


def run_lines(run: SweepRun, uncertainty: Uncertainty, seed: int) -> Iterator[str]:
    """Yield how one run ended that was run alone, and what it drew."""
    yield f"{'passed' if run.passed else 'FAILED'}  sweep:{run.number}: {run.outcome}"
    for goal, room in run.goals.items():
        limit = uncertainty.tolerances.get(goal)
        allowed = "" if limit is None else f", {_shown(limit, 'm')} allowed"
        yield f"        distance at {goal}: {_shown(room.distance_m, 'm')}{allowed}"
    values = draw(uncertainty.quantities, seed, run.number)
    for quantity in uncertainty.quantities:
        yield f"        {quantity.name}: {_shown(values[quantity.name], quantity.unit)}"
    yield f"        digest: {run.digest}"


def sweep_json(contract: Contract, sweeps: Sequence[Sweep], notes: Sequence[str]) -> str:
    """Return sweeps of a cell as JSON: rate, margins, draws, explanations, and every run with its digest."""
    content = {
        "configuration_id": contract.configuration_id,
        "sweeps": [_sweep(each, contract) for each in sweeps],
        "notes": list(notes),
    }
    return json_document(content)


def _sweep(sweep: Sweep, contract: Contract) -> dict[str, object]:
    return {
        "rehearsal": sweep.rehearsal,
        "seed": sweep.seed,
        "asked": sweep.asked,
        "quantities": [quantity.model_dump() for quantity in sweep.uncertainty.quantities],
        "runs": [asdict(run) for run in sweep.runs],
        "rate": {"method": METHOD_INTERVAL, **asdict(sweep.rate)},
        "expected": None if sweep.expected is None else sweep.expected.model_dump(),
        "verdict": sweep.verdict,
        "margins": [
            {
                "name": margin.name,
                "unit": margin.unit,
                "quantiles": {str(share): margin.quantile(share) for share in _QUANTILES},
                "least" if margin.falling else "most": margin.bound,
            }
            for margin in margins(sweep, contract)
        ],
        "explanations": {
            "method": METHOD_SENSITIVITY,
            "found": [{**asdict(explanation), "explains": explanation.explains} for explanation in explanations(sweep)],
        },
    }
