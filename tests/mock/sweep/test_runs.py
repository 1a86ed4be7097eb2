"""Runs that are kept in columns are equal to those that were added, whatever they are, in whatever order they came."""

from __future__ import annotations

import random
from collections import Counter
from math import inf, nextafter

import pytest

from cellc.mock.sweep.runs import GoalRoom, RunStore, SweepRun, SweepRuns

DIGESTS = ("0123456789abcdef", "0000000000000000", "ffffffffffffffff", "KeyError", "FFFFFFFFFFFFFFFF", "0x1", "1_0", "")


def _figure(chance: random.Random) -> float:
    return chance.choice([0.0, -0.0, 5e-324, nextafter(1.0, inf), inf, chance.random(), -chance.random()])


def _run(number: int, chance: random.Random) -> SweepRun:
    def stated() -> float | None:
        return chance.choice([None, _figure(chance)])

    goals = chance.sample(("put", "pick", "between"), chance.randrange(4))
    return SweepRun(
        number,
        chance.choice(["succeeded", "missed put", "timeout"]),
        chance.random() < 0.5,
        {goal: GoalRoom(_figure(chance), _figure(chance), stated(), stated(), stated()) for goal in goals},
        stated(),
        chance.choice(DIGESTS),
    )


@pytest.fixture(scope="module")
def runs() -> list[SweepRun]:
    """More than the columns begin with, out of order, and two of very large numbers."""
    chance = random.Random(7)
    numbers = [*chance.sample(range(3000), 2500), 10**17, (1 << 26) + 1]
    return [_run(number, chance) for number in numbers]


@pytest.fixture(scope="module")
def store(runs: list[SweepRun]) -> RunStore:
    filled = RunStore()
    for run in runs:
        filled.add(run)
    return filled


def test_a_run_is_what_was_added(runs: list[SweepRun], store: RunStore) -> None:
    # The text tells 0.0 from -0.0, and the order of goals.
    assert [repr(store[run.number]) for run in runs] == [repr(run) for run in runs]
    assert (list(store), len(store)) == ([run.number for run in runs], len(runs))
    absent = next(number for number in range(3000) if number not in store)
    assert absent not in {run.number for run in runs}
    with pytest.raises(KeyError):
        store[absent]


def test_what_is_missing_and_what_is_first(runs: list[SweepRun], store: RunStore) -> None:
    known = {run.number: run for run in runs}
    assert list(store.missing(4000)) == [number for number in range(4000) if number not in known]
    assert list(RunStore().missing(10)) == list(range(10))
    whole = RunStore()
    for number in reversed(range(50)):
        whole.add(_run(number, random.Random(number)))
    assert list(map(repr, whole.first(20))) == [repr(_run(number, random.Random(number))) for number in range(20)]


def test_columns_are_those_of_the_runs(runs: list[SweepRun]) -> None:
    some = SweepRuns.listed(runs)[1000:]
    wanted = runs[1000:]
    assert some.numbers.tolist() == [run.number for run in wanted]
    assert some.passed.tolist() == [run.passed for run in wanted]
    assert list(map(repr, some.failed)) == [repr(run) for run in wanted if not run.passed]
    assert list(some.outcomes().items()) == list(Counter(run.outcome for run in wanted).items())
    assert some.goals == ["between", "pick", "put"]
    assert some.joint_state_ages_s.tolist() == [
        run.joint_state_age_s for run in wanted if run.joint_state_age_s is not None
    ]
    clearances = [run.goals["pick"].clearance_m for run in wanted if "pick" in run.goals]
    assert some.room("pick", "clearance_m").tolist() == [figure for figure in clearances if figure is not None]


def test_ten_thousand_runs_take_72_bytes_each_and_an_eighth_for_what_comes() -> None:
    filled = RunStore()
    room = GoalRoom(0.001, 0.1, 0.4, None, None)
    for number in range(10_000):
        filled.add(SweepRun(number, "succeeded", True, {"put": room}, 0.01, f"{number:016x}"))
    assert 72 <= filled.bytes_each <= 72 * 9 / 8 + 8
