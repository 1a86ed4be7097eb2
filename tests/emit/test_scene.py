"""``sim/scene.xml`` loaded by MuJoCo, and held against pinocchio and figures by hand."""

from __future__ import annotations

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
import pytest

from cellc.compiler.formats.mjcf.elements import inertial, is_possible, placement
from cellc.contract.transforms import Pose, from_xyz_rpy, identity
from cellc.robot.description.model import Inertial
from tests.cells import EVERY_CELL, ROOT, built, spec_text
from tests.emit.cells import emitted
from tests.link.test_packages import CELL, CUBE, DEVICE
from tests.scene import FREE, SCENE, Described, loaded, place, text_of

every_cell = pytest.mark.parametrize("cell", EVERY_CELL)


def _element(cell: str, path: str) -> ElementTree.Element:
    found = ElementTree.fromstring(text_of(cell)).find(path)
    assert found is not None
    return found


@every_cell
def test_all_frames_are_where_pinocchio_has_them_in_a_hundred_configurations(cell: str) -> None:
    described, model = Described(cell), loaded(text_of(cell))
    data, generator = mujoco.MjData(model), np.random.default_rng(20261129)
    frames = set(described.robot.links) - {"world"}
    assert frames <= {model.site(index).name for index in range(model.nsite)}
    worst = 0.0
    for _ in range(100):
        positions = described.drawn(generator)
        place(model, data, described.followers(positions))
        for name, (position, rotation) in described.poses(positions).items():
            if name in frames:
                site = data.site(name)
                worst = max(worst, float(np.abs(site.xpos - position).max()))
                worst = max(worst, float(np.abs(site.xmat.reshape(3, 3) - rotation).max()))
    assert worst < 1e-9


@every_cell
def test_every_body_has_the_mass_and_the_tensor_of_its_link(cell: str) -> None:
    model = loaded(text_of(cell))
    total = 0.0
    for device in built(cell).graph.cell.devices:
        for link in device.body.description.links:
            if link.inertial is None:
                continue
            body, stated = model.body(link.name), link.inertial
            total += stated.mass
            assert body.mass[0] == stated.mass
            assert body.ipos == pytest.approx(stated.pose.position, abs=1e-12)
            turn = np.zeros(9)
            mujoco.mju_quat2Mat(turn, body.iquat)
            axes = turn.reshape(3, 3)
            assert axes @ np.diag(body.inertia) @ axes.T == pytest.approx(_tensor(stated), abs=1e-12)
    parts = [model.body(part).mass[0] for part in _parts(model)]
    assert model.body_mass.sum() == pytest.approx(total + sum(parts), rel=1e-12)


def _tensor(stated: Inertial) -> Any:
    x, y, z, w = stated.pose.quaternion
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, np.array([w, x, y, z]))
    axes = turn.reshape(3, 3)
    own = [
        [stated.ixx, stated.ixy, stated.ixz],
        [stated.ixy, stated.iyy, stated.iyz],
        [stated.ixz, stated.iyz, stated.izz],
    ]
    return axes @ np.array(own) @ axes.T


def _parts(model: Any) -> list[str]:
    free = (index for index in range(model.njnt) if model.jnt_type[index] == FREE)
    return [model.body(model.jnt_bodyid[index]).name for index in free]


def test_tensor_in_other_axes_is_turned_and_one_of_no_body_is_not_written() -> None:
    body = Inertial(from_xyz_rpy((0.1, 0.0, 0.0), (0.3, -0.2, 1.1)), 2.0, 0.02, 0.001, -0.002, 0.03, 0.003, 0.04)
    root = ElementTree.Element("mujoco")
    ElementTree.SubElement(root, "compiler", {"inertiafromgeom": "false"})
    world = ElementTree.SubElement(root, "worldbody")
    ElementTree.SubElement(world, "body", {"name": "one"}).append(inertial(body))
    read = loaded(ElementTree.tostring(root, "unicode")).body("one")
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, read.iquat)
    axes = turn.reshape(3, 3)
    assert axes @ np.diag(read.inertia) @ axes.T == pytest.approx(_tensor(body), abs=1e-12)
    assert is_possible(body)
    assert not is_possible(replace(body, mass=0.0))
    assert not is_possible(replace(body, ixx=-0.02))
    assert not is_possible(replace(body, ixy=0.025))
    assert "diaginertia" in inertial(replace(body, ixy=0.025)).attrib  # a ball in its place


def test_pose_is_written_with_the_real_part_first_and_without_what_is_zero() -> None:
    assert placement(identity()) == {}
    assert placement(Pose((1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))) == {"pos": "1 0 0"}
    assert placement(Pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))) == {"quat": "0 1 0 0"}
    assert placement(Pose((0.0, 0.0, 0.0), (0.0, 0.0, -0.6, -0.8))) == {"quat": "0.8 0 0 0.6"}


def test_a_point_ahead_of_an_optical_frame_is_in_the_middle_of_the_picture() -> None:
    # REP 103: z of an optical frame looks ahead, x to the right of the picture and y down.
    model = loaded(text_of("ur5e_pick"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for name, vertical in (("camera_color_optical_frame", 42.0), ("camera_depth_optical_frame", 58.0)):
        camera, site = data.cam(name), data.site(name)
        assert camera.xpos == pytest.approx(site.xpos, abs=1e-12)
        assert model.cam(name).fovy[0] == vertical
        assert model.cam_resolution[model.cam(name).id].tolist() == [640, 480]
        ahead, right, below = (
            _pixel(model, data, name, site.xpos + site.xmat.reshape(3, 3) @ np.array(point))
            for point in ((0.0, 0.0, 0.5), (0.1, 0.0, 0.5), (0.0, 0.5 * math.tan(math.radians(vertical / 2.0)), 0.5))
        )
        assert ahead == pytest.approx((320.0, 240.0), abs=1e-9)
        assert right[0] > 320.0
        assert below == pytest.approx((320.0, 480.0), abs=1e-6)


def _pixel(model: Any, data: Any, camera: str, point: Any) -> tuple[float, float]:
    """Return where a point is in a picture of 640 by 480, as MuJoCo defines its cameras: -z ahead, y up."""
    x, y, z = data.cam(camera).xmat.reshape(3, 3).T @ (point - data.cam(camera).xpos)
    assert z < 0.0
    focal = 240.0 / math.tan(math.radians(model.cam(camera).fovy[0]) / 2.0)
    return 320.0 + focal * x / -z, 240.0 - focal * y / -z


@every_cell
def test_keyframes_put_the_tips_where_the_plan_has_them(cell: str) -> None:
    described, model, known = Described(cell), loaded(text_of(cell)), built(cell).graph.cell
    data = mujoco.MjData(model)
    names = [model.key(index).name for index in range(model.nkey)]
    assert names[0] in ("home", "start")
    assert set(names) == {names[0], *(pose.name for pose in known.poses)}
    for pose in known.poses:
        (group,) = (group for group in known.groups if group.name == pose.group)
        mujoco.mj_resetDataKeyframe(model, data, names.index(pose.name))
        mujoco.mj_kinematics(model, data)
        others = {joint: described.robot.rest_of(joint) for joint in described.robot.joints}
        placed = others | {joint: float(data.joint(joint).qpos[0]) for joint in described.robot.joints}
        assert placed == pytest.approx(placed | dict(zip(pose.joints, pose.positions, strict=True)), abs=1e-12)
        position, rotation = described.poses(placed)[group.tip_frame]
        assert data.site(group.tip_frame).xpos == pytest.approx(position, abs=1e-9)
        assert data.site(group.tip_frame).xmat.reshape(3, 3) == pytest.approx(rotation, abs=1e-9)
        commanded = {model.actuator(index).name: value for index, value in enumerate(data.ctrl)}
        assert commanded == {name: pytest.approx(placed[name], abs=1e-12) for name in commanded}


@every_cell
def test_cell_stands_still_where_it_begins_and_nothing_touches_but_parts_at_rest(cell: str) -> None:
    model = loaded(text_of(cell))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    free = {int(model.jnt_bodyid[index]) for index in range(model.njnt) if model.jnt_type[index] == FREE}
    touching = [{int(model.geom_bodyid[geom]) for geom in contact.geom} for contact in data.contact]
    assert all(free & pair for pair in touching)
    lies = {body: data.xpos[body].copy() for body in free}
    begun = {model.joint(index).name: model.key_qpos[0][model.jnt_qposadr[index]] for index in range(model.njnt)}
    for _ in range(1500):
        mujoco.mj_step(model, data)
    assert data.warning.number.sum() == 0
    assert float(np.abs(data.qvel).max()) < 1e-4
    for body, at in lies.items():
        assert data.xpos[body] == pytest.approx(at, abs=1e-6)  # it neither falls onto what it rests on nor out of it
    moved = [index for index in range(model.njnt) if model.jnt_type[index] != FREE]
    for index in moved:
        joint = model.joint(index)
        assert data.joint(joint.name).qpos[0] == pytest.approx(begun[joint.name], abs=3e-3)


def test_a_free_part_rests_on_its_table() -> None:
    model = loaded(text_of("ur5e_pick"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(1500):
        mujoco.mj_step(model, data)
    x, y, z = data.body("object").xpos
    assert (x, y) == pytest.approx((0.45, -0.15), abs=1e-4)  # fixture A, and 250 mm from it
    assert z == pytest.approx(0.85, abs=1e-6)  # where it began: its frame is 50 mm above the table
    touching = {model.body(model.geom_bodyid[geom]).name for contact in data.contact for geom in contact.geom}
    assert touching == {"object", "table"}
    force = np.zeros(6)
    pressed = 0.0
    for number in range(data.ncon):
        mujoco.mj_contactForce(model, data, number, force)
        pressed += force[0]
    assert pressed == pytest.approx(0.2 * 9.81, rel=1e-3)


def test_actuators_are_the_law_of_the_real_target() -> None:
    # cells/openarm_bimanual: impedance of the arms as the spec states it, and gravity on the springs alone.
    joint = _element("openarm_bimanual", "actuator/position[@joint='openarm_left_joint5']")
    assert (joint.get("kp"), joint.get("kv"), joint.get("forcerange")) == ("30", "1.5", "-7 7")
    assert "gravcomp=" not in text_of("openarm_bimanual")
    # cells/hybrid_sdk: springs of the adapter, gravity by the robot; the joint has what both give together.
    joint = _element("hybrid_sdk", "actuator/position[@joint='fr3_joint7']")
    assert (joint.get("kp"), joint.get("kv")) == ("50", "15")
    assert _element("hybrid_sdk", ".//joint[@name='fr3_joint7']").get("actuatorgravcomp") == "true"
    assert _element("hybrid_sdk", ".//body[@name='fr3_link7']").get("gravcomp") == "1"
    # A loop of the vendor's own has no figures; the file says what stands in for them.
    joint = _element("ur5e_pick", "actuator/position[@joint='arm_elbow_joint']")
    assert float(joint.get("kv", "")) == pytest.approx(0.02 * float(joint.get("kp", "")), rel=0.01)
    assert "not stated: stiffness of position loops, so 100 rad/s: arm_shoulder_pan_joint," in text_of("ur5e_pick")


def test_what_follows_is_no_actuator_and_an_equality() -> None:
    model = loaded(text_of("gen3_2f"))
    actuated = {model.actuator(index).name for index in range(model.nu)}
    mimics = {m.joint: m for m in Described("gen3_2f").robot.mimics}
    assert len(mimics) == model.neq == 5
    assert actuated.isdisjoint(mimics)
    for index in range(model.neq):
        follower = mimics[model.joint(model.eq_obj1id[index]).name]
        assert model.joint(model.eq_obj2id[index]).name == follower.leader
        assert model.eq_data[index][:5].tolist() == [follower.offset, follower.multiplier, 0.0, 0.0, 0.0]


def test_continuous_joints_have_no_ends_and_pairs_of_the_semantic_description_no_contact() -> None:
    model = loaded(text_of("gen3_2f"))
    assert not model.jnt_limited[model.joint("joint_1").id]
    assert model.jnt_range[model.joint("joint_2").id].tolist() == [-2.24, 2.24]
    semantic = ElementTree.fromstring(built("gen3_2f").texts["config/moveit/gen3_2f.srdf"])
    pairs = {frozenset((pair.attrib["link1"], pair.attrib["link2"])) for pair in semantic.iter("disable_collisions")}
    excluded = ElementTree.fromstring(text_of("gen3_2f")).iter("exclude")
    apart = {pair for pair in pairs if len({int(model.body_weldid[model.body(name).id]) for name in pair}) == 2}
    assert {frozenset((pair.attrib["body1"], pair.attrib["body2"])) for pair in excluded} == apart
    assert len(pairs) > len(apart) > 10


def test_force_sensor_feels_what_hangs_on_its_frame() -> None:
    model = loaded(text_of("ur5e_pick"))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(200):
        mujoco.mj_step(model, data)
    force = data.site("arm_tool0").xmat.reshape(3, 3) @ data.sensor("arm_tcp_fts_sensor_force").data
    tools = [device.body.description.links for device in built("ur5e_pick").graph.cell.devices[1:]]
    mass = sum(link.inertial.mass for links in tools for link in links if link.inertial is not None)
    # Its joints take the weight of the tools, and the flange carries it all the same: what it gives to them points up.
    assert force == pytest.approx((0.0, 0.0, mass * 9.81), abs=1e-3)


def test_scene_is_the_same_under_any_hash_seed() -> None:
    script = (
        "import hashlib; from tests.emit.cells import artifacts_of;"
        f"print(hashlib.sha256(artifacts_of('fr3_hand')['{SCENE}'].encode()).hexdigest())"
    )
    runs = [
        subprocess.run([sys.executable, "-c", script], cwd=ROOT, env={"PYTHONHASHSEED": seed}, capture_output=True)
        for seed in ("1", "4242")
    ]
    assert len(runs[0].stdout) == 65, runs[0].stderr
    assert runs[0].stdout == runs[1].stdout


_HOSTILE = "a\"/><body name='x'>&amp;--&gt;]]>"


def test_a_hostile_name_of_a_mesh_stays_text(tmp_path: Path) -> None:
    shape = '<collision><geometry><mesh filename="{}"/></geometry></collision>'
    escaped = _HOSTILE.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.xacro").write_text(_arm(shape.format(f"package://arm_parts/{escaped}.stl")))
    (tmp_path / "arm" / "device.yaml").write_text(DEVICE)
    text = _scene_of(tmp_path)
    root = ElementTree.fromstring(text, ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True)))
    assert [body.get("name") for body in root.iter("body") if body.get("name") == "x"] == []
    comments = [node.text or "" for node in root.iter() if not isinstance(node.tag, str)]
    assert any("left out: the mesh package://arm_parts/" in comment for comment in comments)
    loaded(text)


def test_meshes_keep_the_names_of_the_description_and_those_not_at_hand_are_left_out(tmp_path: Path) -> None:
    shape = '<collision><geometry><mesh filename="package://arm_parts/{}" scale="1 1 2"/></geometry></collision>'
    (tmp_path / "arm" / "arm_parts").mkdir(parents=True)
    (tmp_path / "arm" / "arm_parts" / "hand.stl").write_text(CUBE)
    (tmp_path / "arm" / "arm.xacro").write_text(_arm(shape.format("hand.stl") + shape.format("gone.stl")))
    (tmp_path / "arm" / "device.yaml").write_text(DEVICE)
    text = _scene_of(tmp_path)
    (mesh,) = ElementTree.fromstring(text).findall("asset/mesh")
    assert mesh.attrib == {
        "name": "mesh_1",
        "file": "package://arm_parts/hand.stl",
        "inertia": "convex",
        "scale": "1 1 2",
    }
    assert "left out: the mesh package://arm_parts/gone.stl" in text
    assert str(tmp_path) not in text
    model = loaded(text)
    assert model.nmesh == 1
    assert model.nbody >= 2


def _arm(shapes: str) -> str:
    return f"""<robot name="arm"><link name="base"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="10"/><dynamics damping="0.5" friction="0.25"/></joint>
<link name="hand">{shapes}</link></robot>"""


def _scene_of(folder: Path) -> str:
    return emitted(folder, CELL.replace("packages: [PLACES]\n", ""))[SCENE]


def test_joint_without_a_mass_gets_one_and_its_own_friction(tmp_path: Path) -> None:
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "arm.xacro").write_text(_arm(""))
    (tmp_path / "arm" / "device.yaml").write_text(DEVICE)
    text = _scene_of(tmp_path)
    model = loaded(text)
    joint = model.joint("arm_turn")
    assert (joint.damping[0], joint.frictionloss[0], joint.armature[0]) == (0.5, 0.25, 0.0)
    assert model.body("arm_hand").mass[0] == 0.001
    assert "no mass is stated, and what moves has one" in text


def test_part_without_a_mass_weighs_as_water_and_the_file_says_so(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace(
        "width: 77 mm, tolerance: 2 mm, mass: 0.2 kg", "width: 77 mm, tolerance: 2 mm"
    )
    written_scene = emitted(tmp_path, text)[SCENE]
    assert loaded(written_scene).body("object").mass[0] == pytest.approx(1000.0 * 0.077**2 * 0.0885, rel=1e-9)
    assert (
        "not stated: its size, so that it rests on what is below it, its mass, as of water, its friction"
        in written_scene
    )


def test_part_with_nothing_below_it_is_a_cube(tmp_path: Path) -> None:
    text = spec_text("ur5e_pick").replace(
        "table: {parent: world, xyz: 350 0 780 mm", "table: {parent: world, xyz: 350 0 480 mm"
    )
    assert "not stated: its size, as a cube of 0.077 m, its friction, 0.5" in emitted(tmp_path, text)[SCENE]


def test_part_is_the_box_that_is_stated_and_its_friction_counts_wherever_it_touches(tmp_path: Path) -> None:
    stated = "width: 77 mm, tolerance: 2 mm, mass: 0.2 kg"
    text = spec_text("ur5e_pick").replace(stated, f"{stated}, size: 40 77 60 mm, friction: 0.8")
    written_scene = emitted(tmp_path, text)[SCENE]
    model = loaded(written_scene)
    body = model.body("object")
    (geom,) = (index for index in range(model.ngeom) if model.geom_bodyid[index] == body.id)
    assert model.geom_size[geom].tolist() == [0.02, 0.0385, 0.03]
    assert model.geom_friction[geom][0] == 0.8
    assert model.geom_priority[geom] > model.geom_priority[: geom - 1].max()
    # 0.2 kg / 12 times the squares of the edges across each axis.
    assert body.inertia == pytest.approx([1.588166666667e-4, 8.6666666667e-5, 1.254833333333e-4], rel=1e-9)
    assert "object is a box of 0.04 by 0.077 by 0.06 m about its frame -->" in written_scene
