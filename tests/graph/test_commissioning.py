"""Caps of planned motion: bounds by hand and by an independent dynamics library, and the share that keeps a speed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pinocchio
import pytest

from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.graph.commissioning import chain_of, stages, tip_bounds, tip_in_base
from tests.cells import built, graph_of, linked, spec_of, spec_text, written

WHOLE = "commissioning: {velocity: 100 %, acceleration: 100 %}"
# Universal Robots, DH parameters of the UR5e: lengths of a2, a3, d4, d5 and d6, m.
A2, A3, D4, D5, D6 = 0.425, 0.3922, 0.1333, 0.0997, 0.0996


def commissioned(folder: Path, stated: str, cell: str = "ur5e_pick") -> CellGraph:
    """Return a cell with other caps."""
    text = spec_text(cell)
    assert text.count(WHOLE) == 1
    return graph_of(written(folder, text.replace(WHOLE, f"commissioning: {stated}")))


def test_arms_of_a_ur5e_are_the_lengths_of_its_links() -> None:
    graph = graph_of(spec_of("minimal"))
    wrist, fore, upper = D6 + D5, D6 + D5 + math.hypot(A3, D4), D6 + D5 + math.hypot(A3, D4) + A2
    chain = chain_of(graph, graph.cell.groups[0])
    assert [*chain.arms.values()] == pytest.approx([0.0, D6, wrist, fore, upper, upper], abs=1e-3)
    # 180 deg/s at every joint.
    assert tip_bounds(graph)["manipulator"] == pytest.approx(math.pi * (D6 + wrist + fore + 2 * upper), abs=5e-3)


@pytest.mark.parametrize("cell", ["ur5e_pick", "rail_arm", "fr3_hand", "openarm_bimanual"])
def test_no_posture_gives_a_tip_more_than_the_bound(cell: str) -> None:
    graph = graph_of(spec_of(cell))
    model = pinocchio.buildModelFromXML(built(cell).texts[f"urdf/{cell}.real.urdf"])
    data, draw, limits = model.createData(), np.random.default_rng(0), graph.cell.devices
    velocities = {joint.name: joint.velocity or 0.0 for device in limits for joint in device.joints}
    for group in graph.cell.groups:
        tip, fastest = model.getFrameId(group.tip_frame), 0.0
        columns = [(model.joints[model.getJointId(name)].idx_v, velocities[name]) for name in group.joints]
        for _ in range(400):
            posture = pinocchio.randomConfiguration(model, *_within(model))
            frame = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
            whole = pinocchio.computeFrameJacobian(model, data, posture, tip, frame)[:3]
            signs = draw.choice([-1.0, 1.0], (64, len(columns)))
            speeds = signs * [velocity for _, velocity in columns] @ whole[:, [column for column, _ in columns]].T
            fastest = max(fastest, float(np.linalg.norm(speeds, axis=1).max()))
        assert fastest <= tip_bounds(graph)[group.name]
        assert fastest >= 0.4 * tip_bounds(graph)[group.name]  # a bound of any size would pass otherwise


def _within(model: pinocchio.Model) -> tuple[np.ndarray, np.ndarray]:
    # Joints that turn without end have a cosine and a sine for a position.
    return np.maximum(model.lowerPositionLimit, -7.0), np.minimum(model.upperPositionLimit, 7.0)


def test_tip_is_where_an_independent_library_has_it() -> None:
    graph = graph_of(spec_of("fr3_hand"))
    model = pinocchio.buildModelFromXML(built("fr3_hand").texts["urdf/fr3_hand.real.urdf"])
    data, (group, *_) = model.createData(), graph.cell.groups
    positions = dict(zip(group.joints, (0.1, -0.5, 0.3, -2.0, 0.2, 1.5, 0.7), strict=True))
    posture = pinocchio.neutral(model)
    for name, value in positions.items():
        posture[model.joints[model.getJointId(name)].idx_q] = value
    pinocchio.framesForwardKinematics(model, data, posture)
    base, tip = (data.oMf[model.getFrameId(name)] for name in (group.base_link, group.tip_frame))
    found = tip_in_base(graph, group, positions)
    assert found is not None
    assert found.position == pytest.approx(tuple((base.inverse() * tip).translation), abs=1e-9)


def test_share_of_a_stage_is_of_the_limits_of_the_cell(tmp_path: Path) -> None:
    first, *_, last = stages(commissioned(tmp_path, "{velocity: 80 %, acceleration: 40 %, stages: 5 100 %}"))
    # The cell has half of 180 deg/s and of 5 rad/s^2.
    assert (first.percent, last.percent) == ("5", "100")
    elbow = first.joints["arm_elbow_joint"]
    assert (elbow.velocity, elbow.acceleration) == pytest.approx((math.radians(90.0) * 0.04, 2.5 * 0.02))
    elbow = last.joints["arm_elbow_joint"]
    assert (elbow.velocity, elbow.acceleration) == pytest.approx((math.radians(90.0) * 0.8, 2.5 * 0.4))


def test_speed_of_the_tip_leaves_the_joints_what_no_path_exceeds(tmp_path: Path) -> None:
    graph = commissioned(tmp_path, "{velocity: 250 mm/s, acceleration: 50 %}")
    (group,) = graph.cell.groups
    arms = chain_of(graph, group).arms
    for stage, share in zip(stages(graph), (0.1, 0.25, 0.5, 1.0), strict=True):
        fastest = sum((stage.joints[name].velocity or 0.0) * arm for name, arm in arms.items())
        assert fastest == pytest.approx(share * 0.25)
        assert stage.tips == pytest.approx({"manipulator": share * 0.25})
        assert stage.joints["gripper_robotiq_85_left_knuckle_joint"].velocity == pytest.approx(share * 0.5)


def test_caps_are_a_part_of_the_configuration(tmp_path: Path) -> None:
    graphs = [commissioned(tmp_path, f"{{velocity: {share} %, acceleration: 100 %}}") for share in (50, 60)]
    assert linked(spec_of("ur5e_pick")).bringup.caps != graphs[0].cell.bringup.caps
    assert graphs[0].cell.bringup != graphs[1].cell.bringup
