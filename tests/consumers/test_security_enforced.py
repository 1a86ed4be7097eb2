"""The emitted policy enforced for real: keys of sros2, real processes, and a middleware that refuses what is denied.

Skipped where the installed middleware cannot: wheels of rclpy carry one that is built without DDS security.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.consumers.enforcing import (
    StandIns,
    Started,
    enforced,
    make_keystore,
    on_loopback,
    stand_ins,
    why_not,
    without,
    world,
)
from tests.consumers.matrix import build
from tests.consumers.permissions import policy_text
from tests.consumers.starting import launched

CELL, _DISTRO = "ur5e_pick", "kilted"  # the distribution of the wheels
_HOME = f"/{CELL}"
_MISSING = {
    f"{_HOME}/perception": (("publish", "/object_pose"), ("subscribe", "/camera/color/image_raw")),
    f"{_HOME}/controller_manager": (
        ("reply", "/controller_manager/switch_controller"),
        ("execute", "/gripper_action/gripper_cmd"),
    ),
}
"""Rights that the second keystore lacks."""
_ENOUGH = 60  # messages, at 20 Hz


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder for keystores, where the installed middleware can enforce one."""
    folder = tmp_path_factory.mktemp("enforced")
    if reason := why_not(folder / "probe"):
        pytest.skip(reason)
    return folder


@pytest.fixture(scope="module")
def keystore(folder: Path) -> Path:
    texts = build(CELL, _DISTRO).texts
    return make_keystore(folder / "whole", texts["security/policy.xml"], texts["security/common.xml"])


@dataclass(frozen=True)
class Rehearsed:
    """What came of a cell whose processes, but for what asks for motion, stand in for themselves."""

    stand_ins: dict[str, Started]
    bring_up: subprocess.CompletedProcess[str]
    first_goal: subprocess.CompletedProcess[str]


@pytest.fixture(scope="module")
def rehearsed(folder: Path, keystore: Path) -> Rehearsed:
    """Run the generated programs beside stand-ins, each in its enclave."""
    built = build(CELL, _DISTRO)
    for name, text in built.texts.items():
        (folder / "package" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "package" / name).write_text(text, encoding="utf-8")

    def run(program: str, *words: str) -> subprocess.CompletedProcess[str]:
        command, place = [sys.executable, f"scripts/{program}", *words], folder / "package"
        return subprocess.run(command, env=enforced(keystore), cwd=place, capture_output=True, text=True)

    (goal,) = launched(built, "goal", confirm_goal="I_HAVE_PASSED_GATES_G0_TO_G6", joint="arm_wrist_3_joint").processes
    with StandIns(enforced(keystore)) as started:
        homes = {home: nodes for home, nodes in stand_ins(built).items() if home != f"{_HOME}/task"}
        begun = {home: started.start(home, *nodes, **world(built)) for home, nodes in homes.items()}
        for one in begun.values():
            one.opened()
        plan = ("--plan", "config/bring_up.json", "--target", "mock")
        brought_up = run("bring_up", *plan, "start", "activate", "claim")
        sent = run("first_goal", *goal.arguments, "--ros-args", *goal.ros_arguments)
        return Rehearsed({home: one.met() for home, one in begun.items()}, brought_up, sent)


def test_every_process_of_the_cell_starts_in_its_enclave_and_hears_the_others(rehearsed: Rehearsed) -> None:
    assert {home: one.refused for home, one in rehearsed.stand_ins.items() if one.refused} == {}
    assert len(rehearsed.stand_ins) > 6
    for home, topic in (("perception", "/camera/color/image_raw"), ("move_group", "/joint_states")):
        assert rehearsed.stand_ins[f"{_HOME}/{home}"].heard[topic] > 0


def test_the_bring_up_takes_every_step_of_the_mock(rehearsed: Rehearsed) -> None:
    assert rehearsed.bring_up.returncode == 0, rehearsed.bring_up.stdout + rehearsed.bring_up.stderr[-2000:]
    assert "claim_control done" in rehearsed.bring_up.stdout


def test_the_first_goal_ends_at_the_controller(rehearsed: Rehearsed) -> None:
    assert rehearsed.first_goal.returncode == 0, rehearsed.first_goal.stdout + rehearsed.first_goal.stderr[-2000:]
    assert "status 4" in rehearsed.first_goal.stdout  # action_msgs/msg/GoalStatus: succeeded


def test_a_node_is_refused_just_what_its_policy_lacks(folder: Path) -> None:
    built = build(CELL, _DISTRO)
    policy, nodes = policy_text(built.texts), stand_ins(built)
    for home, rights in _MISSING.items():
        for right, name in rights:
            policy = without(policy, home, right, name)
    with StandIns(enforced(make_keystore(folder / "less", policy))) as started:
        for home, rights in _MISSING.items():
            one = started.start(home, *nodes[home]).opened().met()
            refused = {name for _, name, _ in one.refused}
            assert {name.partition("/_action/")[0] for name in refused} == {name for _, name in rights}
            assert "topic not found in allow rule" in one.said
            assert all("create" in message for *_, message in one.refused)


_JOINTS, _IMAGE = ("/joint_states", "sensor_msgs/msg/JointState"), ("/camera/color/image_raw", "sensor_msgs/msg/Image")


def test_who_has_no_enclave_does_not_start_and_neither_is_heard_nor_hears(keystore: Path) -> None:
    says = {"name": "says", "ends": [("publish", *_IMAGE)]}
    hears = {"name": "_ros2cli_1", "ends": [("subscribe", *_JOINTS), ("subscribe", *_IMAGE)]}
    broadcaster = {"name": "joint_states", "ends": [("publish", *_JOINTS)]}
    with StandIns(enforced(keystore)) as inside, StandIns(on_loopback()) as outside:
        ((_, _, message),) = inside.start(f"{_HOME}/stranger", broadcaster).opened().refused
        assert "SECURITY ERROR" in message
        speakers = outside.start("/", says), inside.start(f"{_HOME}/controller_manager", broadcaster)
        assert [speaker.opened().refused for speaker in speakers] == [[], []]
        without_keys = outside.start("/", hears, until={_IMAGE[0]: _ENOUGH})
        with_keys = inside.start(f"{_HOME}/people", hears, until={_JOINTS[0]: _ENOUGH})
        # Each hears its own side for seconds, and nothing of the other.
        assert set(with_keys.opened().met(closed=False).heard) == {_JOINTS[0]}
        assert set(without_keys.opened().met(closed=False).heard) == {_IMAGE[0]}
