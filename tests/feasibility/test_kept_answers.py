"""An answer from the cache is the one that a run without a cache gives, whatever file or package path has changed."""

from __future__ import annotations

import os
import shutil
import struct
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest
import yaml

from cellc.compiler.feasibility import MotionAnswer, disabled_links, mesh_faults, motion_answer
from cellc.compiler.feasibility.question import MotionQuestion
from cellc.contract.limits import Budget
from cellc.contract.store.cache import cache_folder
from cellc.robot.description.packages import on_package_path, use_packages
from tests.cells import CORPUS, graph_of, written

SMALL, LARGE = 0.02, 1.0
"""Side of the hand's cube in m; the wall of the large one stands in the box of the scene, unless the hand is turned."""

Change = Callable[[Path, pytest.MonkeyPatch], None]

_CORNERS = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
_TRIANGLES = [
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]  # fmt: skip


def _cube(file: Path, side: float) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    data = bytes(80) + struct.pack("<I", len(_TRIANGLES))
    for triangle in _TRIANGLES:
        corners = [side * value for corner in triangle for value in _CORNERS[corner]]
        data += struct.pack("<12fH", 0, 0, 0, *corners, 0)
    file.write_bytes(data)


def _cell(folder: Path, mesh: str) -> Path:
    """Write a cell whose arm carries a mesh, in a xacro that includes another."""
    shutil.copytree(CORPUS / "invalid" / "base" / "stage", folder / "arm")
    device = yaml.safe_load((folder / "arm" / "device.yaml").read_text())
    device["description"]["file"] = "arm.urdf.xacro"
    device["limits"] = {kind: {"turn": each["turn"]} for kind, each in device["limits"].items()}
    (folder / "arm" / "device.yaml").write_text(yaml.safe_dump(device))
    (folder / "arm" / "arm.urdf.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="hand.xacro"/>'
        '<link name="base"/><joint name="turn" type="revolute"><parent link="base"/><child link="hand"/>'
        '<axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint></robot>'
    )
    _hand(folder, f'<mesh filename="{mesh}"/>')
    spec = {
        "format": 1,
        "cell": "grown",
        "versions": {"ros": "jazzy"},
        "devices": {"arm": {"model": "./arm", "mount": {"parent": "world"}}},
        "scene": {"beside": {"parent": "world", "xyz": "525 20 10 mm", "box": "150 200 200 mm"}},
        "motion": {"groups": {"all": {"base": "arm/base", "tip": "arm/hand"}}},
    }
    return written(folder, yaml.safe_dump(spec, sort_keys=False))


def _hand(folder: Path, shape: str) -> None:
    (folder / "arm" / "hand.xacro").write_text(
        f'<robot><link name="hand"><collision><geometry>{shape}</geometry></collision></link></robot>'
    )


def _grow_mesh(folder: Path, _: pytest.MonkeyPatch) -> None:
    _cube(folder / "one" / "parts" / "hand.stl", LARGE)


def _grow_mesh_at_the_same_time_and_size(folder: Path, _: pytest.MonkeyPatch) -> None:
    mesh = folder / "one" / "parts" / "hand.stl"
    before = mesh.stat()
    _cube(mesh, LARGE)
    os.utime(mesh, ns=(before.st_atime_ns, before.st_mtime_ns))


def _remove_mesh(folder: Path, _: pytest.MonkeyPatch) -> None:
    (folder / "one" / "parts" / "hand.stl").unlink()


def _scale_in_include(folder: Path, _: pytest.MonkeyPatch) -> None:
    _hand(folder, '<mesh filename="package://parts/hand.stl" scale="50 50 50"/>')


def _put_package_before(folder: Path, _: pytest.MonkeyPatch) -> None:
    _cube(folder / "none" / "parts" / "hand.stl", LARGE)


def _turn_link(folder: Path, _: pytest.MonkeyPatch) -> None:
    _cube(folder / "large.stl", LARGE)
    mesh = folder / "one" / "parts" / "hand.stl"
    mesh.unlink()
    mesh.symlink_to(folder / "large.stl")


def _name_other_packages(folder: Path, _: pytest.MonkeyPatch) -> None:
    _cube(folder / "two" / "parts" / "hand.stl", LARGE)
    use_packages([str(folder / "two")])


def _name_no_package(_: Path, __: pytest.MonkeyPatch) -> None:
    use_packages([])


def _name_a_prefix(folder: Path, _: pytest.MonkeyPatch) -> None:
    _cube(folder / "prefix" / "share" / "parts" / "hand.stl", LARGE)
    use_packages([str(folder / "prefix")])


CHANGES = [
    _grow_mesh, _grow_mesh_at_the_same_time_and_size, _remove_mesh, _scale_in_include, _put_package_before, _turn_link,
    _name_other_packages, _name_no_package, _name_a_prefix,
]  # fmt: skip


@pytest.fixture(name="cache", autouse=True)
def cache_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.delenv("CELLC_NO_CACHE", raising=False)
    folder = cache_folder()
    assert folder is not None
    with on_package_path([str(tmp_path / "none"), str(tmp_path / "one")]):
        yield folder


def _answers(path: Path) -> tuple[MotionAnswer, object]:
    graph = graph_of(path)
    return motion_answer(graph), disabled_links(graph)


def _without_cache(path: Path) -> tuple[MotionAnswer, object]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CELLC_NO_CACHE", "1")
        return _answers(path)


def test_first_answer_is_that_without_a_cache(tmp_path: Path, cache: Path) -> None:
    _cube(tmp_path / "one" / "parts" / "hand.stl", SMALL)
    path = _cell(tmp_path, "package://parts/hand.stl")
    first = _answers(path)
    assert list(cache.rglob("*.json"))
    assert _answers(path) == first == _without_cache(path)


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__.strip("_"))
def test_changed_input_is_answered_as_without_a_cache(
    change: Change, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    _cube(tmp_path / "one" / "parts" / "hand.stl", SMALL)
    path = _cell(tmp_path, "package://parts/hand.stl")
    before = _answers(path)
    assert before[0].start == ()
    assert before[0].refused == ""
    change(tmp_path, monkeypatch)
    after = _answers(path)
    assert after == _without_cache(path)
    assert after[0].start != () or mesh_faults(graph_of(path))


def test_mesh_that_appears_is_seen(tmp_path: Path) -> None:
    path = _cell(tmp_path, "package://parts/hand.stl")
    assert _answers(path)[0].start == ()
    _cube(tmp_path / "one" / "parts" / "hand.stl", LARGE)
    assert _answers(path)[0].start != ()


def test_mesh_that_changes_during_the_computation_is_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from cellc.compiler.feasibility import compute

    mesh = tmp_path / "one" / "parts" / "hand.stl"
    _cube(mesh, SMALL)
    path = _cell(tmp_path, "package://parts/hand.stl")
    answered = compute.answer

    def grown_meanwhile(question: MotionQuestion, roots: Sequence[Path], budget: Budget) -> MotionAnswer:
        _cube(mesh, LARGE)
        return answered(question, roots, budget)

    with monkeypatch.context() as patch:
        patch.setattr(compute, "answer", grown_meanwhile)
        assert motion_answer(graph_of(path)).start != ()
    _cube(mesh, SMALL)
    assert motion_answer(graph_of(path)).start == ()
