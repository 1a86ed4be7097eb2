"""A real kill at every step of writing, and many writers at once: no file is ever half, and the next run heals."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from cellc.compiler.output.write import write
from cellc.compiler.pipeline import Checked
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.contract.store.cache import read_entry, write_entry
from cellc.contract.store.swap import write_whole
from cellc.mock.evidence.folder import EvidenceFolder
from cellc.tools.importing import folder as importing
from cellc.tools.importing.folder import changed_files, write_folder
from cellc.tools.importing.role import role_of
from cellc.tools.importing.source import read_robot
from tests.cells import there
from tests.output.building import as_contents, build_of, contents

OLD = build_of(a_txt="one\n", b_txt="two\n", old__d_txt="d\n")
NEW = build_of(a_txt="changed\n", b_txt="two\n", new__e_txt="e\n")
_STEPS = ("open", "os.rename", "os.mkdir", "os.rmdir", "os.remove", "os.link", "shutil.rmtree")
"""Audit events of Python for what changes a folder; each is raised before the change."""


def _killed_at(step: int, act: Callable[[], object]) -> bool:
    """Run ``act`` in a process that is killed right before a step of it; return whether it had so many."""
    child = os.fork()
    if child == 0:
        seen = 0

        def kill(event: str, _: object) -> None:
            nonlocal seen
            if event in _STEPS:
                seen += 1
                if seen == step:
                    os.kill(os.getpid(), signal.SIGKILL)

        sys.addaudithook(kill)
        try:
            act()
        finally:
            os._exit(0)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == -signal.SIGKILL


def _in_order(
    act: Callable[[Path], object],
    hold: Callable[[Path], object],
    start: Path,
    ready: Callable[[Path], object] = lambda _: None,
    stride: int = 1,
) -> int:
    """Kill ``act`` at its first step, at its second, …, each in a place of its own; return how many it has.

    Args:
        stride: of so many steps one is tried.
    """
    step = 1 - stride
    was_killed = True
    while was_killed:
        step += stride
        place = start / str(step)
        place.mkdir()
        ready(place)
        was_killed = _killed_at(step, partial(act, place))
        hold(place)
    return step


def test_kill_at_any_step_of_a_build_is_healed_by_the_next(tmp_path: Path) -> None:
    def ready(place: Path) -> None:
        write(OLD, place / "small")
        (place / "small/notes.txt").write_text("mine\n")

    def build(place: Path) -> None:
        write(NEW, place / "small")

    old, new = as_contents(OLD), as_contents(NEW)

    def hold(place: Path) -> None:
        for path, text in contents(place / "small").items():
            assert path.endswith("/") or text in (old.get(path), new.get(path), "mine\n"), path
        assert write(NEW, place / "small").ok
        healed = {**new, "notes.txt": "mine\n"}
        assert contents(place) == {f"small/{path}": text for path, text in healed.items()}

    assert _in_order(build, hold, tmp_path, ready) > 30


def test_kill_at_any_step_of_one_file_leaves_the_old_or_the_new(tmp_path: Path) -> None:
    def act(place: Path) -> None:
        write_whole(place / "cell.yaml", "new\n")

    def hold(place: Path) -> None:
        assert contents(place).get("cell.yaml", "new\n") == "new\n"
        write_whole(place / "cell.yaml", "new\n")
        assert contents(place) == {"cell.yaml": "new\n"}

    assert _in_order(act, hold, tmp_path) > 3


def test_kill_at_any_step_of_keeping_an_answer_leaves_it_or_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("CELLC_NO_CACHE", raising=False)
    name = "kind/entry.json"

    def act(place: Path) -> None:
        os.environ["XDG_CACHE_HOME"] = str(place)
        write_entry(name, b"answer")

    def hold(place: Path) -> None:
        monkeypatch.setenv("XDG_CACHE_HOME", str(place))
        assert read_entry(name) in (None, b"answer")
        write_entry(name, b"answer")
        assert read_entry(name) == b"answer"
        assert [path.name for path in place.rglob("*") if path.is_file()] == ["entry.json"]

    assert _in_order(act, hold, tmp_path) > 3


def test_kill_at_any_step_of_evidence_is_healed_by_the_next(tmp_path: Path) -> None:
    def act(place: Path) -> None:
        folder = EvidenceFolder(place / "evidence", ["a.json", "b.json"])
        folder.write("a.json", "a\n")
        folder.write("b.json", "b\n")
        folder.settle({"seed": 0})
        folder.discard()

    def hold(place: Path) -> None:
        left = contents(place / "evidence") if (place / "evidence").exists() else {}
        assert left.get("a.json", "a\n") == "a\n"
        assert left.get("b.json", "b\n") == "b\n"
        act(place)
        assert sorted(contents(place)) == ["evidence/a.json", "evidence/b.json", "evidence/evidence.json"]

    assert _in_order(act, hold, tmp_path) > 10


def test_kill_at_any_step_of_an_import_is_healed_by_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # What is written is the same, whatever a check of it finds.
    monkeypatch.setattr(importing, "_judged", lambda folder, role, away, before: (before, _UNCHECKED))
    robot = there(read_robot(_arm(tmp_path), {}).value)
    role = role_of(robot.description)

    def act(place: Path) -> None:
        assert write_folder(place / "arm", robot, role, {}, "2026-11-01").ok

    def again(place: Path) -> None:
        act(place)
        facts = (place / "arm/device.yaml").read_text(encoding="utf-8")
        (place / "arm/device.yaml").write_text(facts.replace("vendor: UNKNOWN", "vendor: Us"), encoding="utf-8")
        (place / "arm/notes.txt").write_text("mine\n", encoding="utf-8")

    def hold(place: Path) -> None:
        act(place)
        made = ["arm/device.yaml", "arm/import.lock.json", "arm/meshes/a.stl", "arm/robot.urdf"]
        assert [name for name in sorted(contents(place)) if name != "arm/notes.txt"] == made
        assert changed_files(place / "arm") == ()

    def kept(place: Path) -> None:
        hold(place)
        assert "vendor: Us" in contents(place)["arm/device.yaml"]
        assert contents(place)["arm/notes.txt"] == "mine\n"

    (tmp_path / "first").mkdir()
    assert _in_order(act, hold, tmp_path / "first", stride=4) > 22
    other = replace(robot, text=robot.text + "<!-- of today -->")

    def renewed(place: Path) -> None:
        assert write_folder(place / "arm", other, role, {}, "2026-11-02").ok

    (tmp_path / "second").mkdir()
    assert _in_order(renewed, kept, tmp_path / "second", again, stride=4) > 22


_UNCHECKED = Checked(Findings("cell.yaml", {}, ()), None)


def _arm(folder: Path) -> Path:
    """Write an arm of one joint with a mesh."""
    mesh = '<collision><geometry><mesh filename="a.stl"/></geometry></collision>'
    ends = '<parent link="a"/><child link="b"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/>'
    links = f'<link name="a">{mesh}</link><link name="b"/>'
    text = f'<robot name="arm">{links}<joint name="j" type="revolute">{ends}</joint></robot>'
    (folder / "a.stl").write_text("solid a\nendsolid a\n", encoding="utf-8")
    (folder / "arm.urdf").write_text(text, encoding="utf-8")
    return folder / "arm.urdf"


@pytest.mark.parametrize("start", [(), OLD], ids=["first build", "next build"])
def test_of_sixteen_writers_at_once_one_whole_folder_is_left(start: tuple[object, ...], tmp_path: Path) -> None:
    folder = tmp_path / "small"
    if start:
        write(OLD, folder)
    children = []
    for number in range(16):
        child = os.fork()
        if child == 0:
            code = 2
            try:
                codes = [found.code for found in write((OLD, NEW)[number % 2], folder).diagnostics]
                code = {(): 0, ("output-busy",): 1}.get(tuple(codes), 2)
            finally:
                os._exit(code)
        children.append(child)
    ended = [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children]
    assert set(ended) <= {0, 1}
    left = contents(tmp_path)
    wholes = [{f"small/{path}": text for path, text in as_contents(one).items()} for one in (OLD, NEW)]
    assert left in [*wholes, {}]
    assert write(NEW, folder).ok
    assert contents(folder) == as_contents(NEW)
