"""Figures against bounds: what follows from a stated value, and what it can be at all in this cell.

A family keeps its bounds in a table ``BOUNDS`` beside the rule that reports them. The tables are the one place where a
value is held to be too small or too large to be meant; ``tests/rules/test_quantities.py`` walks the schema of the spec
and fails for a key with a number that neither a table, nor a rule, nor the list of free keys knows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator

from cellc.compiler.rules.kit import CellGraph, Finding, Findings, Related, YamlPath, found
from cellc.contract.diagnostics import Span
from cellc.contract.frozen import dataclass

_UNITS = {
    "mm": 1e-3,
    "ms": 1e-3,
    "us": 1e-6,
    "deg": math.pi / 180.0,
    "%": 1e-2,
    "ppm": 1e-6,
    "mm/s": 1e-3,
    "g m^2": 1e-3,
    "g": 1e-3,
}
"""Units in which figures are shown, with their size in SI; others are SI themselves."""


@dataclass(frozen=True, slots=True)
class Figure:
    """What follows from a stated value, in SI, and what it can be in this cell.

    Args:
        path: the value that is to be corrected.
        because: where the bounds come from; that of its row where it is empty.
        unit: in which it is shown; that of its row where it is empty.
        span: the place in a description; None of a value of the spec.
        related: further stated values that the figure or its bounds follow from.
    """

    path: YamlPath
    value: float
    least: float = -math.inf
    most: float = math.inf
    because: str = ""
    unit: str = ""
    span: Span | None = None
    related: tuple[Related, ...] = ()


Figures = Callable[[CellGraph], Iterator[Figure]]
Owners = Callable[[CellGraph], Iterable[tuple[YamlPath, object]]]


@dataclass(frozen=True, slots=True)
class Bound:
    """A row: a quantity of the spec, the figure that follows from it, and its bounds.

    Args:
        keys: places in the schema, ``*`` for a name or a number.
        what: the figure, as the subject of a message.
        unit: in which the figure is shown; empty for a count.
        because: where the bounds come from.
    """

    keys: tuple[str, ...]
    what: str
    unit: str
    because: str
    figures: Figures


def stated(
    keys: str | tuple[str, ...], owners: Owners, field: str, least: float, most: float, unit: str, because: str
) -> Bound:
    """Return the row of a value that is its own figure: a field of what ``owners`` yields with its place.

    Of a tuple every value is compared, and what is None is not stated.
    """
    places = (keys,) if isinstance(keys, str) else keys
    key = places[0].rpartition(".")[2]

    def figures(graph: CellGraph) -> Iterator[Figure]:
        for path, owner in owners(graph):
            value: float | tuple[float, ...] | None = getattr(owner, field)
            for number in value if isinstance(value, tuple) else (value,):
                if number is not None and not least <= number <= most:
                    yield Figure((*path, key), number, least, most)
                    break

    return Bound(places, f"`{key}`", unit, because, figures)


def outside(graph: CellGraph, bounds: tuple[Bound, ...]) -> Findings:
    """Yield each figure that is outside of its bounds and follows from what the user wrote, one for a value."""
    reported = set[tuple[YamlPath, Span | None]]()
    for bound in bounds:
        for figure in bound.figures(graph):
            if not figure.least <= figure.value <= figure.most and (figure.path, figure.span) not in reported:
                reported.add((figure.path, figure.span))
                if figure.span is not None or graph.cell.states(*figure.path):
                    yield _finding(graph, bound, figure)


def _finding(graph: CellGraph, bound: Bound, figure: Figure) -> Finding:
    unit = figure.unit or bound.unit
    got, text = shown(figure.value, unit), graph.cell.text(*figure.path)
    written = f" from `{text}`" if text and text != got and figure.span is None else ""
    message = f"{bound.what} must be {_span(figure, unit)}, {figure.because or bound.because}, got {got}{written}"
    if figure.span is not None:
        return Finding(message, figure.span, figure.path, related=figure.related)
    return found(graph, figure.path, message, related=figure.related)


def _span(figure: Figure, unit: str) -> str:
    if math.isinf(figure.most):
        return f"at least {shown(figure.least, unit)}"
    if math.isinf(figure.least):
        return f"at most {shown(figure.most, unit)}"
    return f"from {shown(figure.least, unit)} to {shown(figure.most, unit)}"


def shown(value: float, unit: str) -> str:
    """Write a figure in its unit, three digits where it has a fraction."""
    number = value / _UNITS.get(unit, 1.0)
    text = f"{number:.0f}" if abs(number) >= 1000.0 else f"{number:.3g}"
    return f"{text} {unit}".rstrip()
