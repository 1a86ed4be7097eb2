"""The pairs of links of a cell that need no collision check, for the SRDF, the contract and the rules."""

from __future__ import annotations

from cellc.feasibility.answers import DisabledAnswer, DisabledLinks
from cellc.feasibility.question import shapes_and_joints
from cellc.feasibility.touching_links import touching_links
from cellc.graph.cell_graph import CellGraph
from cellc.store.cache import recall

SAMPLES = 10_000
"""As many as MoveIt's Setup Assistant draws by default; fewer where many robots share a cell."""
LEAST_SAMPLES = 500
_PAIRS_TIMES_SAMPLES = 2_000_000
RNG_SEED = 0
MARGIN_M = 0.005
"""Two links that come nearer than this in any sample stay checked, so that no near miss passes for "never"."""


def disabled_links(graph: CellGraph) -> DisabledAnswer:
    """Return the pairs with their reasons.

    Where the planner refuses the description, because it names a mesh that is not here for instance, these are the
    pairs that follow from the tree alone.
    """
    return graph.once(_of_cell)


def disabled_in(urdf: str) -> DisabledAnswer:
    """Return the pairs of a robot description, kept from an earlier run or sampled now."""
    return recall("disabled", urdf, DisabledAnswer, lambda: _sampled(urdf))


def _of_cell(graph: CellGraph) -> DisabledAnswer:
    answer = disabled_in(shapes_and_joints(graph.cell))
    if not answer.refused:
        return answer
    found = (
        DisabledLinks(min(first, second), max(first, second), reason.lower())
        for first, second, reason in touching_links(graph.cell)
    )
    return DisabledAnswer(tuple(sorted(found)), 0, answer.refused)


def _sampled(urdf: str) -> DisabledAnswer:
    from cellc.planning import CollisionScene, ModelError, RobotModel, beyond_reach, disabled_collisions

    try:
        robot = RobotModel.from_urdf(urdf)
    except ModelError as error:
        return DisabledAnswer((), 0, str(error))
    checked = len(set(CollisionScene(robot).checked_pairs()) - beyond_reach(robot, margin_m=MARGIN_M))
    samples = min(SAMPLES, max(LEAST_SAMPLES, _PAIRS_TIMES_SAMPLES // max(1, checked)))
    pairs = disabled_collisions(robot, samples=samples, rng_seed=RNG_SEED, margin_m=MARGIN_M)
    links = tuple(DisabledLinks(pair.first, pair.second, pair.reason.value) for pair in pairs)
    return DisabledAnswer(links, samples)
