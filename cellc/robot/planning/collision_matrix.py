"""Pairs of links whose collision is not worth checking, with the reasons that an SRDF gives.

The reasons are those of MoveIt's Setup Assistant: adjacent, never, always. Like there, the last two rest on sampling:
they are no proof for the configurations between the samples.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator
from enum import Enum
from itertools import combinations

from cellc.contract.frozen import dataclass
from cellc.contract.limits import Budget
from cellc.robot.planning.model import RobotModel
from cellc.robot.planning.pair_sampling import PairCheck, beyond_reach, draw_configurations
from cellc.robot.planning.problem import Array
from cellc.robot.planning.scene import LinkPair, shape_links

ENDLESS = Budget(math.inf, time.process_time)


class DisabledReason(str, Enum):
    """Why a pair is not checked; the value is the word of the contract."""

    ADJACENT = "adjacent"
    NEVER = "never"
    ALWAYS = "always"


@dataclass(frozen=True, slots=True, order=True)
class DisabledPair:
    """Two links, the lesser name first."""

    first: str
    second: str
    reason: DisabledReason

    @property
    def links(self) -> LinkPair:
        """The names alone, as a collision scene takes them."""
        return self.first, self.second


def disabled_collisions(
    model: RobotModel, *, samples: int, rng_seed: int, margin_m: float, budget: Budget = ENDLESS
) -> tuple[DisabledPair, ...]:
    """Return the pairs of links that need no collision check, sorted by name.

    - adjacent: neighbors in the tree, with at most one movable joint and no other shape between them;
    - always: in contact at every sample;
    - never: farther apart than the margin at every sample, or by the lengths of their chains.

    Two links on one rigid body do not move against each other: they are "always" within the margin and "never" beyond.

    Args:
        samples: number of configurations, drawn uniformly within the URDF's position limits; 1 or more.
        rng_seed: seed of the draw.
        margin_m: meters.
        budget: what looking at shapes may still take.

    Raises:
        BudgetError: it takes longer.
    """
    configurations = draw_configurations(model, samples=samples, rng_seed=rng_seed)
    decided, left = _without_never(model, configurations, margin_m, budget)
    apart = _touching_in_none(model, left, budget.over(configurations), margin_m)
    return tuple(sorted((*decided, *(DisabledPair(*pair, DisabledReason.NEVER) for pair in apart))))


def decided_collisions(
    model: RobotModel, *, samples: int, rng_seed: int, margin_m: float, budget: Budget = ENDLESS
) -> tuple[DisabledPair, ...]:
    """Return the disabled pairs but for those that only samples show to be apart.

    Nearly all of the time goes into those. Who asks for contacts at a configuration does without them: the check tells
    whether they touch there.
    """
    configurations = draw_configurations(model, samples=samples, rng_seed=rng_seed)
    return _without_never(model, configurations, margin_m, budget)[0]


def standing_collisions(model: RobotModel, pairs: Iterable[LinkPair], *, margin_m: float) -> tuple[DisabledPair, ...]:
    """Return those of some pairs of links on one rigid body that are neighbors, or within a margin in m of each other.

    Args:
        pairs: the lesser name first; others of the model are not looked at.
    """
    asked = set(pairs)
    adjacent = asked & set(_adjacent(model))
    check = PairCheck(model, asked - adjacent, margin_m=margin_m)
    always = check.all_touching(draw_configurations(model, samples=1, rng_seed=0)[0])
    reasons = {DisabledReason.ADJACENT: adjacent, DisabledReason.ALWAYS: always}
    return tuple(sorted(DisabledPair(*pair, reason) for reason, found in reasons.items() for pair in found))


def _without_never(
    model: RobotModel, configurations: Array, margin_m: float, budget: Budget
) -> tuple[tuple[DisabledPair, ...], set[LinkPair]]:
    """Return the pairs that are decided, sorted, and those that are left: apart in at least one sample."""
    adjacent = set(_adjacent(model))
    rigid = set(_rigid(model)) - adjacent
    unreached = beyond_reach(model, margin_m=margin_m) - adjacent - rigid
    moving = set(_pairs(shape_links(model))) - adjacent - rigid - unreached
    at_rest = PairCheck(model, rigid, margin_m=margin_m).all_touching(configurations[0])
    always = _touching_in_all(PairCheck(model, moving), moving, budget.over(configurations))
    reasons = {
        DisabledReason.ADJACENT: adjacent,
        DisabledReason.ALWAYS: at_rest | always,
        DisabledReason.NEVER: (rigid - at_rest) | unreached,
    }
    decided = (DisabledPair(*pair, reason) for reason, pairs in reasons.items() for pair in pairs)
    return tuple(sorted(decided)), moving - always


def _touching_in_all(check: PairCheck, pairs: set[LinkPair], configurations: Iterable[Array]) -> set[LinkPair]:
    left = set(pairs)
    for configuration in configurations:
        if not left:
            break
        free = left - check.all_touching(configuration)
        check.drop(free)
        left -= free
    return left


def _touching_in_none(
    model: RobotModel, pairs: set[LinkPair], configurations: Iterable[Array], margin_m: float
) -> set[LinkPair]:
    left = set(pairs)
    check, bound = PairCheck(model, left, margin_m=margin_m), len(left)
    for configuration in configurations:
        if not left:
            break
        while touching := check.some_touching(configuration):
            check.drop(touching)
            left -= touching
        if len(left) < bound // 2:  # shapes without a pair would be moved on with the others
            check, bound = PairCheck(model, left, margin_m=margin_m), len(left)
    return left


def _pairs(names: list[str]) -> Iterator[LinkPair]:
    return combinations(sorted(set(names)), 2)


def _rigid(model: RobotModel) -> Iterator[LinkPair]:
    """Yield the pairs of links between which no joint moves."""
    bodies: dict[int, list[str]] = {}
    for shape, name in zip(model.geometry.geometryObjects, shape_links(model), strict=True):
        bodies.setdefault(int(shape.parentJoint), []).append(name)
    for names in bodies.values():
        yield from _pairs(names)


def _adjacent(model: RobotModel) -> Iterator[LinkPair]:
    """Yield each link that has a shape with the nearest such link above it, if at most one joint moves between them."""
    frames = model.kinematics.frames
    shaped = {int(shape.parentFrame) for shape in model.geometry.geometryObjects}
    for frame in shaped:
        ancestor = _shaped_ancestor(model, frame, shaped)
        if ancestor is None:
            continue
        joint, other = frames[frame].parentJoint, frames[ancestor].parentJoint
        if other in (joint, model.kinematics.parents[joint]):
            first, second = sorted((str(frames[frame].name), str(frames[ancestor].name)))
            yield first, second


def _shaped_ancestor(model: RobotModel, frame: int, shaped: set[int]) -> int | None:
    frames = model.kinematics.frames
    at = frames[frame].parentFrame
    while at != 0:
        if at in shaped:
            return int(at)
        at = frames[at].parentFrame
    return None
