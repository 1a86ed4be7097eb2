"""A stage of commissioning on the mock: motion is planned within what the file of the stage says."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
import yaml

from cellc.mock import MockCell, MockError, load
from cellc.mock.cell import cell_of
from cellc.mock.nodes.motion_model import build_motion_model
from cellc.mock.nodes.motion_planner import MotionRequest, PlannedMotion, SceneState, plan_motion
from tests.cells import generated

HOME = tuple(map(math.radians, (0.0, -90.0, 90.0, -90.0, -90.0, 0.0)))
TURN = math.radians(30.0)


@pytest.fixture(scope="module")
def cell() -> MockCell:
    return load(generated("ur5e_pick"))


def turned(cell: MockCell, stage: str) -> PlannedMotion:
    """Plan a turn of the first joint alone."""
    folder = replace(cell.folder, stage=stage)
    model = build_motion_model(
        folder.contract, folder.urdf, folder.description, folder.allowed_collisions, (), folder.capped_by
    )
    others = tuple(
        (name, 0.0)
        for name in sorted(model.parts[0].robot.joints)
        if name not in cell.contract.groups["manipulator"].joints
    )
    goal = (HOME[0] + TURN, *HOME[1:])
    planned = plan_motion(model, MotionRequest("manipulator", HOME, others, SceneState(), goal, None, 0))
    assert isinstance(planned, PlannedMotion)
    return planned


def by_hand(velocity: float, acceleration: float) -> float:
    """Return how long a joint needs from rest to rest without a limit of jerk, s."""
    if velocity**2 / acceleration > TURN:
        return 2.0 * math.sqrt(TURN / acceleration)
    return TURN / velocity + velocity / acceleration


# The cell has 90 deg/s and 2.5 rad/s^2, half of what the catalog has.
@pytest.mark.parametrize(("stage", "share"), [("10", 0.1), ("25", 0.25), ("50", 0.5), ("100", 1.0)])
def test_trajectory_of_a_stage_takes_what_its_limits_take_by_hand(cell: MockCell, stage: str, share: float) -> None:
    velocity, acceleration = math.radians(90.0) * share, 2.5 * share
    points = turned(cell, stage).trajectory.points
    assert max(abs(value) for point in points for value in point.velocities) <= velocity * (1.0 + 1e-6)
    assert max(abs(value) for point in points for value in point.accelerations) <= acceleration * (1.0 + 1e-6)
    took = points[-1].time_from_start_ns / 1e9
    # The jerk of 50 rad/s^3 adds its rise to each change of acceleration.
    assert by_hand(velocity, acceleration) <= took <= by_hand(velocity, acceleration) + 3 * acceleration / 50.0 + 0.02


def test_rehearsal_of_the_first_stage_is_slower_and_says_so(cell: MockCell) -> None:
    slow = load(generated("ur5e_pick"), stage="10")
    fast, slow_run = cell.run("slipped"), slow.run("slipped")
    assert slow_run.outcome == fast.outcome
    assert slow_run.sim_time_s > 2.0 * fast.sim_time_s
    assert not slow_run.edited
    assert slow.notes == ("motion is planned in stage 10 % of commissioning",)
    assert cell.notes == ()


def test_without_a_word_the_last_stage_is_played(cell: MockCell) -> None:
    assert cell.run("slipped") == load(generated("ur5e_pick"), stage="100").run("slipped")


@pytest.mark.parametrize(("name", "known"), [("ur5e_pick", "10, 25, 50, 100"), ("minimal", "none")])
def test_stage_that_is_not_there_is_refused_with_those_that_are(name: str, known: str) -> None:
    with pytest.raises(MockError, match=f"has no stage `75` of commissioning; its stages are: {known}"):
        load(generated(name), stage="75")


def test_file_of_a_stage_counts_not_the_contract(cell: MockCell) -> None:
    told = yaml.safe_load(cell.folder.stages["10"])
    limits = told["/**"]["ros__parameters"]["robot_description_planning"]["joint_limits"]
    assert limits["arm_shoulder_pan_joint"]["max_velocity"] == pytest.approx(math.radians(9.0))
    assert cell.contract.joint_limits["arm_shoulder_pan_joint"].velocity == pytest.approx(math.radians(90.0))


@pytest.mark.parametrize(
    "spoilt", ["max_velocity: -1.0", "max_velocity: fast", "max_velocity: [", "max_velocity: true"]
)
def test_file_that_is_no_stage_is_refused_by_its_name(cell: MockCell, spoilt: str) -> None:
    folder = cell.folder
    text = folder.stages["10"].replace("max_velocity: 0.157079632679", spoilt, 1)
    assert text != folder.stages["10"]
    played = replace(folder, stage="10", stages={**folder.stages, "10": text})
    with pytest.raises(MockError, match=r"^config/commissioning/stage_10.yaml: "):
        cell_of(played)
