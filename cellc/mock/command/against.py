"""`cellc mock FOLDER --physics --against`: each rehearsal without and with masses, and where the two part."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

from cellc.contract.attempt import AttemptRecord
from cellc.contract.diagnostics.unsafe_text import json_document
from cellc.contract.frozen import dataclass
from cellc.contract.printing import progress, show, show_document
from cellc.mock.cell import MockCell, in_turn, load
from cellc.mock.command.options import RehearsalOptions
from cellc.mock.physics.drives import Away, farthest
from cellc.mock.plant import Plant
from cellc.mock.result import RehearsalResult
from cellc.mock.task.mass import grippers

_LEAST_S = 0.1
"""Time by which a step must be longer or shorter to be listed."""


@dataclass(frozen=True, slots=True)
class Comparison:
    """One rehearsal without masses and with them.

    Attributes:
        away: the joint that was farthest from its command with masses; None where all were on it.
    """

    without: RehearsalResult
    having: RehearsalResult
    away: Away | None

    @property
    def alike(self) -> bool:
        """Whether both end in the same outcome."""
        return self.without.outcome == self.having.outcome

    def parting(self) -> str:
        """Say at which step the two part; empty where every step ends alike and takes about as long."""
        steps = zip_longest(self.without.attempts[:-1], self.having.attempts[:-1])
        for number, (one, other) in enumerate(steps, start=1):
            if one is None or other is None or one.outcome != other.outcome:
                return f"step {number} `{_step(one or other)}`: {_end(one)} without mass, {_end(other)} with it"
        return "; ".join(self._longer())

    def _longer(self) -> Iterator[str]:
        steps = zip(self.without.attempts[:-1], self.having.attempts[:-1], strict=True)
        for number, (one, other) in enumerate(steps, start=1):
            more_s = (other.ended_ns - other.started_ns - one.ended_ns + one.started_ns) / 1e9
            if abs(more_s) >= _LEAST_S:
                yield f"step {number} `{_step(other)}` takes {abs(more_s):.2f} s {'longer' if more_s > 0 else 'less'}"


def _step(attempt: AttemptRecord | None) -> str:
    return "" if attempt is None else attempt.step


def _end(attempt: AttemptRecord | None) -> str:
    return "not started" if attempt is None else attempt.outcome.value


def compare(options: RehearsalOptions) -> int:
    """Run rehearsals of a folder without and with masses, and print where they part.

    Returns:
        0: every rehearsal passed with masses; 1: one did not, or the folder has none.

    Raises:
        MockError, MissingExtraError: as ``load``.
    """
    having = load(Path(options.folder), edited=options.edited, stage=options.stage, physics=True)
    without = load(Path(options.folder), edited=options.edited, stage=options.stage)
    names = tuple(dict.fromkeys(options.rehearsals)) or having.rehearsals
    found: list[Comparison] = []
    with progress("mock") as update:
        for number, name in enumerate(in_turn(having, names), start=1):
            update(f"rehearsal {number} of {len(names)}, {name}")
            found.append(compared(without, having, name, options.seed))
    if options.as_json:
        show_document(_document(found))
    else:
        show(*(line for each in found for line in _lines(each)))
    return 0 if found and all(each.having.passed for each in found) else 1


def compared(without: MockCell, having: MockCell, name: str, seed: int) -> Comparison:
    """Run one rehearsal twice."""
    plants: list[Plant] = []
    with_mass = having.rehearse(having.entry(name), seed=seed, watch=plants.append, from_off=False)
    dynamics = plants[-1].control.dynamics if plants else None
    away = None if dynamics is None else farthest(dynamics, 0, grippers(having.contract))
    return Comparison(without.run(name, seed=seed), with_mass, away)


def _lines(each: Comparison) -> Iterator[str]:
    one, other = each.without, each.having
    if each.alike:
        lasted = f"{one.sim_time_s:.2f} s without mass, {other.sim_time_s:.2f} s with it"
        yield f"alike    {other.title}: {one.outcome}, {lasted}"
    else:
        yield f"DIFFERS  {other.title}: {one.outcome} without mass, {other.outcome} with it"
    yield from (f"         {line}" for line in _details(each))


def _details(each: Comparison) -> Iterator[str]:
    if parting := each.parting():
        yield parting
    if not each.alike and each.having.reason:
        yield f"reason: {each.having.reason}"
    if each.away is not None:
        yield str(each.away)
    yield from (f"finding: {finding}" for finding in each.having.findings if finding not in each.without.findings)


def _document(found: list[Comparison]) -> str:
    rows = [
        {
            "name": each.having.name,
            "alike": each.alike,
            "outcome": {"without": each.without.outcome, "with": each.having.outcome},
            "sim_time_s": {"without": each.without.sim_time_s, "with": each.having.sim_time_s},
            "passed": each.having.passed,
            "details": list(_details(each)),
        }
        for each in found
    ]
    return json_document({"rehearsals": rows})
