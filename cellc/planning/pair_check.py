"""Which of many pairs of links touch at a configuration, where pairs drop out as they are decided."""

from __future__ import annotations

from collections.abc import Iterable

import pinocchio

from cellc.planning.limits import Array
from cellc.planning.model import RobotModel
from cellc.planning.shapes import LinkPair, shape_links


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
        # A tree of bounding boxes: without it the time grows with the square of the number of shapes.
        self._manager = pinocchio.BroadPhaseManager_DynamicAABBTreeCollisionManager(
            self._model, self._geometry, self._geometry_data
        )
        self._active: dict[LinkPair, list[int]] = {pair: [] for pair in wanted}
        for index, pair in enumerate(self._links):
            self._active[pair].append(index)

    def some_touching(self, configuration: Array) -> set[LinkPair]:
        """Return at least one pair that touches; empty where none does.

        Whoever asks drops what is returned before asking again: a pair that the search did not come to keeps its answer
        of an earlier configuration, which was "no" then.
        """
        found = pinocchio.computeCollisions(self._model, self._data, self._manager, configuration, True)
        return self._touching() if found else set()

    def all_touching(self, configuration: Array) -> set[LinkPair]:
        """Return all pairs that touch."""
        pinocchio.computeCollisions(self._model, self._data, self._geometry, self._geometry_data, configuration, False)
        return self._touching()

    def drop(self, pairs: Iterable[LinkPair]) -> None:
        """Check these pairs no more."""
        for pair in pairs:
            for index in self._active.pop(pair):
                self._geometry_data.deactivateCollisionPair(index)

    def _touching(self) -> set[LinkPair]:
        results = self._geometry_data.collisionResults
        return {pair for pair, indices in self._active.items() if any(results[at].isCollision() for at in indices)}
