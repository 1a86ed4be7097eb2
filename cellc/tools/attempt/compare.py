"""Where an attempt and a rehearsal of it part: outcome, time and error of each step; and what both bags measure."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellc.contract.attempt import PacketStep
from cellc.contract.contract import ContractManager
from cellc.contract.diagnostics.wording import count
from cellc.contract.vocabulary import TRAJECTORIES
from cellc.mock.report_page.html import plain, small
from cellc.tools.attempt.measures import Measure
from cellc.tools.attempt.record import JOINT, UNKNOWN, Attempt, Report

_LATER_SHARE, _LATER_S = 0.1, 0.05
"""A step takes another time where it differs by more than both: a tenth, and 50 ms."""
_ERROR_FACTOR, _ERROR = 2.0, 1e-3
"""An error is another one where it is more than twice the other, and differs by more than 1 mrad or 1 mm."""


@dataclass(frozen=True, slots=True)
class Side:
    """One step of an attempt or a rehearsal.

    Attributes:
        took_s: from the acceptance of its goal to the result, or of a step without a goal as a whole.
        error: largest following error of its goal, rad or m.
        is_followed: a trajectory controller executed its goal, so that it has such an error.
    """

    outcome: str
    took_s: float | None
    error: float | None
    at_s: float | None
    is_followed: bool


@dataclass(frozen=True, slots=True)
class Step:
    """One step on both sides; None where a side has none."""

    name: str
    real: Side | None
    rehearsed: Side | None


@dataclass(frozen=True, slots=True)
class Paired:
    """One figure on both sides; None where a side does not know the thing that was measured."""

    real: Measure
    rehearsed: Measure | None


@dataclass(frozen=True, slots=True)
class Comparison:
    """An attempt against a rehearsal.

    Attributes:
        parted: where they part, in the order of the steps, one line each.
    """

    name: str
    parted: tuple[str, ...]
    steps: tuple[Step, ...]
    measures: tuple[Paired, ...]


@dataclass(frozen=True, slots=True)
class Parting:
    """Where both sides part at a step, numbered from 1.

    Attributes:
        what: `outcome`, `time`, `error`, or `not made`.
        words: both sides.
    """

    number: int
    step: Step
    what: str
    words: str

    def __str__(self) -> str:
        return f"step {self.number} `{self.step.name}`: {self.words}"


def compare(real: Report, rehearsed: Report, name: str) -> Comparison:
    """Compare an attempt with a rehearsal of the same steps."""
    mine, theirs = ([_side(report, each) for each in report.attempts[:-1]] for report in (real, rehearsed))
    names = [each.step for each in max(real.attempts[:-1], rehearsed.attempts[:-1], key=len)]
    steps = tuple(
        Step(step, mine[at] if at < len(mine) else None, theirs[at] if at < len(theirs) else None)
        for at, step in enumerate(names)
    )
    parted = tuple(map(str, partings(steps)))
    known = {(each.name, each.of): each for each in rehearsed.measures}
    measures = tuple(Paired(each, known.get((each.name, each.of))) for each in real.measures)
    return Comparison(name, parted, steps, measures)


def _side(report: Report, attempt: Attempt) -> Side:
    stamps = attempt.stamps
    begin_ns = stamps.get(PacketStep.ACCEPTED, attempt.started_ns)
    end_ns = stamps.get(PacketStep.RETURNED, attempt.ended_ns)
    took_s = None if begin_ns is None or end_ns is None else (end_ns - begin_ns) / 1e9
    at_ns = attempt.ended_ns if attempt.finding is None else attempt.finding.at_ns
    at_s = None if at_ns is None else (at_ns - report.begin_ns) / 1e9
    error = report.errors.get(attempt.action_goal_id or "")
    followed = {name for each in report.contract.managers.values() for name in _followed(each)}
    return Side(attempt.outcome or UNKNOWN, took_s, error, at_s, attempt.controller_name in followed)


def _followed(manager: ContractManager) -> Iterator[str]:
    yield from (name for name, facts in manager.controllers.items() if facts.behavior in TRAJECTORIES)


def partings(steps: Sequence[Step]) -> Iterator[Parting]:
    """Yield where both sides part, in the order of the steps."""
    for number, step in enumerate(steps, start=1):
        yield from (Parting(number, step, what, words) for what, words in _parted(step))


def _parted(step: Step) -> Iterator[tuple[str, str]]:
    real, rehearsed = step.real, step.rehearsed
    if real is None or rehearsed is None:
        yield NOT_MADE, f"{_outcome(real)}, rehearsed {_outcome(rehearsed)}"
        return
    if real.outcome != rehearsed.outcome:
        at = "" if real.at_s is None else f" at {real.at_s:.3f} s"
        yield "outcome", f"outcome {real.outcome}{at}, rehearsed {rehearsed.outcome}"
    if real.took_s is not None and rehearsed.took_s is not None:
        apart_s = abs(real.took_s - rehearsed.took_s)
        if apart_s > max(_LATER_S, _LATER_SHARE * max(real.took_s, rehearsed.took_s)):
            yield "time", f"time {real.took_s:.3f} s, rehearsed {rehearsed.took_s:.3f} s"
    if real.error is not None and rehearsed.error is not None:
        larger, smaller = max(real.error, rehearsed.error), min(real.error, rehearsed.error)
        if larger > _ERROR_FACTOR * smaller and larger - smaller > _ERROR:
            yield "error", f"error {small(real.error, JOINT)}, rehearsed {small(rehearsed.error, JOINT)}"


STEP_NAMES = ("step", "outcome", "rehearsed", "took, s", "rehearsed, s", "error", "rehearsed error")
MEASURE_NAMES = ("figure", "measured", "rehearsed", "stated", "from")


NOT_MADE = "not made"
_NONE = "–"
"""In place of what a step does not have."""


def step_words(step: Step) -> tuple[str, ...]:
    """Return a step as a row of a table."""
    sides = (step.real, step.rehearsed)
    outcomes = map(_outcome, sides)
    times = (_NONE if side is None else _number(side.took_s, ".3f") for side in sides)
    errors = (_NONE if side is None or not side.is_followed else _error(side.error) for side in sides)
    return step.name, *outcomes, *times, *errors


def _outcome(side: Side | None) -> str:
    return NOT_MADE if side is None else side.outcome


def _number(value: float | None, form: str) -> str:
    return UNKNOWN if value is None else format(value, form)


def _error(value: float | None) -> str:
    return UNKNOWN if value is None else small(value, JOINT)


def measure_words(paired: Paired) -> tuple[str, ...]:
    """Return a figure as a row of a table: name, both sides, what is stated, and what it was measured from."""
    real = paired.real
    rehearsed = UNKNOWN if paired.rehearsed is None else _value(paired.rehearsed)
    source = f"{real.source}, for {real.spec}"
    return f"{real.name} of {real.of}", _value(real), rehearsed, real.stated or "nothing", source


def _value(measure: Measure) -> str:
    if measure.median is None or measure.worst is None:
        return UNKNOWN
    values = (plain(each, measure.unit) for each in (measure.median, measure.worst))
    return "median {}, worst {}, {}".format(*values, count(measure.count, "value"))
