"""How far the runs of a sweep stayed from what bounds them: distances, joint ends, reach, collisions and ages."""

from __future__ import annotations

import math
from collections.abc import Iterator

from cellc.contract.contract import Contract
from cellc.contract.frozen import dataclass
from cellc.mock.nodes.observations import oldest_observation_s, pose_interface
from cellc.mock.sweep.runs import Figures
from cellc.mock.sweep.sweep import Sweep
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
    values: Figures
    bound: float | None
    falling: bool = False

    def quantile(self, share: float) -> float:
        """Return what so large a share of the runs is as good as, or better."""
        return float(self.values[max(0, math.ceil(share * len(self.values)) - 1)])


def margins(sweep: Sweep, contract: Contract) -> Iterator[Margin]:
    """Yield the margins of a sweep, goal after goal and the age of joint states last.

    The end of an arm's reach, or another place where it loses a direction, is where the least singular value of the
    tip's Jacobian (rows in m and rad) is 0; the planner goes no nearer than its own bound.
    """
    for goal in sweep.runs.goals:
        yield from _at(goal, sweep, contract)
    yield from _margin("age of joint states", "s", sweep.runs.joint_state_ages_s, joint_state_age_s(contract))


def _at(goal: str, sweep: Sweep, contract: Contract) -> Iterator[Margin]:
    runs = sweep.runs
    tolerance_m, age_s = sweep.uncertainty.tolerances.get(goal), _transform_age_s(contract, goal)
    yield from _margin(f"distance at {goal}", "m", runs.room(goal, "distance_m"), tolerance_m)
    yield from _margin(f"clearance at {goal}", "m", runs.room(goal, "clearance_m"), 0.0, falling=True)
    yield from _margin(f"joint range used at {goal}", "1", 1.0 - 2.0 * runs.room(goal, "joint_room"), 1.0)
    least = runs.room(goal, "singular_value")
    yield from _margin(f"least singular value at {goal}", "", least, MIN_SINGULAR_VALUE, falling=True)
    yield from _margin(f"age of transforms at {goal}", "s", runs.room(goal, "transform_age_s"), age_s)


def _margin(name: str, unit: str, values: Figures, bound: float | None, *, falling: bool = False) -> Iterator[Margin]:
    if len(values):
        values.sort()
        yield Margin(name, unit, values[::-1] if falling else values, bound, falling)


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
