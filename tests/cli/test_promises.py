"""The promises of SECURITY.md on specs and devices, each held through a command: how it ends, and what it leaves."""

from __future__ import annotations

import os
import re
import shutil
import struct
import threading
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import yaml

from cellc.contract.limits import Limits
from tests.cells import CORPUS
from tests.cli.hostile_cell import SECRET, SPEC, Files, make, mesh, new_cell, shape, sparse, xacro
from tests.cli.run import run
from tests.description.test_hostile_meshes import BODY, OBJ, _glb, _scene
from tests.description.test_hostile_xacro import ATTACKS
from tests.emit.taint.judge import differences
from tests.emit.taint.payloads import EVALUATED, HIDDEN, PAYLOADS, text_of, twin_of
from tests.robustness.fuzz.bases import PARTS, TINY
from tests.source.test_refusals import BOMB


@pytest.fixture(name="cell")
def cell_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a cell, which is the current one."""
    folder = new_cell(tmp_path / "cell")
    monkeypatch.chdir(folder)
    return folder


def _refused(folder: Path, *words: str) -> None:
    """Hold that `build` ends with these findings, and that nothing is written, run or shown for the files."""
    before = sorted(folder.parent.rglob("*"))
    ran = run("build", "cell.yaml")
    assert ran.code == 1, ran
    assert all(word in ran.out for word in words), ran.out
    assert SECRET not in ran.out + ran.err
    assert "Traceback" not in ran.err
    assert sorted(folder.parent.rglob("*")) == before


def _bounded(monkeypatch: pytest.MonkeyPatch, **bounds: int) -> None:
    """Put lower bounds in the place of the defaults, which take seconds to reach."""
    monkeypatch.setattr("cellc.tools.cli.limit_option.raised", lambda _given: Limits(**bounds))


_PROSE = 16
"""How many of the texts fit into a summary: the last, those of Markdown among them."""


def _with_texts(texts: Mapping[str, str]) -> str:
    """Return a cell with a text in each parameter of a node, and one in its summary."""
    spec: Any = yaml.safe_load(TINY[0].replace("./parts/", "./"))
    spec["nodes"]["seer"]["parameters"] = dict(texts)
    marks = [text.replace("\n", " ") for text in texts.values()][-_PROSE:]
    spec["summary"] = " ".join(marks)  # is prose in Markdown
    return yaml.safe_dump(spec, sort_keys=False, allow_unicode=True)


@pytest.mark.parametrize("name", EVALUATED)
def test_a_text_that_a_program_would_evaluate_is_refused(name: str, cell: Path) -> None:
    shutil.copytree(PARTS / "demo_camera", cell / "demo_camera")
    make(cell, {"cell.yaml": _with_texts({"text": PAYLOADS[name]})})
    _refused(cell, "error[substitution-in-text]")


def test_every_other_text_is_text_in_all_that_a_build_writes(cell: Path) -> None:
    shutil.copytree(PARTS / "demo_camera", cell / "demo_camera")
    names = [name for name in PAYLOADS if name not in (*EVALUATED, *HIDDEN)]
    hostile = {f"text_{number}": text_of(PAYLOADS[name], number, "last", "") for number, name in enumerate(names)}
    twins = {key: twin_of(text) for key, text in hostile.items()}
    built: list[dict[str, str]] = []
    for texts in (hostile, twins):
        make(cell, {"cell.yaml": _with_texts(texts)})
        ran = run("build", "cell.yaml")
        assert ran.code == 0, ran.out
        folder = cell / "generated/fuzzed"
        files = [path for path in folder.rglob("*") if path.is_file()]
        built.append({path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in files})
    assert list(differences(built[0], built[1], {twins[key]: hostile[key] for key in hostile})) == []
    assert not list(cell.rglob("taint"))


_BOUNDED: dict[str, tuple[Files, str]] = {
    "size": ({"cell.yaml": sparse(50 << 20)}, "file-too-large"),
    "size of an include": ({"cell.yaml": f"include: a.yaml\n{SPEC}", "a.yaml": sparse(50 << 20)}, "file-too-large"),
    "nesting": ({"cell.yaml": "[" * 10_000}, "too-deep"),
    "nesting of aliases": (
        {"cell.yaml": f"a: &a {'[' * 40}{']' * 40}\nb: {'[' * 40}*a{']' * 40}"},
        "too-deep",
    ),
    "aliases": ({"cell.yaml": BOMB}, "alias-bomb"),
    "values": ({"cell.yaml": f"a: [{'1,' * 2_001}]"}, "too-many-values"),
    "a pipe": ({"cell.yaml": os.mkfifo}, "not-a-file"),
    "a pipe as an include": ({"cell.yaml": f"include: a.yaml\n{SPEC}", "a.yaml": os.mkfifo}, "not-a-file"),
    "a device": ({"cell.yaml": lambda place: place.symlink_to("/dev/zero")}, "include-escape"),
}


@pytest.mark.parametrize(("files", "code"), _BOUNDED.values(), ids=_BOUNDED)
def test_a_spec_beyond_a_bound_is_refused(files: Files, code: str, cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _bounded(monkeypatch, spec_values=2_000)
    make(cell, files)
    _refused(cell, f"error[{code}]")


_LOOPS = "".join(f'<a{i} b="${{python.sorted(python.range(9999))[0]}}"/>' for i in range(5000))
_CROWD = '<sphere radius="0.01"/></geometry></collision><collision><geometry>' * 210 + '<sphere radius="0.01"/>'


def test_expansions_of_all_devices_together_are_bounded(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _bounded(monkeypatch, xacro_seconds=1)
    make(cell, xacro(_LOOPS))
    shutil.copytree(cell / "stage", cell / "other")
    make(cell, {"cell.yaml": SPEC.replace("devices:\n", "devices:\n  more: {model: ./other}\n", 1)})
    _refused(cell, "error[xacro-too-large]", "was not started")


def test_pairs_of_shapes_are_bounded(cell: Path) -> None:
    make(cell, shape(_CROWD))
    _refused(cell, "error[geometry-too-large]", "at most 20000")


def test_the_search_for_poses_and_goals_is_bounded(cell: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    _bounded(monkeypatch, planning_seconds=0)
    _refused(cell, "error[geometry-too-large]", "`--limit planning-seconds=N` raises it")


_EXPANDED = (
    "import_function",
    "subclasses",
    "yaml_outside",
    "macro_calls_itself",
)


@pytest.mark.parametrize("name", _EXPANDED)
def test_a_description_runs_no_python_and_reads_nothing_outside(name: str, cell: Path) -> None:
    body, code = ATTACKS[name]
    make(cell, xacro(body.replace("../secret", "../../private/private")))
    _refused(cell, f"error[{code}]")


def test_a_link_in_a_device_folder_leads_nowhere(cell: Path) -> None:
    make(cell, xacro('<xacro:include filename="a.xacro"/>'))
    (cell / "stage/a.xacro").symlink_to(cell.parent / "private/private.xacro")
    _refused(cell, "error[xacro-outside-root]")


_MESHES: dict[str, tuple[Files, str]] = {
    "above": (mesh("package://stage/../../private/private.stl"), "mesh-outside-root"),
    "elsewhere": (mesh("file:///etc/passwd"), "mesh-outside-root"),
    "a device": (mesh("file:///dev/zero"), "mesh-outside-root"),
    "a link": (mesh("a.stl", lambda place: place.symlink_to("../../private/private.stl")), "mesh-outside-root"),
    "no mesh": (mesh("a.stl", SECRET), "malformed-mesh"),
    "bytes": (mesh("a.stl", sparse(65 << 20)), "mesh-too-large"),
    "another file": (mesh("a.glb", _glb(_scene(3, uri="../../private/private.bin"))), "malformed-mesh"),
}


@pytest.mark.parametrize(("files", "code"), _MESHES.values(), ids=_MESHES)
def test_a_mesh_elsewhere_or_beyond_a_bound_is_refused(files: Files, code: str, cell: Path) -> None:
    make(cell, files)
    _refused(cell, f"error[{code}]")


def _twice(content: bytes) -> bytes:
    """Return a binary glTF that names its buffer twice, at first as a file elsewhere."""
    length = int.from_bytes(content[12:16], "little")
    elsewhere = b'{"buffers": [{"byteLength": 36, "uri": "../../private/private.bin"}], '
    text = elsewhere + content[21 : 20 + length]
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + content[20 + length :]
    return content[:8] + struct.pack("<I", 12 + len(chunks)) + chunks


def test_a_key_that_a_mesh_has_twice_is_refused(cell: Path) -> None:
    make(cell, mesh("a.glb", _glb(_scene(3), BODY)))
    assert run("check", "cell.yaml").code == 0
    make(cell, mesh("a.glb", _twice(_glb(_scene(3), BODY))))
    _refused(cell, "error[malformed-mesh]")


@pytest.mark.parametrize("line", ["mtllib {}", "mtl\\\nlib {}", "\fmtllib {}"], ids=ascii)
def test_no_line_of_a_mesh_has_another_file_read(line: str, cell: Path) -> None:
    # A pipe tells that it is opened, which a file does not. The library looks beside its copy of the mesh.
    pipe, opened, over = cell / "pipe", threading.Event(), threading.Event()
    os.mkfifo(pipe)

    def wait_for_a_reader() -> None:
        while not over.wait(0.005):
            with suppress(OSError):  # nobody reads
                os.close(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
                opened.set()

    waiting = threading.Thread(target=wait_for_a_reader)
    waiting.start()
    make(cell, mesh("a.obj", OBJ + line.format(f"{'../' * 40}{pipe.as_posix().lstrip('/')}") + "\n"))
    ran = run("check", "cell.yaml")
    over.set()
    waiting.join()
    assert not opened.is_set()
    assert (ran.code, "mesh" in ran.out) == (0, False), ran.out


_ON_THE_MOCK = ("driver-on-mock-of-a-device", "driver-on-mock-of-the-spec", "unproven-mock-plugin-refused")


@pytest.mark.parametrize("name", _ON_THE_MOCK)
def test_a_driver_on_the_mock_is_refused_whatever_a_comment_says(name: str, cell: Path) -> None:
    shutil.copytree(CORPUS / "invalid/base", cell / "base")
    spec = (CORPUS / f"invalid/{name}.yaml").read_text(encoding="utf-8")
    codes = re.findall("# expect: (.*)", spec)
    spec = re.sub("# expect: ([a-z-]+).*", r"# cellc: ignore \1 it is only a test", spec)
    make(cell, {"cell.yaml": spec})
    _refused(cell, *(f"error[{code}]" for line in codes for code in line.split(", ")))
