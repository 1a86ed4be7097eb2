"""Which pairs of links touch: in configurations drawn within the position limits, or by the lengths of their chains."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pinocchio

from cellc.contract.frozen import dataclass
from cellc.robot.planning.model import PinGeometry, RobotModel
from cellc.robot.planning.problem import Array
from cellc.robot.planning.scene import LinkPair, broad_phase, ordered, shape_links


def draw_configurations(model: RobotModel, *, samples: int, rng_seed: int) -> Array:
    """Draw configurations uniformly within the URDF's position limits; mimic joints follow.

    A continuous joint is drawn within one turn. Python's own generator is used: its sequence of ``random()`` is the
    same on every version and platform.

    Returns:
        An array of shape (samples, nq), each row a configuration of pinocchio.
    """
    generator = random.Random(rng_seed)
    rows: Array = np.tile(np.asarray(pinocchio.neutral(model.kinematics), dtype=np.float64), (samples, 1))
    drawn: dict[str, Array] = {}
    for joint in model.joints:
        lower, upper = _range(model, joint)
        shares = np.array([generator.random() for _ in range(samples)])
        drawn[joint] = lower + shares * (upper - lower)
        _set(model, rows, joint, drawn[joint])
    for mimic in model.mimics:
        _set(model, rows, mimic.joint, mimic.multiplier * drawn[mimic.leader] + mimic.offset)
    return rows


def meetings(model: RobotModel, pairs: Iterable[LinkPair], *, samples: int, rng_seed: int) -> dict[LinkPair, int]:
    """Count in how many configurations each of some pairs touches, but for those that touch with all joints at zero.

    Args:
        pairs: names of links that have shapes; others are left out.
    """
    shaped = set(shape_links(model))
    asked = {ordered(*pair) for pair in pairs if shaped.issuperset(pair)}
    check = PairCheck(model, asked)
    asked -= check.all_touching(np.asarray(pinocchio.neutral(model.kinematics), dtype=np.float64))
    counts = dict.fromkeys(sorted(asked), 0)
    for configuration in draw_configurations(model, samples=samples, rng_seed=rng_seed) if asked else ():
        for pair in check.all_touching(configuration) & asked:
            counts[pair] += 1
    return counts


def _range(model: RobotModel, joint: str) -> tuple[float, float]:
    index = model.joint_of(joint)
    if model.kinematics.nqs[index] == 1:
        at = model.kinematics.idx_qs[index]
        lower, upper = float(model.kinematics.lowerPositionLimit[at]), float(model.kinematics.upperPositionLimit[at])
        if math.isfinite(lower) and math.isfinite(upper):
            return lower, upper
    return -math.pi, math.pi


def _set(model: RobotModel, rows: Array, joint: str, positions: Array) -> None:
    index = model.kinematics.getJointId(joint)
    at = model.kinematics.idx_qs[index]
    if model.kinematics.nqs[index] == 2:  # a continuous joint is cosine and sine in pinocchio
        rows[:, at], rows[:, at + 1] = np.cos(positions), np.sin(positions)
    else:
        rows[:, at] = positions


class PairCheck:
    """Collision checks of pairs of links, those on one rigid body included."""

    def __init__(self, model: RobotModel, pairs: Iterable[LinkPair], *, margin_m: float = 0.0) -> None:
        """Bind the pairs.

        Args:
            pairs: link names in alphabetical order within each pair.
            margin_m: shapes nearer than this count as touching.
        """
        self._model = model.kinematics
        self._data = model.scratch
        self._geometry, links = _shapes_of(model, set(pairs))
        self._geometry_data = self._geometry.createData()
        for request in self._geometry_data.collisionRequests:
            request.security_margin = margin_m
        self._manager = broad_phase(model, self._geometry, self._geometry_data)
        # Asked for each pair at each sample: fetching the result again takes six times as long as reading it.
        results = list(self._geometry_data.collisionResults)
        self._active: dict[LinkPair, list[tuple[int, Any]]] = {pair: [] for pair in links}
        for index, (pair, result) in enumerate(zip(links, results, strict=True)):
            self._active[pair].append((index, result))

    def some_touching(self, configuration: Array) -> set[LinkPair]:
        """Return at least one pair that touches; empty where none does.

        The caller drops the returned pairs before the next call: a pair that this search did not reach keeps its answer
        for an earlier configuration, which was "no".
        """
        touches = pinocchio.computeCollisions(self._model, self._data, self._manager, configuration, True)
        return self._touching() if touches else set()

    def all_touching(self, configuration: Array) -> set[LinkPair]:
        """Return all pairs that touch."""
        pinocchio.computeCollisions(self._model, self._data, self._geometry, self._geometry_data, configuration, False)
        return self._touching()

    def drop(self, pairs: Iterable[LinkPair]) -> None:
        """Check these pairs no more."""
        for pair in pairs:
            for index, _ in self._active.pop(pair):
                self._geometry_data.deactivateCollisionPair(index)

    def _touching(self) -> set[LinkPair]:
        return {pair for pair, results in self._active.items() if any(result.isCollision() for _, result in results)}


def _shapes_of(model: RobotModel, wanted: set[LinkPair]) -> tuple[PinGeometry, list[LinkPair]]:
    """Return the shapes that the wanted pairs have, with these pairs, and the names of each pair in its order."""
    concerned = {name for pair in wanted for name in pair}
    shapes = [
        (name, shape)
        for name, shape in zip(shape_links(model), model.geometry.geometryObjects, strict=True)
        if name in concerned
    ]
    geometry = pinocchio.GeometryModel()
    for _, shape in shapes:
        geometry.addGeometryObject(shape)
    names = [name for name, _ in shapes]
    asked = [ordered(here, there) in wanted for here in names for there in names]
    geometry.setCollisionPairs(np.array(asked, dtype=np.bool_).reshape(len(names), len(names)))
    return geometry, [ordered(names[pair.first], names[pair.second]) for pair in geometry.collisionPairs]


@dataclass(frozen=True, slots=True, eq=False)
class _Ball:
    """What holds a shape in the frame of a joint, whatever the joints below it do; meters."""

    joint: int
    center: Array
    radius: float


def beyond_reach(model: RobotModel, *, margin_m: float) -> set[LinkPair]:
    """Return the pairs of links on different moving bodies that always stay farther apart than a margin in meters."""
    names, bodies = shape_links(model), [int(shape.parentJoint) for shape in model.geometry.geometryObjects]
    balls = [{ball.joint: ball for ball in _balls(model, shape)} for shape in model.geometry.geometryObjects]
    near: set[LinkPair] = set()
    far: set[LinkPair] = set()
    for second, name in enumerate(names):
        for first, other in enumerate(names[:second]):
            if bodies[first] == bodies[second]:
                continue
            pair = ordered(name, other)
            (far if _apart(balls[first], balls[second], margin_m) else near).add(pair)
    return far - near


def _apart(first: dict[int, _Ball], second: dict[int, _Ball], margin_m: float) -> bool:
    joint = next(joint for joint in first if joint in second)  # the nearest body that carries both
    distance = math.dist(first[joint].center, second[joint].center)
    return distance > first[joint].radius + second[joint].radius + margin_m


def _balls(model: RobotModel, shape: Any) -> Iterator[_Ball]:
    """Yield the ball of a shape in the frame of its joint, and of each joint above it up to the world."""
    geometry, placement, joint = shape.geometry, shape.placement, int(shape.parentJoint)
    geometry.computeLocalAABB()
    center, radius = np.asarray(placement.act(geometry.aabb_center)), float(geometry.aabb_radius)
    yield _Ball(joint, center, radius)
    while joint != 0:
        # Turned by this joint, the ball sweeps a ball round the joint's origin.
        radius += float(np.linalg.norm(center)) + _travel(model, joint)
        center = np.asarray(model.kinematics.jointPlacements[joint].translation)
        joint = int(model.kinematics.parents[joint])
        yield _Ball(joint, center, radius)


def _travel(model: RobotModel, joint: int) -> float:
    """Return how far the origin of a joint leaves its place, in meters."""
    kind, name = model.kinematics.joints[joint].shortname(), str(model.kinematics.names[joint])
    if "JointModelR" in kind:
        return 0.0
    if "JointModelP" in kind and name in model.joints:  # a follower goes where its leader sends it, limits or not
        at = model.kinematics.idx_qs[joint]
        lower, upper = model.kinematics.lowerPositionLimit[at], model.kinematics.upperPositionLimit[at]
        return float(max(abs(lower), abs(upper)))
    return math.inf
