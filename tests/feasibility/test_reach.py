"""What a joint can move where: balls worked out by hand, held by postures drawn at random, and the parts of a cell."""

from __future__ import annotations

import math
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from cellc.compiler.feasibility import DisabledAnswer, MotionAnswer, disabled_links, feasibility, motion_answer
from cellc.compiler.feasibility.parts import parts_of
from cellc.compiler.feasibility.question import shapes_and_joints
from cellc.compiler.feasibility.reach import SLACK_M, Ball, reach_of, swept
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.contract.limits import DEFAULTS, in_force
from cellc.robot.planning import RobotModel
from tests.cells import EVERY_CELL, ROOT, graph_of, written
from tests.feasibility.test_motion_answer import ARM, DEVICES
from tests.properties import given, settings, st

_STILL = "0 0 0 m"


def _device(folder: Path, name: str, urdf: str) -> str:
    """Write a device of a description whose joints are named ``turn…`` and ``slide…``."""
    shutil.copytree(DEVICES / "stage", folder / name)
    (folder / name / "stage.urdf").write_text(urdf)
    device = yaml.safe_load((folder / name / "device.yaml").read_text())
    joints = re.findall('joint name="((turn|slide)\\w*)"', urdf)
    device["limits"] = {kind: {joint: each[like] for joint, like in joints} for kind, each in device["limits"].items()}
    (folder / name / "device.yaml").write_text(yaml.safe_dump(device))
    return f"./{name}"


def _cell(folder: Path, devices: dict[str, tuple[str, str]], **sections: object) -> CellGraph:
    """Write a cell of devices, each with its model and its place in the world."""
    spec = {
        "format": 1,
        "cell": "hall",
        "versions": {"ros": "jazzy"},
        "devices": {
            name: {"model": model, "mount": {"parent": "world", "xyz": at}} for name, (model, at) in devices.items()
        },
        **sections,
    }
    return graph_of(written(folder, yaml.safe_dump(spec, sort_keys=False)))


def _joint(name: str, kind: str, parent: str, child: str, rest: str) -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{rest}</joint>'


def _chain(*joints: str) -> str:
    links = sorted({"base", *re.findall(r'(?:parent|child) link="(\w+)"', "".join(joints))})
    return f'<robot name="chain">{"".join(f"""<link name="{link}"/>""" for link in links)}{"".join(joints)}</robot>'


def _swept(folder: Path, urdf: str, frame: str, ball: Ball) -> Ball:
    graph = _cell(folder, {"one": (_device(folder, "chain", urdf), _STILL)})
    return swept(graph, frame, ball)


_LIMIT = '<limit lower="{}" upper="{}" velocity="1" effort="1"/>'


def test_chain_of_two_bars_reaches_as_far_as_both_are_long(tmp_path: Path) -> None:
    # The hand, a cube of 0.1 m, turns at the end of two bars of 0.4 m, all about z.
    urdf = ARM.replace('joint name="', 'joint name="turn_')
    corner = 0.05 * math.sqrt(3.0)
    ball = _swept(tmp_path, urdf, "one_hand", Ball((0.0, 0.0, 0.0), corner))
    assert ball.center == pytest.approx((0.0, 0.0, 0.0))
    assert ball.radius == pytest.approx(0.8 + corner)


def test_ball_beside_an_axis_turns_about_it_and_stays_at_its_height(tmp_path: Path) -> None:
    urdf = _chain(_joint("turn", "revolute", "base", "arm", '<axis xyz="0 0 2"/>' + _LIMIT.format(-0.1, 0.1)))
    ball = _swept(tmp_path, urdf, "one_arm", Ball((0.3, 0.4, 0.2), 0.05))
    assert ball.center == pytest.approx((0.0, 0.0, 0.2))
    assert ball.radius == pytest.approx(0.5 + 0.05)


def test_joint_without_end_turns_as_one_with_ends(tmp_path: Path) -> None:
    urdf = _chain(_joint("turn", "continuous", "base", "arm", '<axis xyz="1 0 0"/>'))
    ball = _swept(tmp_path, urdf, "one_arm", Ball((0.3, 0.4, 0.0), 0.05))
    assert ball.center == pytest.approx((0.3, 0.0, 0.0))
    assert ball.radius == pytest.approx(0.4 + 0.05)


def test_rail_pushes_a_ball_from_end_to_end(tmp_path: Path) -> None:
    # From x = -1 to 3 m: the middle is at 1 m, half of the way is 2 m.
    urdf = _chain(_joint("slide", "prismatic", "base", "car", '<axis xyz="1 0 0"/>' + _LIMIT.format(-1, 3)))
    ball = _swept(tmp_path, urdf, "one_car", Ball((0.0, 0.0, 0.2), 0.1))
    assert ball.center == pytest.approx((1.0, 0.0, 0.2))
    assert ball.radius == pytest.approx(2.0 + 0.1 + SLACK_M)


def test_finger_that_follows_goes_where_its_leader_sends_it(tmp_path: Path) -> None:
    # At 0.1 m where the leader is at 0, at -2 * 0.04 + 0.1 = 0.02 m where it is at its end: whatever its own limits.
    follows = '<axis xyz="0 1 0"/><mimic joint="slide_a" multiplier="-2" offset="0.1"/>'
    urdf = _chain(
        _joint("slide_a", "prismatic", "base", "left", '<axis xyz="0 1 0"/>' + _LIMIT.format(0, 0.04)),
        _joint("slide_b", "prismatic", "base", "right", follows + _LIMIT.format(0, 0.01)),
    )
    ball = _swept(tmp_path, urdf, "one_right", Ball((0.0, 0.0, 0.0), 0.01))
    assert ball.center == pytest.approx((0.0, 0.06, 0.0))
    assert ball.radius == pytest.approx(0.04 + 0.01 + SLACK_M)


def test_finger_of_a_leader_without_end_goes_anywhere(tmp_path: Path) -> None:
    follows = '<axis xyz="0 1 0"/><mimic joint="turn"/>'
    urdf = _chain(
        _joint("turn", "continuous", "base", "crank", '<axis xyz="0 1 0"/>'),
        _joint("slide", "prismatic", "base", "rod", follows + _LIMIT.format(0, 0.01)),
    )
    assert _swept(tmp_path, urdf, "one_rod", Ball((0.0, 0.0, 0.0), 0.01)).radius == math.inf


def _corners(robot: RobotModel) -> Iterator[tuple[str, Any, list[Any]]]:
    """Yield the link of each shape, its ball in the link, and the corners of the box around it, in the link."""
    for shape in robot.geometry.geometryObjects:
        frame = robot.kinematics.frames[shape.parentFrame]
        in_link = frame.placement.actInv(shape.placement)
        shape.geometry.computeLocalAABB()
        low, high = shape.geometry.aabb_local.min_, shape.geometry.aabb_local.max_
        corners = [in_link.act(np.array(corner)) for corner in product(*zip(low, high, strict=True))]
        center = in_link.act(shape.geometry.aabb_center)
        yield str(frame.name), Ball(tuple(center.tolist()), float(shape.geometry.aabb_radius)), corners


@pytest.mark.parametrize("cell", EVERY_CELL)
@given(st.integers(0, 2**32 - 1))
@settings(max_examples=5)
def test_no_corner_of_a_shape_leaves_its_ball_in_any_posture(cell: str, seed: int) -> None:
    graph = graph_of(ROOT / "cells" / cell / "cell.yaml")
    robot = RobotModel.from_urdf(shapes_and_joints(graph))
    generator = np.random.default_rng(seed)
    balls = {link: (swept(graph, link, ball), corners) for link, ball, corners in _corners(robot)}
    ends = {joint.name: (joint.lower, joint.upper) for joint in graph.cell.joints_by_name.values()}
    for _ in range(10):
        drawn = {
            name: float(generator.uniform(-math.pi if lower is None else lower, math.pi if upper is None else upper))
            for name, (lower, upper) in ends.items()
            if name in robot.joints
        }
        for link, (ball, corners) in balls.items():
            pose = robot.link_pose(link, drawn, base_link="world")
            assert max(math.dist(pose.apply(tuple(corner)), ball.center) for corner in corners) <= ball.radius + 1e-9


def _two(folder: Path, apart_m: float, **sections: object) -> CellGraph:
    """Write two arms that turn about z; each reaches 0.8 m with its hand, and holds parts within 0.15 m of it."""
    model = _device(folder, "bars", ARM.replace('joint name="', 'joint name="turn_'))
    motion: dict[str, object] = {
        "groups": {name: {"base": f"{name}/base", "tip": f"{name}/hand"} for name in ("one", "two")},
        "poses": {"out": {"one": "0 0 0 deg", "two": "0 0 0 deg"}, "folded": {"two": "0 171 0 deg"}},
        "goals": {"near": {"group": "two", "frame": "spot"}},
    }
    frames = {"spot": {"parent": "world", "xyz": f"{apart_m} 0.6 0 m", "designed": True}}
    given: dict[str, Any] = {"motion": motion, "frames": frames, **sections}
    return _cell(folder, {"one": (model, _STILL), "two": (model, f"{apart_m} 0 0 m")}, **given)


@pytest.mark.parametrize(("apart_m", "parts"), [(1.90, 1), (1.91, 2)])
def test_arms_are_apart_where_their_balls_and_the_margin_are(apart_m: float, parts: int, tmp_path: Path) -> None:
    # Twice 0.8 + 0.15 m are 1.9 m, and two shapes within 5 mm count as touching.
    assert len(parts_of(_two(tmp_path, apart_m))) == parts


def _box(xyz: str, size: str) -> dict[str, str]:
    return {"parent": "world", "xyz": xyz, "box": size}


_SCENE = {
    "floor": _box("1.5 0 -0.2 m", "6 4 0.1 m"),  # under both arms, and under the posts
    "at_one": _box("0 0.5 0 m", "50 50 50 mm"),
    "post": _box("1.5 1.7 0 m", "0.1 0.1 0.3 m"),  # stands on the floor, out of reach
    "beam": _box("1.5 1.7 0.2 m", "0.2 0.2 0.1 m"),  # lies on the post
    "far": _box("1.5 -1.8 0 m", "50 50 50 mm"),
}


def test_part_has_what_its_arm_reaches_and_a_floor_is_in_both(tmp_path: Path) -> None:
    parts = parts_of(_two(tmp_path, 3.0, scene=_SCENE))
    assert [[box.name for box in part.cell.scene] for part in parts] == [["floor", "at_one"], ["floor"]]
    assert [[device.name for device in part.cell.devices] for part in parts] == [["one"], ["two"]]


def test_things_out_of_reach_are_looked_at_where_they_touch(tmp_path: Path) -> None:
    graph = _two(tmp_path, 3.0, scene=_SCENE)
    assert graph.once(reach_of).standing == (("beam", "post"), ("floor", "post"))
    reasons = {(pair.first, pair.second): pair.reason for pair in disabled_links(graph).pairs}
    assert reasons["beam", "post"] == reasons["floor", "post"] == "always"
    assert {("beam", "post"), ("floor", "post")} <= {(one.first, one.second) for one in motion_answer(graph).rigid}


def _answers(graph: CellGraph) -> tuple[MotionAnswer, DisabledAnswer]:
    return motion_answer(graph), disabled_links(graph)


def test_parts_say_of_a_cell_what_the_whole_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    graph = _two(tmp_path, 3.0, scene=_SCENE)
    assert len(parts_of(graph)) == 2
    cut = _answers(graph)
    monkeypatch.setattr(feasibility, "parts_of", lambda graph: (graph,))
    whole = _answers(graph_of(tmp_path / "cell.yaml"))
    assert replace(cut[0], rigid=()) == replace(whole[0], rigid=())
    assert [goal.failure for goal in cut[0].goals] == [""]
    assert set(cut[0].rigid) == set(whole[0].rigid)
    both = {frozenset((pair.first, pair.second)): pair.reason for pair in whole[1].pairs}
    left = {frozenset((pair.first, pair.second)): pair.reason for pair in cut[1].pairs}
    assert left.items() <= both.items()
    assert {both[pair] for pair in both.keys() - left.keys()} == {"never"}


def test_pose_of_one_part_has_what_touches_in_the_others_where_they_begin(tmp_path: Path) -> None:
    # At zero the bars of the first arm lie along x, through the box.
    graph = _two(tmp_path, 3.0, scene={"through": _box("0.6 0 0 m", "50 50 50 mm")})
    touched = {pose.name: [(one.first, one.second) for one in pose.contacts] for pose in motion_answer(graph).poses}
    assert touched == {
        "out": [("one_lower", "through")],
        "folded": [("one_lower", "through"), ("two_hand", "two_upper")],
    }


def test_pairs_of_a_part_are_bounded_and_those_of_two_parts_are_no_pairs(tmp_path: Path) -> None:
    # Each arm has three shapes and so three pairs; together they are six shapes and fifteen pairs.
    with in_force(replace(DEFAULTS, robot_pairs=3)):
        assert [answer.refused for answer in _answers(_two(tmp_path, 3.0))] == ["", ""]
    with in_force(replace(DEFAULTS, robot_pairs=2)):
        answer = motion_answer(graph_of(tmp_path / "cell.yaml"))
    assert (answer.refused, answer.limit) == (
        "the 3 collision shapes make 3 pairs, and must make at most 2",
        "robot-pairs",
    )
