"""Many runs of one rehearsal, each with its own draws, until the verdict is certain or their number is reached."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import closing
from math import inf

from cellc.contract.compute.work import ExecutorFactory, Work, stream
from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.contract.rehearsals import RehearsalEntry
from cellc.contract.uncertainty import OF_MASSES, UNCERTAINTY_FILE, ExpectedSuccess, Uncertainty
from cellc.mock.campaign.campaign import Assignment
from cellc.mock.cell import MockCell
from cellc.mock.errors import MockError
from cellc.mock.plant import Plant
from cellc.mock.reality import Arrival, Reality
from cellc.mock.result import RunFailure
from cellc.mock.sweep.draws import LINKS, draw, reality_of
from cellc.mock.sweep.figures import Interval, confidence_of_look, interval, looks
from cellc.mock.sweep.names import SWEPT
from cellc.mock.sweep.runs import GoalRoom, RunStore, SweepRun, SweepRuns

MOST_DIGITS = 18
"""Of the number of a run: with the seed beside it, it is one of the 2^64 keys of the generator."""
USUAL_CONFIDENCE = 0.95
"""Of the interval where the cell expects nothing of the rehearsal."""


@dataclass(frozen=True, slots=True)
class Sweep:
    """The runs that the verdict rests on, in order.

    Attributes:
        uncertainty: what was drawn and judged.
        asked: most runs that were allowed.
        rate: interval of the probability of success; its confidence is that of the look that ended the sweep.
        expected: what must come of it; None where the cell expects nothing.
        verdict: whether that holds; None where it is not certain, or nothing is expected.
    """

    rehearsal: str
    seed: int
    uncertainty: Uncertainty
    asked: int
    runs: SweepRuns
    rate: Interval
    expected: ExpectedSuccess | None
    verdict: bool | None

    @property
    def failed(self) -> SweepRuns:
        """The runs that did not succeed."""
        return self.runs.failed


def name_of(rehearsal: str, run: SweepRun) -> str:
    """Return the name by which a run of a sweep is distinguished from its rehearsal."""
    return f"{rehearsal}/{SWEPT}{run.number}"


def uncertainty_of(cell: MockCell) -> Uncertainty:
    """Return what a cell draws, every name of it known.

    Raises:
        MockError: it says nothing of uncertainty, or names what it does not have.
    """
    uncertainty, contract = cell.folder.uncertainty, cell.contract
    if uncertainty is None:
        raise MockError("", f"the folder has no `{UNCERTAINTY_FILE}`; write `uncertainty: {{}}` in the spec, and build")
    known: dict[str, tuple[str, Sequence[str]]] = {
        **dict.fromkeys(LINKS, ("frame of the description", [joint.child for joint in cell.folder.description.joints])),
        "region": ("dynamic frame", [name for name, frame in contract.frames.items() if frame.simulated_parent]),
        "clock": ("clock", list(contract.clocks)),
        **dict.fromkeys(("part", "compensation"), ("device behind springs", _behind_springs(contract))),
        "payload": ("device", list(contract.devices)),
        **dict.fromkeys(("mass", "friction"), ("frame of a part", [*_of_parts(contract)])),
    }
    named = [(quantity.target, *known[quantity.kind]) for quantity in uncertainty.quantities]
    named += [(name, "goal", list(contract.goals)) for name in uncertainty.tolerances]
    named += [(name, "rehearsal", cell.rehearsals) for name in uncertainty.expected]
    for name, kind, names in named:
        if name not in names:
            raise MockError(UNCERTAINTY_FILE, f"names {kind} `{name}`, which the folder does not have")
    if len({quantity.name for quantity in uncertainty.quantities}) < len(uncertainty.quantities):
        raise MockError(UNCERTAINTY_FILE, "has two quantities with the same name")
    if cell.folder.scene is not None:
        return uncertainty
    drawn = tuple(quantity for quantity in uncertainty.quantities if quantity.kind not in OF_MASSES)
    return uncertainty.model_copy(update={"quantities": drawn})


def _of_parts(contract: Contract) -> Iterator[str]:
    return (name for name, frame in contract.frames.items() if frame.grasp is not None)


def _behind_springs(contract: Contract) -> list[str]:
    laws = {name: device.law for name, device in contract.devices.items()}
    return [name for name, law in laws.items() if law is not None and law.joints]


def reality(uncertainty: Uncertainty, seed: int, number: int) -> Reality:
    """Return what is different in a run."""
    return reality_of(uncertainty.quantities, draw(uncertainty.quantities, seed, number), seed, number)


def execute(cell: MockCell, entry: RehearsalEntry, uncertainty: Uncertainty, seed: int, number: int) -> SweepRun:
    """Execute one run; the same cell, rehearsal, seed and number give the same end to the last bit.

    Raises:
        MockError: a fault of the rehearsal names what the contract does not have.
    """
    watched: list[Plant] = []
    try:
        drawn = reality(uncertainty, seed, number)
        result = cell.rehearse(entry, seed=seed, watch=watched.append, reality=drawn, from_off=False)
    except MockError:
        raise
    except Exception as bug:  # a run that breaks the mock must not hide the runs after it
        return SweepRun(number, RunFailure.CRASHED.value, False, {}, None, type(bug).__name__)
    arrivals = watched[-1].arrivals if watched else []
    goals = {
        goal: _worst([arrival for arrival in arrivals if arrival.goal == goal])
        for goal in {arrival.goal: 0 for arrival in arrivals}
    }
    missed = next(
        (name for name, room in goals.items() if room.distance_m > uncertainty.tolerances.get(name, inf)), None
    )
    outcome = result.outcome.value if missed is None or not result.passed else f"missed {missed}"
    digest = hashlib.sha256(repr((result.attempts, arrivals)).encode()).hexdigest()[:16]
    passed = result.passed and missed is None
    age_s = _stated(max, (each.joint_state_age for each in result.attempts))
    return SweepRun(number, outcome, passed, goals, age_s, digest)


def _worst(arrivals: Sequence[Arrival]) -> GoalRoom:
    return GoalRoom(
        max(each.distance_m for each in arrivals),
        min(each.singular_value for each in arrivals),
        _stated(min, (each.joint_room for each in arrivals)),
        _stated(min, (each.clearance_m for each in arrivals)),
        _stated(max, (each.transform_age_s for each in arrivals)),
    )


def _stated(worst: Callable[[list[float]], float], values: Iterable[float | None]) -> float | None:
    stated = [value for value in values if value is not None]
    return worst(stated) if stated else None


@dataclass(frozen=True, slots=True)
class _Shared:
    assignment: Assignment
    entry: RehearsalEntry
    uncertainty: Uncertainty


def _begin(shared: _Shared) -> Callable[[int], SweepRun]:
    cell = shared.assignment.cell()
    return lambda number: execute(cell, shared.entry, shared.uncertainty, shared.assignment.seed, number)


def _arriving(
    cell: MockCell,
    entry: RehearsalEntry,
    uncertainty: Uncertainty,
    seed: int,
    numbers: Sequence[int],
    factory: ExecutorFactory | None,
) -> Generator[SweepRun, None, None]:
    """Yield the ends of runs as they come."""
    if factory is None:
        for number in numbers:
            yield execute(cell, entry, uncertainty, seed, number)
        return
    work = Work(_begin, _Shared(Assignment.of(cell, seed), entry, uncertainty), lambda number: f"sweep:{number}")
    with closing(stream(work, numbers, factory)) as answers:
        for _, run in answers:
            yield run


def sweep(
    cell: MockCell,
    entry: RehearsalEntry,
    *,
    seed: int,
    most: int,
    factory: ExecutorFactory | None,
    ends: RunStore,
    keep: Callable[[SweepRun], None],
) -> Sweep:
    """Run until the verdict is certain, or ``most`` runs have ended; always the same, and however often.

    Args:
        ends: runs of this sweep that have ended before; those that end now are added.
        keep: called with each run that ends now.

    Raises:
        ComputeError: no worker can execute a run.
        MockError: the cell draws nothing, or a run cannot be executed.
    """
    uncertainty = uncertainty_of(cell)
    expected = uncertainty.expected.get(entry.name)
    with closing(_arriving(cell, entry, uncertainty, seed, ends.missing(most), factory)) as arriving:
        for look, wanted in enumerate(looks(most) if expected else (most,), start=1):
            _gather(ends, wanted, arriving, keep)
            runs = ends.first(wanted)
            level = USUAL_CONFIDENCE if expected is None else confidence_of_look(look, expected.confidence)
            rate = interval(int(runs.passed.sum()), wanted, level)
            verdict = None if expected is None else _verdict(rate, expected.success)
            if verdict is not None:
                break
    return Sweep(entry.name, seed, uncertainty, most, runs, rate, expected, verdict)


def _gather(ends: RunStore, wanted: int, arriving: Iterator[SweepRun], keep: Callable[[SweepRun], None]) -> None:
    """Take runs as they come until the first so many are there."""
    missing = len(ends.missing(wanted))
    while missing:
        run = next(arriving)
        ends.add(run)
        missing -= run.number < wanted
        keep(run)


def _verdict(rate: Interval, success: float) -> bool | None:
    if rate.low >= success:
        return True
    return False if rate.high < success else None
