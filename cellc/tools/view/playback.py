"""What the page plays back: where every group was when, what was done when; and a rehearsal as it ran on the mock."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cellc.contract.attempt import AttemptRecord, PacketStep
from cellc.mock.cell import MockCell
from cellc.mock.control import JointStateBlock
from cellc.mock.engine.control_stack import GoalSent
from cellc.mock.evidence.fault_times import fault_times
from cellc.mock.plant import Plant
from cellc.tools.view.poses import Values
from cellc.tools.view.scene import Numbers, rounded
from cellc.tools.view.skeleton import Carried, Skeleton

STEP_NS = 40_000_000
"""Twenty-five pictures a second; between two of them the page goes on a straight line."""
_MS = 1_000_000
_STILL = 1e-5
"""Below it, in rad or m from one picture to the next, a joint is at rest."""

_Positions = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Mark:
    """An instant of the time line with its name."""

    at_s: float
    name: str


@dataclass(frozen=True, slots=True)
class Moment:
    """A span of the time line in s: an attempt at a step and its outcome.

    Attributes:
        phases: the eight steps of its packet that were made, in the order of time.
        works: from when to when its goal was executed; empty where it had none.
    """

    from_s: float
    until_s: float
    name: str
    outcome: str
    reason: str
    phases: tuple[Mark, ...]
    works: Numbers


@dataclass(frozen=True, slots=True)
class Apart:
    """Where a run is farthest from another one within one of its moments.

    Attributes:
        far_m: between the places of the group in both.
        name: of the group.
    """

    at_s: float
    far_m: float
    name: str


@dataclass(frozen=True, slots=True)
class Ghost:
    """Another run that is drawn translucent beside one.

    Attributes:
        run: its number on the page.
        shift_s: time of the run at which the other begins.
        apart: for each moment of the run; empty where one of both has no picture.
        marks: where both part.
    """

    run: int
    name: str
    shift_s: float
    apart: tuple[Apart, ...]
    marks: tuple[Mark, ...]


@dataclass(frozen=True, slots=True)
class Track:
    """Where a group was at each time of the run: seven numbers for each."""

    group: int
    poses: Numbers


@dataclass(frozen=True, slots=True)
class Run:
    """A rehearsal, or an attempt that was recorded, to play back.

    Attributes:
        times: of the pictures, s; none where the cell never started. A rehearsal's first step begins at zero.
        base: seven numbers for each group as the run begins.
        tracks: of the groups that moved.
        reason: why it ended as it did.
        expected: of a rehearsal, as `passed` and `faults` are.
        ghost: what an attempt is shown beside.
    """

    name: str
    outcome: str
    reason: str
    end_s: float
    times: Numbers
    base: Numbers
    tracks: tuple[Track, ...]
    moments: tuple[Moment, ...]
    expected: str = ""
    passed: bool = True
    faults: tuple[Mark, ...] = ()
    recorded: bool = False
    ghost: Ghost | None = None


class _Listener:
    """Keeps joint states as they are published, 25 a second."""

    def __init__(self, plant: Plant) -> None:
        self.plant = plant
        self.rows: dict[tuple[str, str], list[tuple[int, dict[str, float]]]] = {}
        plant.control.watch(self)

    def configured(self) -> None:
        """Nothing was published yet."""

    def goal_sent(self, sent: GoalSent) -> None:
        """Goals are known from the attempts."""

    def joint_states(self, manager: str, controller: str, block: JointStateBlock) -> None:
        rows = self.rows.setdefault((manager, controller), [])
        slots = block.stamps_ns // STEP_NS
        last = rows[-1][0] // STEP_NS if rows else -1
        for index in np.flatnonzero(np.diff(slots, prepend=last)).tolist():
            taken = dict(zip(block.names, block.positions[index].tolist(), strict=True))
            rows.append((int(block.stamps_ns[index]), taken))


def play(cell: MockCell, name: str, skeleton: Skeleton, seed: int) -> Run:
    """Run a rehearsal and keep what the page plays back; time zero is when its first step begins, as for its faults.

    Raises:
        MockError: it names what the contract does not have.
    """
    heard: list[_Listener] = []
    entry = cell.entry(name)
    result = cell.rehearse(entry, seed=seed, watch=lambda plant: heard.append(_Listener(plant)))
    times: list[int] = []
    postures: Sequence[Values] = ()
    if heard:
        plant = heard[0].plant
        joints, world = _joints(heard[0]), plant.world
        handed_over = [placed.from_ns for name in world.objects() for placed in world.placements(name)[1:]]
        times = _kept(joints, handed_over, plant.now_ns)
        at = {joint.name: np.interp(times, joint.stamps_ns, joint.positions) for joint in joints}
        postures = skeleton.postures(at, [_carried(plant, time_ns) for time_ns in times])
    begin_ns = result.attempts[-1].started_ns if result.attempts else 0
    return replace(
        run_of(
            result.name,
            result.outcome.value,
            result.reason,
            [_moment(record, begin_ns) for record in result.attempts[:-1]],
            [(time_ns - begin_ns) / 1e9 for time_ns in times],
            postures,
            (heard[0].plant.now_ns - begin_ns) / 1e9 if heard else 0.0,
        ),
        expected=result.expected.value,
        passed=result.passed,
        faults=tuple(
            Mark(round(at - begin_ns / 1e9, 3), f"{fault.kind.value.replace('_', ' ')} {fault.target}")
            for at, fault in fault_times(entry.faults, result.attempts)
        ),
    )


@dataclass(frozen=True, slots=True)
class _Signal:
    """Positions of one joint over time."""

    name: str
    stamps_ns: NDArray[np.int64]
    positions: _Positions


def _joints(heard: _Listener) -> list[_Signal]:
    """Return the signal of each joint from the manager that drives it."""
    signals: list[_Signal] = []
    for key, rows in heard.rows.items():
        stamps = np.array([stamp for stamp, _ in rows], dtype=np.int64)
        for joint in heard.plant.control.histories[key].names:
            values = np.array([taken.get(joint, np.nan) for _, taken in rows])
            good = np.isfinite(values)
            if good.any():
                signals.append(_Signal(joint, stamps[good], values[good]))
    return signals


def _kept(joints: Sequence[_Signal], handed_over: Sequence[int], end_ns: int) -> list[int]:
    """Return the times of the pictures: a picture between two equal ones is left out."""
    times = np.arange(0, end_ns + STEP_NS, STEP_NS)
    times[-1] = end_ns
    table = np.array([np.interp(times, joint.stamps_ns, joint.positions) for joint in joints]).reshape(
        len(joints), len(times)
    )
    moved = (np.abs(np.diff(table, axis=1)) > _STILL).any(axis=0)
    wanted = np.concatenate([[True], moved]) | np.concatenate([moved, [True]])
    # A picture before and one at the change: what is handed over does not glide.
    around = [at for change in handed_over for at in (max(0, change - _MS), change)]
    return sorted({*times[wanted].tolist(), *around})


def _carried(plant: Plant, time_ns: int) -> Carried:
    carried = {}
    for name in plant.world.objects():
        placements = plant.world.placements(name)
        index = bisect_right(placements, time_ns, key=lambda one: one.from_ns) - 1
        carried[name] = (placements[max(0, index)].link, placements[max(0, index)].pose)
    return carried


def run_of(
    name: str,
    outcome: str,
    reason: str,
    moments: Sequence[Moment],
    times: Sequence[float],
    postures: Sequence[Values],
    end_s: float,
) -> Run:
    """Return a run of pictures at some times, in s; a group that never moves is in the first of them alone.

    Args:
        postures: of each group, shape (7, times).
    """
    rows = [rounded(poses) for poses in postures if poses.size]
    moving = [number for number, poses in enumerate(rows) if any(row != poses[0] for row in poses)]
    return Run(
        name=name,
        outcome=outcome,
        reason=reason,
        end_s=round(end_s, 3),
        times=tuple(round(time, 3) for time in times),
        base=tuple(value for poses in rows for value in poses[0]),
        tracks=tuple(Track(number, tuple(value for row in rows[number] for value in row)) for number in moving),
        moments=tuple(moments),
    )


def moment_of(
    span_s: tuple[float, float], name: str, outcome: str, reason: str, stamps_s: Mapping[PacketStep, float]
) -> Moment:
    """Return a moment of a step; an instant outside its span is at its begin or its end."""
    from_s, until_s = span_s
    within = {step: round(min(max(at_s, from_s), until_s), 3) for step, at_s in stamps_s.items()}
    phases = tuple(Mark(at_s, step.value) for step, at_s in sorted(within.items(), key=lambda each: each[1]))
    ends = [within[step] for step in (PacketStep.ACCEPTED, PacketStep.RETURNED) if step in within]
    works = tuple(ends) if len(ends) == 2 else ()
    return Moment(round(from_s, 3), round(until_s, 3), name, outcome, reason, phases, works)


def _moment(record: AttemptRecord, begin_ns: int) -> Moment:
    span_s = (record.started_ns - begin_ns) / 1e9, (record.ended_ns - begin_ns) / 1e9
    stamps_s = {step: (at_ns - begin_ns) / 1e9 for step, at_ns in record.stamps.items()}
    return moment_of(span_s, record.step, record.outcome.value, record.fault_code, stamps_s)
