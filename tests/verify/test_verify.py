"""Foreign parsers read back what was built, and what they say reaches nobody past a finding."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from cellc.compiler.graph.cell_graph import build_graph
from cellc.compiler.graph.frame_tree import FrameTree
from cellc.compiler.verify import verify
from cellc.compiler.verify.disagreement import Disagreement
from cellc.compiler.verify.meant import cell_poses
from cellc.compiler.verify.parsers import read_by_pinocchio, read_by_yourdfpy
from cellc.contract.codes import STAGES
from cellc.contract.transforms import Pose, apart, from_xyz_rpy, identity
from tests.cells import CELLS, ROOT, built


def found_in(edits: dict[str, tuple[str, str]], cell: str = "ur5e_pick") -> set[tuple[str, str]]:
    """Return code and artifact of what is found once a pattern was replaced in artifacts whose name ends so."""
    build = built(cell)
    edited = []
    for artifact in build.artifacts:
        pattern, new = next((edits[end] for end in edits if artifact.path.endswith(end)), ("", ""))
        text = re.sub(pattern, new, artifact.text, count=1) if pattern else artifact.text
        assert not pattern or text != artifact.text
        edited.append(replace(artifact, text=text))
    diagnostics = verify(edited, build.graph)
    assert all(d.span == build.graph.cell.locate("cell") for d in diagnostics)
    assert all("bug of cellc" in d.message and "\n" not in d.message for d in diagnostics)
    return {(d.code, d.message.split("`")[1]) for d in diagnostics}


@pytest.mark.parametrize("cell", CELLS)
def test_cells_of_the_repository_have_nothing_to_report(cell: str) -> None:
    assert verify(built(cell).artifacts, built(cell).graph) == ()


MOCK, SCENE = "urdf/ur5e_pick.mock.urdf", "sim/scene.xml"
FAULTS = [
    ({".mock.urdf": ('xyz="0 0 0.8"', 'xyz="0 0 0.801"')}, "verify-frames", MOCK),
    ({".mock.urdf": ('rpy="[^"]*"/>\n    <parent link="arm_tool0"', 'rpy="0 0 0"/>\n    <parent link="arm_tool0"')},
     "verify-frames", MOCK),
    ({".mock.urdf": ('<link name="tcp"/>', '<link name="tpc"/>')}, "verify-urdf", MOCK),
    ({".mock.urdf": ('<joint name="arm_elbow_joint" type="revolute">', '<joint name="arm_elbow_joint" type="fixed">')},
     "verify-joints", MOCK),
    ({".mock.urdf": ('velocity="', 'velocity="1')}, "verify-joints", MOCK),
    ({".mock.urdf": (' lower="', ' lower="-1" was="')}, "verify-joints", MOCK),
    ({".mock.urdf": ("</robot>", "")}, "verify-text", MOCK),
    ({"config/controllers.yaml": ("update_rate: ", "update_rate: [")}, "verify-text", "config/controllers.yaml"),
    ({"package.xml": ("<name>", "<nam>")}, "verify-text", "package.xml"),
    ({"config/cell.rviz": ("Tools:", "Tools: [")}, "verify-text", "config/cell.rviz"),
    ({"contract.json": ('"root_frame": "world"', '"root_frame": 5')}, "verify-json", "contract.json"),
    ({"contract.json": ('"root_frame": "world",', '"root_frame": "world", "x": 1,')}, "verify-json", "contract.json"),
    ({"contract.json": (r'"update_rate_hz": [\d.]+', '"update_rate_hz": NaN')}, "verify-json", "contract.json"),
    ({"contract.json": (MOCK, "urdf/none.urdf")}, "verify-json", "contract.json"),
    ({"manifest.json": ('"cfg-', '"cfg-0')}, "verify-json", "manifest.json"),
    ({SCENE: ('pos="0 0 0.8"', 'pos="0 0 0.801"')}, "verify-scene", SCENE),
    ({SCENE: ('<site name="tcp"', '<site name="tpc"')}, "verify-scene", SCENE),
    ({SCENE: (' range="-6.28', ' range="-6.27')}, "verify-scene", SCENE),
    ({SCENE: ('actuatorfrcrange="-150 150"', 'actuatorfrcrange="-151 151"')}, "verify-scene", SCENE),
    ({SCENE: ('<joint name="arm_elbow_joint"', '<joint name="arm_elbow"')}, "verify-scene", SCENE),
    ({SCENE: ('type="hinge"', 'type="hinged"')}, "verify-scene", SCENE),
    ({"rehearsals.json": ('"format": 2', '"format": 1')}, "verify-json", "rehearsals.json"),
    ({"manifest.json": ('"format": 1', '"format": 2')}, "verify-json", "manifest.json"),
]  # fmt: skip


@pytest.mark.parametrize(("edits", "code", "path"), FAULTS)
def test_fault_in_an_artifact_is_found(edits: dict[str, tuple[str, str]], code: str, path: str) -> None:
    assert found_in(edits) == {(code, path)}


def test_turned_axis_is_found_though_poses_at_zero_agree() -> None:
    # At zero an axis does not show; both parsers must be asked away from it, and the cell's joints say nothing of axes.
    artifacts = built("ur5e_pick").artifacts
    urdf = next(artifact.text for artifact in artifacts if artifact.path == MOCK)
    ours, positions = read_by_yourdfpy(urdf)
    turned = re.sub(r'(<joint name="arm_elbow_joint".*?<axis xyz=")0 0 1"', r'\g<1>0 0 -1"', urdf, flags=re.DOTALL)
    assert turned != urdf
    theirs = read_by_pinocchio(turned, positions)
    assert apart(ours.at_zero["tcp"], theirs.at_zero["tcp"])[0] < 1e-9
    assert apart(ours.displaced["tcp"], theirs.displaced["tcp"])[0] > 0.01


def test_pose_of_the_cell_is_the_one_calculated_by_hand() -> None:
    # UR5e at zero, DH parameters of its maker in m: a2 -0.425, a3 -0.3922, d1 0.1625, d4 0.1333, d5 0.0997, d6 0.0996.
    # The base_link of the description is turned half round z against the base of the table, hence the signs; the arm
    # stands 0.8 m high.
    graph = built("ur5e_pick").graph
    x, y, z = cell_poses(graph.frames)["arm_tool0"].position
    assert (x, y, z) == pytest.approx((0.425 + 0.3922, 0.1333 + 0.0996, 0.8 + 0.1625 - 0.0997), abs=1e-9)


def test_frame_below_a_dynamic_edge_has_no_pose() -> None:
    graph = built("ur5e_pick").graph
    assert "object" not in cell_poses(graph.frames)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.3, 3.0])
def test_distance_of_two_poses_is_exact_for_small_and_large_angles(angle: float) -> None:
    turned = from_xyz_rpy((3.0, 4.0, 0.0), (0.0, angle, 0.0))
    meters, radians = apart(identity(), turned)
    assert meters == pytest.approx(5.0)
    assert radians == pytest.approx(angle, rel=1e-6, abs=1e-15)


def test_quaternion_and_its_negative_are_no_distance_apart() -> None:
    turned = from_xyz_rpy((0.0, 0.0, 0.0), (0.1, 0.2, math.pi))
    x, y, z, w = turned.quaternion
    assert apart(turned, replace(turned, quaternion=(-x, -y, -z, -w)))[1] < 1e-12


def test_every_code_is_found_by_a_fault_here() -> None:
    assert set(STAGES["verify"]) == {code for _, code, _ in FAULTS}


def test_check_of_a_cell_does_not_import_foreign_parsers(tmp_path: Path) -> None:
    program = (
        "import sys, json\nfrom cellc.compiler.pipeline import check\n"
        f"check({str(ROOT / 'cells/minimal/cell.yaml')!r})\n"
        "print(json.dumps([name for name in ('pinocchio', 'yourdfpy', 'scipy', 'jsonschema') if name in sys.modules]))"
    )
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path), "CELLC_NO_CACHE": ""}
    first, second = (
        json.loads(
            subprocess.run(
                [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT, env=environment
            ).stdout
        )
        for _ in range(2)
    )
    # pinocchio answers what is feasible; its answers are kept, and then it is not asked.
    assert first == ["pinocchio"]
    assert second == []


def test_parsers_are_asked_once_about_the_same_bytes_and_the_same_meaning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    answers = iter([[], [Disagreement("verify-urdf", MOCK, "is refused")], [], []])
    asked: list[list[Disagreement]] = []

    def answer(*_: object) -> list[Disagreement]:
        asked.append(next(answers))
        return asked[-1]

    monkeypatch.setattr("cellc.compiler.verify.read_back.read_back", answer)
    artifacts, graph = built("ur5e_pick").artifacts, built("ur5e_pick").graph
    assert (verify(artifacts, graph), verify(artifacts, graph), len(asked)) == ((), (), 1)
    # Another byte; a disagreement is not kept, so that nobody has to clear a cache to be rid of it.
    edited = (*artifacts[:-1], replace(artifacts[-1], text=f"{artifacts[-1].text}\n"))
    assert [len(verify(edited, graph)) for _ in range(3)] == [1, 0, 0]
    assert len(asked) == 3
    # The same bytes of a cell that means something else.
    arm = graph.cell.devices[0]
    raised = replace(arm, joints=(replace(arm.joints[0], velocity=7.0), *arm.joints[1:]))
    other = build_graph(replace(graph.cell, devices=(raised, *graph.cell.devices[1:])))
    assert (verify(artifacts, other), len(asked)) == ((), 4)


def test_what_was_hidden_can_be_imported_after_a_verification() -> None:
    program = (
        "import sys\nfrom cellc.compiler.verify.parsers import import_yourdfpy\nimport_yourdfpy()\n"
        "assert not {'scipy', 'networkx', 'PIL', 'shapely'} & set(sys.modules)\n"
        "import PIL.Image, networkx, scipy.spatial, shapely"
    )
    subprocess.run([sys.executable, "-c", program], check=True, cwd=ROOT)


def test_a_long_chain_of_frames_is_walked_once(monkeypatch: pytest.MonkeyPatch) -> None:
    step = from_xyz_rpy((0.0, 0.0, 0.001), (0.0, 0.0, 0.0))
    graph = built("minimal").graph
    fixed = next(frame for frame in graph.cell.frames if frame.transform_to_parent is not None)
    names = ["world", *(f"f{number}" for number in range(500))]
    chain = [replace(fixed, name=name, parent=above, transform_to_parent=step) for above, name in pairwise(names)]
    root = replace(fixed, name="world", parent="")
    frames = FrameTree({frame.name: (frame,) for frame in (*reversed(chain), root)})
    products: list[None] = []
    product = Pose.__matmul__

    def counted(one: Pose, other: Pose) -> Pose:
        products.append(None)
        return product(one, other)

    monkeypatch.setattr(Pose, "__matmul__", counted)
    poses = cell_poses(frames)
    assert poses["f499"].position == pytest.approx((0.0, 0.0, 0.5))
    assert len(products) == 500


MIMICS_NOTHING = """\
<robot name="r"><link name="a"/><link name="b"/>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/><mimic joint="nothing"/></joint></robot>
"""


def test_yourdfpy_prints_nothing() -> None:
    # In a process of its own: pytest listens to loggers, and then Python prints none of them.
    program = f"from cellc.compiler.verify.parsers import read_by_yourdfpy; read_by_yourdfpy({MIMICS_NOTHING!r})"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "", "")
