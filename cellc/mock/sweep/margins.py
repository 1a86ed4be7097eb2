"""How far the runs of a sweep stayed from what bounds them: distances, joint ends, reach, collisions and ages."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.mock.nodes.observations import oldest_observation_s, pose_interface
from cellc.mock.sweep.sweep import GoalRoom, Sweep
from cellc.mock.task.bounds import joint_state_age_s
from cellc.mock.task.move import dynamic_ancestor
from cellc.robot.planning.planner import MIN_SINGULAR_VALUE


@dataclass(frozen=True, slots=True)
class Margin:
    """A figure of every run that has it, and how far it may go.

    Attributes:
        unit: m, s, 1 for a share, or empty.
        values: from the best run to the worst.
        bound: of the worst; None where nothing states one.
        falling: the less, the worse.
    """

    name: str
    unit: str
    values: tuple[float, ...]
    bound: float | None
    falling: bool = False

    def quantile(self, share: float) -> float:
        """Return what so large a share of the runs is as good as, or better."""
        return self.values[max(0, math.ceil(share * len(self.values)) - 1)]


def margins(sweep: Sweep, contract: Contract) -> Iterator[Margin]:
    """Yield the margins of a sweep, goal after goal and the age of joint states last.

    The end of an arm's reach, or another place where it loses a direction, is where the least singular value of the
    tip's Jacobian (rows in m and rad) is 0; the planner goes no nearer than its own bound.
    """
    for goal in sorted({goal for run in sweep.runs for goal in run.goals}):
        yield from _at(goal, [run.goals[goal] for run in sweep.runs if goal in run.goals], sweep, contract)
    bound_s = joint_state_age_s(contract)
    yield from _margin("age of joint states", "s", (run.joint_state_age_s for run in sweep.runs), bound_s)


def _at(goal: str, rooms: list[GoalRoom], sweep: Sweep, contract: Contract) -> Iterator[Margin]:
    used = (None if room.joint_room is None else 1.0 - 2.0 * room.joint_room for room in rooms)
    yield from _margin(
        f"distance at {goal}", "m", (room.distance_m for room in rooms), sweep.uncertainty.tolerances.get(goal)
    )
    yield from _margin(f"clearance at {goal}", "m", (room.clearance_m for room in rooms), 0.0, falling=True)
    yield from _margin(f"joint range used at {goal}", "1", used, 1.0)
    yield from _margin(
        f"least singular value at {goal}", "", (room.singular_value for room in rooms), MIN_SINGULAR_VALUE, falling=True
    )
    yield from _margin(
        f"age of transforms at {goal}", "s", (room.transform_age_s for room in rooms), _transform_age_s(contract, goal)
    )


def _margin(
    name: str, unit: str, values: Iterable[float | None], bound: float | None, *, falling: bool = False
) -> Iterator[Margin]:
    figures = tuple(sorted((value for value in values if value is not None), reverse=falling))
    if figures:
        yield Margin(name, unit, figures, bound, falling)


def _transform_age_s(contract: Contract, goal: str) -> float | None:
    """Return how old a transform may be that a goal is looked up by; None where it rests on no observation."""
    frame = dynamic_ancestor(contract, contract.goals[goal].frame)
    if frame is None:
        return None
    stated = pose_interface(contract, frame)
    interface = None if stated is None else stated[1]
    if interface is not None and interface.on_stale == "continue":
        return None
    return oldest_observation_s(interface)
