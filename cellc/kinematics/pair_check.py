"""Which of many pairs of links touch at a configuration, where pairs drop out as they are decided."""

from __future__ import annotations

from collections.abc import Iterable

import pinocchio

from cellc.kinematics.limits import Array
from cellc.kinematics.model import RobotModel
from cellc.kinematics.scene import LinkPair


class PairCheck:
    """Collision checks of pairs of links, those on one rigid body included."""

    def __init__(self, model: RobotModel, pairs: Iterable[LinkPair], *, margin_m: float = 0.0) -> None:
        """Bind the pairs.

        Args:
            pairs: link names in alphabetical order within each pair.
            margin_m: shapes nearer than this count as touching.
        """
        wanted = set(pairs)
        names = shape_links(model)
        self._model = model.kinematics
        self._data = model.kinematics.createData()
        self._geometry = model.geometry.copy()
        self._geometry.removeAllCollisionPairs()
        self._links: list[LinkPair] = []
        for second, name in enumerate(names):
            for first, other in enumerate(names[:second]):
                pair = (min(name, other), max(name, other))
                if pair in wanted:
                    self._geometry.addCollisionPair(pinocchio.CollisionPair(first, second))
                    self._links.append(pair)
        self._geometry_data = self._geometry.createData()
        for request in self._geometry_data.collisionRequests:
            request.security_margin = margin_m
        self._active = dict.fromkeys(range(len(self._links)))

    def some_touching(self, configuration: Array) -> set[LinkPair]:
        """Return at least one pair that touches; empty where none does."""
        return self._touching() if self._compute(configuration, stop_at_first=True) else set()

    def all_touching(self, configuration: Array) -> set[LinkPair]:
        """Return all pairs that touch."""
        self._compute(configuration, stop_at_first=False)
        return self._touching()

    def drop(self, pairs: set[LinkPair]) -> None:
        """Check these pairs no more."""
        for index in [index for index in self._active if self._links[index] in pairs]:
            self._geometry_data.deactivateCollisionPair(index)
            del self._active[index]

    def _compute(self, configuration: Array, *, stop_at_first: bool) -> bool:
        return bool(
            pinocchio.computeCollisions(
                self._model, self._data, self._geometry, self._geometry_data, configuration, stop_at_first
            )
        )

    def _touching(self) -> set[LinkPair]:
        # A pair after the first that touched keeps its answer of an earlier configuration, which was "no": callers that
        # stop at the first drop what touches at once.
        results = self._geometry_data.collisionResults
        return {self._links[index] for index in self._active if results[index].isCollision()}


def shape_links(model: RobotModel) -> list[str]:
    """Name the link of each collision shape, in pinocchio's order of shapes."""
    frames = model.kinematics.frames
    return [str(frames[shape.parentFrame].name) for shape in model.geometry.geometryObjects]
