"""From bags and the package of their cell to the report: one pass over the messages, then the records."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from cellc.contract.bring_up import Watch
from cellc.contract.contract import Contract
from cellc.contract.file_names import is_cell_name
from cellc.contract.printing import stage
from cellc.contract.rehearsals import RehearsalEntry
from cellc.tools.attempt.bag import BagError, Bags, open_bags
from cellc.tools.attempt.derive import Deriver
from cellc.tools.attempt.figures import figures_of
from cellc.tools.attempt.follow import Followed, Follower
from cellc.tools.attempt.heard import Decoder, Heard
from cellc.tools.attempt.measures import MeasureBuilder
from cellc.tools.attempt.record import Report
from cellc.tools.attempt.signals import SignalBuilder
from cellc.tools.attempt.topics import Sources, sources_of

_OFTEN = 5_000
"""Messages after which the progress is shown."""


Listen = Callable[[int, Heard], None]


@dataclass(frozen=True, slots=True)
class Drawn:
    """What is known of the joints of a package beside its contract.

    Attributes:
        sliding: joints whose positions are lengths.
        tolerances: path tolerance of each joint that has one, rad or m.
    """

    sliding: Collection[str]
    tolerances: Mapping[str, float]


def read_attempt(
    paths: Sequence[Path],
    contract: Contract,
    rehearsals: Sequence[RehearsalEntry],
    watches: Sequence[Watch],
    task: str | None,
    drawn: Drawn | None = None,
    listen: Listen | None = None,
) -> Report:
    """Read bags as the record of the task that they are of.

    Args:
        task: name of a rehearsal whose steps the task made; that which the bag is named after where it is None.
        drawn: what signals and measures need, where they are wanted too.
        listen: takes each message too, with its arrival in ns from the begin of the bags on.

    Raises:
        BagError: they cannot be read, or are of another cell.
        MissingExtraError: the reader is not installed.
    """
    stage(f"reading {paths[0].name}")
    stem = paths[0].stem if paths[0].suffix else paths[0].name
    steps = _steps(rehearsals, task, stem)
    with open_bags(tuple(paths)) as bags:
        sources = sources_of(contract, watches, bags.topics)
        _refuse_other(paths[0], contract, bags, sources)
        builders = None
        if drawn is not None:
            measures = MeasureBuilder(contract, sources, drawn.tolerances)
            builders = SignalBuilder(contract, sources, drawn.sliding), measures
        followed, notes = _follow(bags, Follower(contract, sources), builders, listen)
    notes = (*notes, *_compare_joints(paths[0], contract, followed, sources))
    reported = {controller for topic, controller in sources.states.items() if topic in sources.topics}
    name = None if steps is None else steps.name
    attempts = Deriver(contract, followed, stem, name).attempts(() if steps is None else steps.steps)
    return Report(
        contract,
        tuple(path.as_posix() for path in paths),
        name,
        tuple(attempts),
        figures_of(contract, attempts, followed),
        notes,
        sources.missing,
        followed.heard,
        followed.begin_ns,
        followed.end.at_ns,
        None if builders is None else builders[0].signals(followed.end.at_ns - followed.begin_ns),
        () if builders is None else builders[1].measures(followed),
        {goal.goal_id: goal.worst_error for goal in followed.goals if goal.action.controller in reported},
    )


def cell_of(paths: Sequence[Path]) -> str | None:
    """Return the name of the cell that bags of the mock state; None where a bag states none.

    Raises:
        BagError: they cannot be read.
        MissingExtraError: the reader is not installed.
    """
    with open_bags(tuple(paths)) as bags:
        cells = {identity.get("cell") for identity in bags.identity.values()}
    cell = next(iter(cells)) if len(cells) == 1 else None
    return cell if cell is not None and is_cell_name(cell) else None


def _steps(rehearsals: Sequence[RehearsalEntry], task: str | None, stem: str) -> RehearsalEntry | None:
    named = {entry.name: entry for entry in rehearsals}
    if task is not None and task not in named:
        known = ", ".join(f"`{name}`" for name in named) or "none"
        raise BagError(f"the package has no rehearsal `{task}`; it has {known}")
    return named.get(stem if task is None else task)


def _refuse_other(path: Path, contract: Contract, bags: Bags, sources: Sources) -> None:
    """Refuse a bag that says whose it is, that has no topic of this cell's own, or that has one of another type."""
    recorded = bags.topics
    for of, identity in bags.identity.items():
        for name, ours in (("cell", contract.cell), ("configuration_id", contract.configuration_id)):
            theirs = identity.get(name, ours)
            if theirs != ours:
                raise BagError(f"{of}: is no bag of this package: its {name} must be {ours}, got {theirs}")
    for name, kind in recorded.items():
        stated = contract.interfaces.get(name)
        if stated is not None and stated.kind == "topic" and stated.type != kind:
            raise BagError(
                f"{path.as_posix()}: is no bag of {contract.cell}: `{name}` must be {stated.type}, got {kind}"
            )
    served = [name for name, action in sources.actions.items() if action.controller]  # every cell has a planner
    own = [name for name in (*served, *sources.states) if name in recorded]
    if not own:
        wanted, found = next(iter(sources.actions), "/joint_states"), ", ".join(sorted(recorded)[:8])
        raise BagError(f"{path.as_posix()}: is no bag of {contract.cell}: expected `{wanted}`, got {found}")


def _compare_joints(path: Path, contract: Contract, followed: Followed, sources: Sources) -> list[str]:
    """Refuse a bag whose joint states lack joints of the cell and have others; note where only one is so."""
    heard = followed.positions.keys()
    moved = {joint for each in sources.actions.values() for joint in each.joints}
    missing = sorted(moved - heard) if heard else []
    foreign = sorted(heard - moved - contract.joint_limits.keys()) if heard else []
    if missing and foreign:
        raise BagError(
            f"{path.as_posix()}: is no bag of {contract.cell}: its joint states must have `{missing[0]}`, "
            f"got {', '.join(f'`{joint}`' for joint in foreign[:8])}"
        )
    return [f"no joint state has `{joint}`" for joint in missing]


def _follow(
    bags: Bags,
    follower: Follower,
    builders: tuple[SignalBuilder, MeasureBuilder] | None,
    listen: Listen | None,
) -> tuple[Followed, tuple[str, ...]]:
    decoder = Decoder(bags.definitions, follower.contract.distro)
    for count, raw in enumerate(bags.messages(follower.sources.topics), start=1):
        heard = decoder.decode(raw)
        if heard is not None:
            follower.take(raw.log_ns, raw.topic, heard)
            begin_ns = follower.followed.begin_ns
            if listen is not None:
                listen(raw.log_ns - begin_ns, heard)
            if builders is not None:
                builders[0].take(raw.log_ns - begin_ns, raw.topic, heard, begin_ns)
                builders[1].take(raw.log_ns, raw.topic, heard)
        if count % _OFTEN == 0:
            stage(f"{count} messages, {(raw.log_ns - follower.followed.begin_ns) / 1e9:.0f} s of the bag")
    followed = follower.finish()
    lost = [f"{count} messages of `{topic}` cannot be decoded" for topic, count in decoder.unreadable.items()]
    more = [f"{followed.dropped} goals, lines or changes are too many, and not kept"] if followed.dropped else []
    return followed, (*bags.notes, *lost, *more)
