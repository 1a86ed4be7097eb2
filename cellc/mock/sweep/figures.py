"""What the ends of runs say: a rate with its interval, whether a verdict is certain, and what explains the failures.

The interval is that of Clopper and Pearson (Biometrika 26, 1934): exact, so that it covers the true rate at least as
often as it says. A verdict is looked for after 100, 200, 400, … runs, and every look costs confidence: look number k
gets the share 1/(k (k+1)) of what may be wrong, and all shares together are at most 1 (Bonferroni), so that looking
often keeps the level.

What explains failures is found by Monte Carlo filtering, or regionalized sensitivity analysis (Spear and Hornberger,
Water Research 14, 1980): the values of a quantity in failed runs are compared with those in others by the two-sample
statistic of Kolmogorov and Smirnov. It asks no model of how a quantity acts. What is below the critical value for all
comparisons together explains nothing that chance would not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from cellc.contract.frozen import dataclass
from cellc.contract.uncertainty import UncertainQuantity
from cellc.mock.sweep.draws import scale

FIRST_LOOK = 100
METHOD_INTERVAL = "Clopper-Pearson"
METHOD_SENSITIVITY = "Monte Carlo filtering, Kolmogorov-Smirnov"
_CHANCE = 0.05
_STEPS = 60
_TOGETHER = 1 << 16

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class Interval:
    """Where a probability lies, with a confidence."""

    low: float
    high: float
    confidence: float


def interval(successes: int, runs: int, confidence: float) -> Interval:
    """Return the interval of Clopper and Pearson for the probability of a success."""
    if runs == 0:
        return Interval(0.0, 1.0, confidence)
    tail = (1.0 - confidence) / 2.0
    failures = runs - successes
    low = 0.0 if successes == 0 else 1.0 - _root(lambda p: _at_most(failures, runs, p) - tail)
    high = 1.0 if failures == 0 else _root(lambda p: _at_most(successes, runs, p) - tail)
    return Interval(low, high, confidence)


def _root(falling: Callable[[float], float]) -> float:
    low, high = 0.0, 1.0
    for _ in range(_STEPS):
        middle = (low + high) / 2.0
        low, high = (middle, high) if falling(middle) > 0.0 else (low, middle)
    return (low + high) / 2.0


def _at_most(count: int, runs: int, probability: float) -> float:
    """Return the probability of at most so many of independent events, each of this probability."""
    if probability <= 0.0 or count >= runs:
        return 1.0
    if probability >= 1.0:
        return 0.0
    if 2 * count > runs:
        return 1.0 - _at_most(runs - count - 1, runs, 1.0 - probability)
    numbers = np.arange(1, count + 1, dtype=np.float64)
    steps = np.log((runs - numbers + 1.0) / numbers) + (math.log(probability) - math.log1p(-probability))
    terms = runs * math.log1p(-probability) + np.concatenate(([0.0], np.cumsum(steps)))
    highest = float(terms.max())
    return min(1.0, math.exp(highest) * float(np.exp(terms - highest).sum())) if highest > -745.0 else 0.0


def looks(most: int) -> Iterator[int]:
    """Yield after how many runs a verdict is looked for, at last after all."""
    number = FIRST_LOOK
    while number < most:
        yield number
        number *= 2
    yield most


def confidence_of_look(number: int, confidence: float) -> float:
    """Return the confidence that one look must have, from 1 on, so that all of them together have ``confidence``."""
    return 1.0 - (1.0 - confidence) / (number * (number + 1))


@dataclass(frozen=True, slots=True)
class Explanation:
    """How much a quantity differs between failed runs and others.

    Attributes:
        names: the quantity, or the axes of one that has several.
        statistic: largest distance of the two distributions, 0 to 1.
        critical: what chance exceeds in one of twenty sweeps, over all quantities.
        halved: rate of failure if its spread were half; None where the sample does not say.
    """

    name: str
    names: tuple[str, ...]
    statistic: float
    critical: float
    halved: float | None

    @property
    def explains(self) -> bool:
        """Tell whether it is more than chance."""
        return self.statistic > self.critical


def explain(
    quantities: Sequence[UncertainQuantity], drawn: Callable[[Sequence[UncertainQuantity]], Array], failed: Flags
) -> tuple[Explanation, ...]:
    """Return every quantity, what differs most first; those of one thing along several axes count as one.

    Args:
        drawn: returns the values of some quantities, in rows; the columns are runs. It is called for one thing after
            the other, so that ten million runs need not hold the values of all.
        failed: which of the runs did, one for each column.
    """
    groups: dict[str, list[UncertainQuantity]] = {}
    for quantity in quantities:
        groups.setdefault(f"{quantity.target} {quantity.source}", []).append(quantity)
    fail, rest = int(failed.sum()), int((~failed).sum())
    if not fail or not rest or not groups:
        return ()
    compared = sum(len(group) + (len(group) > 1) for group in groups.values())
    # Smirnov's asymptotic distribution; 2 exp(-2 c^2) is its first term, an upper bound of the tail.
    critical = math.sqrt(-0.5 * math.log(_CHANCE / compared / 2.0)) * math.sqrt((fail + rest) / (fail * rest))
    explanations = (_explanation(group, drawn(group), failed, critical) for group in groups.values())
    return tuple(sorted(explanations, key=lambda one: (-one.statistic, one.name)))


def _explanation(group: Sequence[UncertainQuantity], series: Array, failed: Flags, critical: float) -> Explanation:
    length = np.zeros(len(failed))
    for column in series:
        length += column**2
    np.sqrt(length, out=length)
    statistic = max(_distance(column[failed], column[~failed]) for column in (*series, length))
    names = tuple(quantity.name for quantity in group)
    name = (
        names[0] if len(names) == 1 else names[0].rpartition(" ")[0] + (" rotation" if group[0].unit == "rad" else "")
    )
    return Explanation(name, names, statistic, min(1.0, critical), _halved(group, series, failed))


def _distance(one: Array, other: Array) -> float:
    """Return the largest distance of two empirical distributions."""
    one.sort()
    other.sort()
    return max(_apart(one, other, at) for values in (one, other) for at in _in_blocks(values))


def _in_blocks(values: Array) -> Iterator[Array]:
    return (values[start : start + _TOGETHER] for start in range(0, len(values), _TOGETHER))


def _apart(one: Array, other: Array, at: Array) -> float:
    """Return the largest distance of the distributions of two sorted samples at some values."""
    first = np.searchsorted(one, at, side="right") / len(one)
    second = np.searchsorted(other, at, side="right") / len(other)
    return float(np.abs(first - second).max())


def _halved(group: Sequence[UncertainQuantity], series: Array, failed: Flags) -> float | None:
    """Return the rate of failure if these were spread half as far: by the weights that the runs had then.

    Self-normalized importance sampling. A half of a normal is within its double everywhere, so that no weight is above
    2 for each axis; of a uniform one the inner half counts alone.
    """
    weights = np.ones(len(failed))
    for quantity, column in zip(group, series, strict=True):
        shape = column / scale(quantity)
        weights *= 2.0 * (np.abs(shape) <= 0.5) if quantity.distribution == "uniform" else 2.0 * np.exp(-1.5 * shape**2)
    total = float(weights.sum())
    effective = total**2 / float((weights**2).sum()) if total else 0.0
    return float(weights[failed].sum()) / total if effective >= FIRST_LOOK / 2 else None
