"""Inequalities of time along what follows from each other: a table of rows, which a test compares with all keys.

A row says which of two times must not be below, or above, the other. What is slow for what waits for it, or fast for
what feeds it, works on a desk and fails in the cell.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import inf

from cellc.compiler.cell.cell import Cell
from cellc.compiler.graph import rates, waits
from cellc.compiler.graph.time_pairs import Pair, shown
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, YamlPath, found, rules
from cellc.contract.frozen import dataclass

_ROUNDING = {"Hz": 1.001, "s": 1.0 + 1e-6}
"""Rates are rounded as people write them, times are not."""


@dataclass(frozen=True, slots=True)
class Inequality:
    """A row: a bound from below (``least``) or from above, in s or Hz, and the pairs to which it applies."""

    pairs: Callable[[Cell], Iterator[Pair]]
    least: bool
    unit: str = "s"


def _least(*pairs: Callable[[Cell], Iterator[Pair]]) -> tuple[Inequality, ...]:
    return tuple(Inequality(row, least=True) for row in pairs)


def _most(*pairs: Callable[[Cell], Iterator[Pair]], unit: str = "s") -> tuple[Inequality, ...]:
    return tuple(Inequality(row, least=False, unit=unit) for row in pairs)


ERRORS: Mapping[str, tuple[Inequality, ...]] = {
    "exposure-beyond-period": _most(rates.exposures),
    "max-age-beyond-timeout": _most(rates.ages_of_goals),
    "wait-below-way": _least(waits.waits_for_sensors),
    "watchdog-below-period": (
        *_least(waits.adapters, waits.servo_commands, rates.silences, rates.leases),
        *_most(waits.servo_timeouts, waits.managers),
    ),
}
WARNINGS: Mapping[str, tuple[Inequality, ...]] = {
    "cancel-bound-not-kept": (*_most(waits.monitors), *_least(waits.stops, waits.inner_cancels)),
    "faster-than-its-source": _most(rates.seen_rates, rates.map_rates, unit="Hz"),
    "faster-than-the-device": _most(rates.published_rates, rates.own_rates, unit="Hz"),
    "period-below-cycle": _least(waits.servo_periods),
    "timeout-below-inner": (
        *_least(waits.inner_timeouts, waits.goal_times, waits.own_goal_times, waits.rehearsed),
        *_most(waits.solvers),
    ),
    "transform-slower-than-its-poses": (Inequality(rates.transform_rates, least=True, unit="Hz"),),
}
"""Code → its rows. `deadline-below-period` and others whose messages show more than two times are rules beside it."""


def _broken(graph: CellGraph, code: str) -> Findings:
    """Yield the pairs of the rows of a code that break them, the worst one of a place."""
    for row in ERRORS[code] if code in ERRORS else WARNINGS[code]:
        worst: dict[YamlPath, tuple[float, Pair]] = {}
        for pair in row.pairs(graph.cell):
            less, more = (pair.value, pair.bound) if row.least else (pair.bound, pair.value)
            ratio = more / less if less else inf if more else 1.0
            if ratio > max(_ROUNDING[row.unit], worst.get(pair.path, (0.0, pair))[0]):
                worst[pair.path] = (ratio, pair)
        for path, (_, pair) in worst.items():
            yield found(graph, path, *_said(graph, row, pair))


def _said(graph: CellGraph, row: Inequality, pair: Pair) -> tuple[str, str, tuple[Related, ...]]:
    bound, value = (f"{figure:g} Hz" if row.unit == "Hz" else shown(figure) for figure in (pair.bound, pair.value))
    message = f"{pair.subject} must be at {'least' if row.least else 'most'} {bound}, {pair.because}, got {value}"
    return message, "", tuple(Related(text, graph.cell.locate(*place)) for text, place in pair.places)


ROWS = (
    *rules(Severity.ERROR, _broken, {code: code for code in ERRORS}),
    *rules(Severity.WARNING, _broken, {code: code for code in WARNINGS}),
)
