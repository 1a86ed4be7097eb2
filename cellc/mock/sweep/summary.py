"""A sweep for people and as JSON: rate, verdict, outcomes, margins, what was drawn, and what explains failures."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict

import numpy as np

from cellc.contract.uncertainty import UncertainQuantity, Uncertainty
from cellc.diagnostics.unsafe_text import harmless_json
from cellc.mock.sweep.draws import draw
from cellc.mock.sweep.figures import METHOD_INTERVAL, METHOD_SENSITIVITY, Array, Explanation, explain
from cellc.mock.sweep.sweep import Sweep, SweepRun

_SHOWN = 5
_QUANTILES = (0.05, 0.5, 0.95, 1.0)
_SHOWN_UNITS: Mapping[str, tuple[str, float]] = {"m": ("mm", 1e3), "rad": ("deg", 180.0 / np.pi), "s": ("ms", 1e3)}


def drawn_of(sweep: Sweep, uncertainty: Uncertainty) -> dict[str, Array]:
    """Return what was drawn, by quantity, in the order of the runs."""
    values = [draw(uncertainty.quantities, sweep.seed, run.number) for run in sweep.runs]
    return {one.name: np.array([each[one.name] for each in values]) for one in uncertainty.quantities}


def explanations(sweep: Sweep, uncertainty: Uncertainty) -> tuple[Explanation, ...]:
    """Return what explains the failures, the most first."""
    failed = np.array([not run.passed for run in sweep.runs], dtype=np.bool_)
    return explain(uncertainty.quantities, drawn_of(sweep, uncertainty), failed)


def margins(sweep: Sweep, uncertainty: Uncertainty) -> Iterator[tuple[str, str, Sequence[float], float | None]]:
    """Yield name and unit of each margin, its quantiles 5 %, 50 %, 95 % and 100 %, and what is allowed."""
    goals = sorted({goal for run in sweep.runs for goal in run.distances_m})
    for goal in goals:
        found = [run.distances_m[goal] for run in sweep.runs if goal in run.distances_m]
        yield f"distance at {goal}", "m", _quantiles(found), uncertainty.tolerances.get(goal)
    ages = [run.oldest_s for run in sweep.runs if run.oldest_s is not None]
    if ages:
        yield "age of transforms", "s", _quantiles(ages), None


def _quantiles(values: Sequence[float]) -> list[float]:
    return [float(value) for value in np.quantile(values, _QUANTILES, method="inverted_cdf")]


def sweep_lines(sweep: Sweep, uncertainty: Uncertainty, replay: Callable[[int], str]) -> Iterator[str]:
    """Yield the summary for people."""
    runs, failed = len(sweep.runs), len(sweep.failed)
    yield f"{sweep.rehearsal}: {runs} runs with seed {sweep.seed}, {runs - failed} succeeded"
    rate = sweep.rate
    yield (
        f"success: {(runs - failed) / runs:.2%}, between {rate.low:.2%} and {rate.high:.2%} "
        f"with {rate.confidence:.4g} ({METHOD_INTERVAL})"
    )
    counted = Counter(run.outcome for run in sweep.runs)
    yield "outcomes: " + ", ".join(f"{name} {number}" for name, number in counted.most_common())
    yield from _margin_lines(sweep, uncertainty)
    yield from _drawn_lines(uncertainty.quantities)
    yield from _explained_lines(explanations(sweep, uncertainty), failed)
    for run in sweep.failed[:_SHOWN]:
        yield f"FAILED  sweep:{run.number}: {run.outcome}"
        yield f"        replay: {replay(run.number)}"
    if failed > _SHOWN:
        yield f"        and {failed - _SHOWN} more; --json names all"
    yield verdict_line(sweep)


def verdict_line(sweep: Sweep) -> str:
    """Return the line that says whether enough runs succeed."""
    expected, runs = sweep.expected, len(sweep.runs)
    if expected is None:
        return f"no verdict: the cell expects no rate of success of `{sweep.rehearsal}`"
    wanted = f"{expected.success:.4%} of the runs must succeed, with confidence {expected.confidence:.4g}"
    if sweep.verdict is None:
        return f"UNKNOWN: {wanted}; {runs} runs do not decide it"
    after = f"certain after {runs} of {sweep.asked} runs" if runs < sweep.asked else f"certain after {runs} runs"
    return f"{'passed' if sweep.verdict else 'FAILED'}: {wanted}; {after}"


def _margin_lines(sweep: Sweep, uncertainty: Uncertainty) -> Iterator[str]:
    rows: list[tuple[str, ...]] = [("margins", "5 %", "median", "95 %", "most", "allowed")]
    for name, unit, quantiles, allowed in margins(sweep, uncertainty):
        limit = "not stated" if allowed is None else _shown(allowed, unit)
        rows.append((name, *(_shown(value, unit) for value in quantiles), limit))
    yield from _table(rows)


def _drawn_lines(quantities: Sequence[UncertainQuantity]) -> Iterator[str]:
    rows = [("drawn", "distribution", "by")]
    for one in quantities:
        within = "deviation" if one.distribution == "normal" else "within"
        rows.append((one.name, f"{one.distribution}, {within} {_shown(one.spread, one.unit)}", one.source))
    yield from _table(rows)


def _explained_lines(found: Sequence[Explanation], failed: int) -> Iterator[str]:
    causes = [one for one in found if one.explains]
    if not failed:
        return
    if not causes:
        yield f"nothing that is drawn explains the failures ({METHOD_SENSITIVITY})"
        return
    rows = [("explains failures", "distance", "by chance", "if half as uncertain")]
    for one in causes:
        half = "not known" if one.halved is None else f"{one.halved:.2%} fail"
        rows.append((one.name, f"{one.statistic:.2f}", f"{one.critical:.2f}", half))
    yield from _table(rows)


def _table(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(len(row[place]) for row in rows) for place in range(len(rows[0]))]
    for row in rows if len(rows) > 1 else ():
        yield "  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip()


def _shown(value: float, unit: str) -> str:
    shown, factor = _SHOWN_UNITS[unit]
    return f"{value * factor:.3g} {shown}"


def run_lines(run: SweepRun, uncertainty: Uncertainty, seed: int) -> Iterator[str]:
    """Yield how one run ended that was run alone, and what it drew."""
    yield f"{'passed' if run.passed else 'FAILED'}  sweep:{run.number}: {run.outcome}"
    for goal, distance in run.distances_m.items():
        limit = uncertainty.tolerances.get(goal)
        allowed = "" if limit is None else f", {_shown(limit, 'm')} allowed"
        yield f"        distance at {goal}: {_shown(distance, 'm')}{allowed}"
    values = draw(uncertainty.quantities, seed, run.number)
    for one in uncertainty.quantities:
        yield f"        {one.name}: {_shown(values[one.name], one.unit)}"
    yield f"        digest: {run.digest}"


def sweep_json(configuration_id: str, sweeps: Sequence[Sweep], uncertainty: Uncertainty, notes: Sequence[str]) -> str:
    """Return sweeps as JSON: rate, margins, draws, explanations, and every run with its digest."""
    content = {
        "configuration_id": configuration_id,
        "quantities": [one.model_dump() for one in uncertainty.quantities],
        "sweeps": [_sweep(each, uncertainty) for each in sweeps],
        "notes": list(notes),
    }
    return harmless_json(json.dumps(content, ensure_ascii=False, indent=2))


def _sweep(sweep: Sweep, uncertainty: Uncertainty) -> dict[str, object]:
    return {
        "rehearsal": sweep.rehearsal,
        "seed": sweep.seed,
        "asked": sweep.asked,
        "runs": [asdict(run) for run in sweep.runs],
        "rate": {"method": METHOD_INTERVAL, **asdict(sweep.rate)},
        "expected": None if sweep.expected is None else sweep.expected.model_dump(),
        "verdict": sweep.verdict,
        "margins": [
            {
                "name": name,
                "unit": unit,
                "quantiles": dict(zip(map(str, _QUANTILES), values, strict=True)),
                "allowed": most,
            }
            for name, unit, values, most in margins(sweep, uncertainty)
        ],
        "explanations": {
            "method": METHOD_SENSITIVITY,
            "found": [{**asdict(one), "explains": one.explains} for one in explanations(sweep, uncertainty)],
        },
    }
