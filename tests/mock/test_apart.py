"""Two arms at the ends of a hall: each is planned by itself, and as if the other were not there."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from cellc.contract.transforms import Pose
from cellc.mock.assemble import _hardware
from cellc.mock.cell import MockCell, load
from cellc.mock.nodes.motion_planner import MotionPlanner
from tests.cells import build_into, written

_READY = "-90 -90 90 -90 -90 0 deg"


def _manager(arm: str) -> dict[str, object]:
    trajectory = {
        "type": "scaled_joint_trajectory", "device": arm, "goal_time": "1 s", "client": "task",
        "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad",
    }  # fmt: skip
    controllers = {f"{arm}_states": {"type": "joint_state_broadcaster"}, f"{arm}_trajectory": trajectory}
    return {"update_rate": "500 Hz", "namespace": f"/{arm}", "controllers": controllers}


def _arm(at: str) -> dict[str, object]:
    limits = {"velocity": "50 %", "acceleration": "50 %"}
    return {"model": "ur5e", "mount": {"parent": "world", "xyz": at}, "limits": limits}


def _built(folder: Path, apart: str) -> Path:
    spec = {
        "format": 1,
        "cell": "hall",
        "versions": {"ros": "jazzy"},
        "hosts": {"pc": {"scheduling": "preempt_rt"}},
        "devices": {"one": _arm("0 0 0 m"), "two": _arm(apart)},
        "scene": {"floor": {"parent": "world", "xyz": "4 0 -0.1 m", "box": "12 3 0.1 m"}},
        "nodes": {"task": {"run": "tasks/node", "host": "pc", "owner": "team"}},
        "managers": {f"{arm}_loop": _manager(arm) for arm in ("one", "two")},
        "motion": {
            "groups": {arm: {"base": f"{arm}/base_link", "tip": f"{arm}/tool0"} for arm in ("one", "two")},
            "poses": {"both": {"one": _READY, "two": _READY}, "second": {"two": "-90 -80 80 -90 -90 0 deg"}},
        },
        "rehearsals": {"all": {"steps": [{"move": "both", "together": True}, {"move": "second"}]}},
    }
    return build_into(folder / "built", written(folder, yaml.safe_dump(spec, sort_keys=False)))


@pytest.fixture(name="hall", scope="module")
def hall_fixture(tmp_path_factory: pytest.TempPathFactory) -> MockCell:
    return load(_built(tmp_path_factory.mktemp("hall"), "8 0 0 m"))


def test_each_part_has_its_arm_and_the_floor(hall: MockCell) -> None:
    assert hall.contract.parts == (("floor", "one"), ("floor", "two"))
    model = hall._memory.model
    arms = [{link.partition("_")[0] for link in part.robot.links} for part in model.parts]
    assert arms == [{"world", "floor", "one"}, {"world", "floor", "two"}]
    assert [len(part.robot.joints) for part in model.parts] == [6, 6]


def test_arms_that_can_meet_are_one_part(tmp_path: Path) -> None:
    built = load(_built(tmp_path, "1.2 0 0 m"))
    assert built.contract.parts == ()
    assert [len(part.robot.joints) for part in built._memory.model.parts] == [12]
    assert '"parts"' not in (tmp_path / "built" / "contract.json").read_text(encoding="utf-8")


def test_rehearsal_of_both_ends_as_it_should(hall: MockCell) -> None:
    result = hall.run("all")
    assert result.outcome == "succeeded"
    assert result == hall.run("all")


def test_manager_of_one_arm_reads_of_no_joint_of_the_other(hall: MockCell) -> None:
    read = {
        name: [component.name for component in _hardware(hall.folder, manager)]
        for name, manager in hall.contract.managers.items()
    }
    assert read == {"one_loop": ["one_hardware"], "two_loop": ["two_hardware"]}


def test_part_in_hand_is_in_the_scene_of_its_arm_alone(hall: MockCell) -> None:
    planner = MotionPlanner(hall._memory, 0)
    joints = dict.fromkeys((joint for part in hall._memory.model.parts for joint in part.robot.joints), -1.0)
    planner.attach("part", "one_tool0", Pose((0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0)), joints)
    assert [len(state.boxes) for state in planner._scenes.values()] == [1, 0]
    planner.detach("part")
    assert [len(state.boxes) for state in planner._scenes.values()] == [0, 0]
