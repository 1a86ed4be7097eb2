"""Groups of a pose that move at once: both arms turn at one instant, and motions that would meet are refused."""

from __future__ import annotations

import numpy as np
import pytest

from cellc.mock import MockCell, load
from cellc.mock.plant import Plant
from cellc.robot.planning import PlanFailure
from tests.cells import ROOT


@pytest.fixture(name="cell", scope="module")
def cell_fixture() -> MockCell:
    """Return the cell of two arms on one column."""
    return load(ROOT / "generated/openarm_bimanual")


def _seen(cell: MockCell) -> Plant:
    plants: list[Plant] = []
    result = cell.rehearse(cell.entry("both_reach"), watch=plants.append)
    assert result.passed
    both = [attempt for attempt in result.attempts if attempt.step.startswith("move together")]
    assert [one.controller_name for one in both] == ["left_trajectory and right_trajectory"] * 6
    return plants[0]


def test_both_arms_turn_at_one_instant(cell: MockCell) -> None:
    (history,) = _seen(cell).control.histories.values()
    seconds = np.diff(history.stamps) / 1e9
    speeds = np.abs(np.diff(history.positions, axis=0)) / seconds[:, None]
    arms = [[history.names.index(f"openarm_{side}_joint{n}") for n in range(1, 8)] for side in ("left", "right")]
    left, right = (speeds[:, columns].max(axis=1) > 0.05 for columns in arms)
    assert left.any()
    # Poses are mirrored, plans are not, so that one arm may be there first; one after another they would share nothing.
    assert (left & right).sum() > 0.75 * (left | right).sum()


def test_motions_that_would_meet_are_refused_with_the_time(cell: MockCell) -> None:
    plant = _seen(cell)
    positions, planner = plant.world.joint_positions(plant.now_ns), plant.planner
    across, reach = (-90.0, -10.0, 80.0, 90.0, 0.0, 0.0, 0.0), (-25.0, -10.0, 0.0, 90.0, 0.0, 0.0, 0.0)
    motions = {}
    for name, degrees in (("across", across), ("clear", reach)):
        for group, side in (("left_arm", 1.0), ("right_arm", -1.0)):
            signs = (side, side, side, 1.0, 1.0, 1.0, 1.0)
            goal = tuple(np.radians(value) * sign for value, sign in zip(degrees, signs, strict=True))
            planned = planner.plan(group, positions, goal, None)
            assert not isinstance(planned, PlanFailure), planned
            motions[name, group] = planned.trajectory
    clear = [motions["clear", group] for group in ("left_arm", "right_arm")]
    meeting = [motions["across", group] for group in ("left_arm", "right_arm")]
    assert planner.meeting(clear, positions) is None
    refused = planner.meeting(meeting, positions)
    assert refused is not None
    assert "groups that move together touch" in refused.detail
