"""Names of the topics of a bag where several managers have controllers of one name."""

from __future__ import annotations

import re

import pytest

from cellc.contract.contract import Contract
from cellc.mock.evidence.topics import controller_state_topic, goal_topic, joint_states_topic
from tests.emit.cells import emitted
from tests.emit.test_several_managers import SPEC

# rmw/validate_full_topic_name.c: absolute, no empty part, no number at the start of one, no slash at the end.
_LEGAL = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")


@pytest.fixture(scope="module")
def contract(tmp_path_factory: pytest.TempPathFactory) -> Contract:
    """Two arms under a manager each, whose controllers have the same names."""
    return Contract.model_validate_json(emitted(tmp_path_factory.mktemp("cell"), SPEC)["contract.json"])


def test_controllers_of_one_name_have_topics_of_their_own_that_ros_accepts(contract: Contract) -> None:
    told = [(name, key) for name, manager in contract.managers.items() for key in manager.controllers]
    states = [controller_state_topic(contract, *finding).name for finding in told if finding[1].endswith("trajectory")]
    goals = [goal_topic(key, gripper=False).name for _, key in told if key.endswith("trajectory")]
    assert states == ["/left/trajectory/controller_state", "/right/trajectory/controller_state"]
    assert goals == ["/cellc/left/trajectory/goal", "/cellc/right/trajectory/goal"]
    joints = [joint_states_topic(contract, *finding).name for finding in told]
    assert all(_LEGAL.fullmatch(name) for name in (*states, *goals, *joints))


def test_controller_that_no_other_manager_has_keeps_its_short_name() -> None:
    assert goal_topic("arm_trajectory", gripper=False).name == "/cellc/arm_trajectory/goal"


def test_states_of_two_managers_that_meet_on_one_topic_stand_there(contract: Contract) -> None:
    keys = [(name, key) for name, one in contract.managers.items() for key in one.controllers if "states" in key]
    assert [joint_states_topic(contract, *key).name for key in keys] == ["/joint_states"] * 2
