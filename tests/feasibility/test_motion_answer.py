"""Answers about poses and goals against figures worked out by hand, in a cell whose arm is a chain of 0.8 m."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from cellc.compiler.feasibility import MotionAnswer, disabled_links, motion_answer
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.pipeline import check, compile_cell
from cellc.contract.limits import DEFAULTS, in_force
from tests.cells import CORPUS, graph_of, written

DEVICES = CORPUS / "invalid" / "base"
_BAR = '<collision><origin xyz="0.2 0 0"/><geometry><box size="0.38 0.04 0.04"/></geometry></collision>'
_LIMIT = '<limit lower="-3" upper="3" velocity="1" effort="1"/>'
ARM = f"""<robot name="bars">
  <link name="base"/>
  <link name="upper">{_BAR}</link>
  <link name="lower">{_BAR}</link>
  <link name="hand"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="one" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>{_LIMIT}</joint>
  <joint name="two" type="revolute">
    <parent link="upper"/><child link="lower"/><origin xyz="0.4 0 0"/><axis xyz="0 0 1"/>{_LIMIT}</joint>
  <joint name="three" type="revolute">
    <parent link="lower"/><child link="hand"/><origin xyz="0.4 0 0"/><axis xyz="0 0 1"/>{_LIMIT}</joint>
</robot>"""


def _graph(folder: Path, **sections: object) -> CellGraph:
    shutil.copytree(DEVICES / "stage", folder / "bars")
    (folder / "bars" / "stage.urdf").write_text(ARM)
    device = yaml.safe_load((folder / "bars" / "device.yaml").read_text())
    device["limits"] = {kind: {"*": each["turn"]} for kind, each in device["limits"].items()}
    (folder / "bars" / "device.yaml").write_text(yaml.safe_dump(device))
    spec = {
        "format": 1,
        "cell": "flat",
        "versions": {"ros": "jazzy"},
        "devices": {"arm": {"model": "./bars", "mount": {"parent": "world"}}},
        "motion": {"groups": {"bars": {"base": "arm/base", "tip": "arm/hand"}}},
        **sections,
    }
    return graph_of(written(folder, yaml.safe_dump(spec, sort_keys=False)))


def _motion(**parts: object) -> dict[str, object]:
    return {"groups": {"bars": {"base": "arm/base", "tip": "arm/hand"}}, **parts}


def _answer(folder: Path, **sections: object) -> MotionAnswer:
    answer = motion_answer(_graph(folder, **sections))
    assert answer.refused == ""
    return answer


def test_box_on_a_bar_is_touched_and_box_beside_it_is_not(tmp_path: Path) -> None:
    # Stretched along x the bars reach from y = -0.02 to 0.02 m.
    scene = {
        "on": {"parent": "world", "xyz": "600 0 0 mm", "box": "20 20 20 mm"},
        "beside": {"parent": "world", "xyz": "600 40 0 mm", "box": "20 20 20 mm"},
    }
    poses = {"stretched": {"bars": "0 0 0 deg"}, "away": {"bars": "90 0 0 deg"}}
    answer = _answer(tmp_path, scene=scene, motion=_motion(poses=poses))
    touched = {pose.name: [(c.first, c.second) for c in pose.contacts] for pose in answer.poses}
    assert touched == {"stretched": [("arm_lower", "on")], "away": []}


def test_folded_hand_touches_the_first_bar(tmp_path: Path) -> None:
    # With the elbow at 171 degrees the middle of the hand is 0.4 * sin 9 deg = 63 mm beside the first bar: less than
    # the 20 mm that the bar and the 50 mm that the hand is wide to that side. At 150 degrees it is 200 mm.
    poses = {"folded": {"bars": "0 171 0 deg"}, "bent": {"bars": "0 150 0 deg"}}
    folded, bent = _answer(tmp_path, motion=_motion(poses=poses)).poses
    assert [(contact.first, contact.second) for contact in folded.contacts] == [("arm_hand", "arm_upper")]
    assert bent.contacts == ()


@pytest.mark.parametrize(
    ("x_mm", "reached"), [(500, True), (790, True), (810, False)], ids=["inside", "just inside", "outside"]
)
def test_stretched_length_bounds_the_reach(tmp_path: Path, x_mm: int, reached: bool) -> None:
    frames = {"spot": {"parent": "world", "xyz": f"{x_mm} 0 0 mm", "designed": True}}
    answer = _answer(tmp_path, frames=frames, motion=_motion(goals={"go": {"frame": "spot"}}))
    (goal,) = answer.goals
    assert goal.failure == ("" if reached else "no_ik_solution")


def test_goal_in_a_frame_that_moves_is_not_asked(tmp_path: Path) -> None:
    answer = _answer(tmp_path, motion=_motion(goals={"go": {"frame": "arm/lower"}}))
    assert answer.goals == ()


def test_no_group_asks_nothing(tmp_path: Path) -> None:
    assert motion_answer(_graph(tmp_path, motion={})) == MotionAnswer()


def test_pairs_of_a_cell_are_neighbours_alone_where_all_else_can_meet(tmp_path: Path) -> None:
    pairs = {(pair.first, pair.second): pair.reason for pair in disabled_links(_graph(tmp_path)).pairs}
    assert pairs["arm_lower", "arm_upper"] == "adjacent"
    assert pairs["arm_hand", "arm_lower"] == "adjacent"
    assert len(pairs) == 2  # the hand meets the upper bar where the arm is folded


def test_poses_and_goals_are_answered_without_sampling_the_pairs_that_never_touch(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("pairs are sampled where no artifact asks for them")

    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    monkeypatch.setattr("cellc.compiler.feasibility.compute.disabled_collisions", refuse)
    graph = _graph(tmp_path, motion=_motion(poses={"folded": {"bars": "0 171 0 deg"}}))
    assert [len(pose.contacts) for pose in motion_answer(graph).poses] == [1]
    with pytest.raises(AssertionError):
        disabled_links(graph)


def test_what_takes_too_long_is_refused_and_asked_again_the_next_time(tmp_path: Path) -> None:
    motion = _motion(poses={"stretched": {"bars": "0 0 0 deg"}})
    graph = _graph(tmp_path, motion=motion)
    with in_force(replace(DEFAULTS, planning_seconds=0)):
        answer = motion_answer(graph)
    assert (answer.limit, answer.poses) == ("planning-seconds", ())
    assert [pose.name for pose in motion_answer(graph_of(tmp_path / "cell.yaml")).poses] == ["stretched"]


def test_no_artifact_rests_on_pairs_that_took_too_long_to_find(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    file = CORPUS.parents[1] / "cells" / "minimal" / "cell.yaml"
    checked = check(file)
    with in_force(replace(DEFAULTS, planning_seconds=0)):
        assert checked.graph is not None
        assert disabled_links(checked.graph).limit == "planning-seconds"
        compiled = compile_cell(checked)
    assert (compiled.value, [found.code for found in compiled.diagnostics]) == (None, ["geometry-too-large"])


@pytest.mark.parametrize(
    ("most", "refused"),
    [
        # Two bars, the hand and two boxes are 5 shapes: 4 + 3 + 2 + 1 pairs.
        (10, ""),
        (9, "the 5 collision shapes make 10 pairs, and must make at most 9"),
    ],
)
def test_pairs_of_shapes_are_bounded(most: int, refused: str, tmp_path: Path) -> None:
    box = {"parent": "world", "box": "20 20 20 mm"}
    scene = {"near": {**box, "xyz": "600 300 0 mm"}, "far": {**box, "xyz": "600 600 0 mm"}}
    graph = _graph(tmp_path, scene=scene, motion=_motion(poses={"stretched": {"bars": "0 0 0 deg"}}))
    with in_force(replace(DEFAULTS, robot_pairs=most)):
        motion, disabled = motion_answer(graph), disabled_links(graph)
    assert (motion.refused, disabled.refused) == (refused, refused)
    assert (motion.limit, disabled.limit) == (("robot-pairs",) * 2 if refused else ("", ""))
    assert [pose.name for pose in motion.poses] == ([] if refused else ["stretched"])
