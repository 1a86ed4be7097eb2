"""Links whose meshes are not there: the mock runs with the shapes that are, and tells what it did not see."""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from cellc.mock import MockCell, load
from cellc.mock.gates import Verdict, judged_rehearsals
from tests.cells import build_into, compiled, diagnose, written
from tests.cli.run import run
from tests.link.test_packages import CELL, CUBE, DEVICE
from tests.mock.gates.conftest import gate, line

_BOX = '<collision><origin xyz="0.3 0 0"/><geometry><box size="0.4 0.05 0.05"/></geometry></collision>'
_MESH = '<collision><geometry><mesh filename="package://arm_parts/{0}.stl"/></geometry></collision>'
_ARM = f"""<robot name="arm"><link name="base">{_MESH.format("foot")}</link>
<joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="10"/></joint><link name="upper">{_BOX}</link>
<joint name="wrist" type="fixed"><origin xyz="0.5 0 0"/><parent link="upper"/><child link="hand"/></joint>
<link name="hand">{_MESH.format("hand")}</link></robot>"""
_SCENE = "scene: {post: {parent: world, xyz: 0 0.4 0 m, box: 50 50 200 mm}}\n"


@dataclass(frozen=True)
class Built:
    """A generated folder of an arm whose meshes were there as it was built, and are not any more."""

    folder: Path
    spec: Path
    cell: MockCell


@pytest.fixture(name="built", scope="module")
def built_fixture(tmp_path_factory: pytest.TempPathFactory) -> Built:
    root = tmp_path_factory.mktemp("missing")
    (root / "arm" / "arm_parts").mkdir(parents=True)
    for name in ("foot", "hand"):
        (root / "arm" / "arm_parts" / f"{name}.stl").write_text(CUBE)
    (root / "arm" / "arm.xacro").write_text(_ARM)
    (root / "arm" / "device.yaml").write_text(DEVICE)
    spec = written(root, CELL.replace("packages: [PLACES]\n", _SCENE))
    folder = build_into(root / "generated" / "bench", spec)
    shutil.rmtree(root / "arm" / "arm_parts")
    return Built(folder, spec, load(folder))


def test_check_lists_all_that_is_missing_in_one_finding_with_the_links_that_move(built: Built) -> None:
    (found,) = [diagnosis for diagnosis in diagnose(built.spec) if diagnosis.code == "mesh-not-found"]
    assert "`package://arm_parts/foot.stl`" in found.message
    assert "`package://arm_parts/hand.stl`" in found.message
    assert "`arm_base`, `arm_hand`, 1 of which move" in found.message


def test_mock_moves_and_names_once_what_nobody_sees_those_first_that_move(built: Built) -> None:
    result = built.cell.run("wave")
    assert (result.outcome, result.unseen) == ("succeeded", ("arm_base", "arm_hand"))
    (note,) = built.cell.notes
    assert note.endswith("1 that move, `arm_hand`; 1 that do not move, `arm_base`")
    out = run("mock", str(built.folder), "--rehearsal", "wave").out
    assert out.count("these links are not checked for collision") == 1
    assert json.loads(run("mock", str(built.folder), "--rehearsal", "wave", "--json").out)["notes"] == [note]


def test_no_gate_of_collisions_is_passed_where_a_link_was_not_seen(built: Built) -> None:
    run_of = judged_rehearsals(built.cell.entries, [built.cell.run("wave")])
    check = line(gate("G1", built.cell.folder, run_of), "planned free of collision")
    assert check.verdict is Verdict.FAILED
    assert [text for text in check.evidence if text.startswith("arm_hand: its mesh is missing")]


def test_shapes_that_are_there_are_still_seen(built: Built, tmp_path: Path) -> None:
    shutil.copytree(built.spec.parent / "arm", tmp_path / "arm")
    # Turned by 90 degrees, the box of the upper arm, 0.1 to 0.5 m out, lies in the post 0.4 m out.
    text = built.spec.read_text(encoding="utf-8").replace("away: {all: 0.2 rad}", "away: {all: 90 deg}")
    assert "pose-in-collision-with-scene" in {diagnosis.code for diagnosis in diagnose(written(tmp_path, text))}


def test_pairs_of_a_link_without_its_mesh_are_those_of_the_tree(built: Built, tmp_path: Path) -> None:
    # A robot that has the meshes reads the same SRDF: neighbors touch there, whether or not they were seen here.
    shutil.copytree(built.spec.parent / "arm", tmp_path / "arm")
    spec = written(tmp_path, built.spec.read_text(encoding="utf-8"))
    srdf = compiled(spec).texts["config/moveit/bench.srdf"]
    assert 'link1="arm_hand" link2="arm_upper"' in srdf
    assert 'link1="arm_base" link2="arm_upper"' in srdf
