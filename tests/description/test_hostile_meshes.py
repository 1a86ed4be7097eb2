"""Meshes of a stranger end in numbers or in one finding, fast, wherever they lie and whatever is in them."""

from __future__ import annotations

import json
import os
import struct
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cellc.contract.limits import DEFAULTS, in_force
from cellc.robot.description import mesh_child
from cellc.robot.description.confined_child import ChildEndedError, ask_child
from cellc.robot.description.mesh_numbers import MeshNumbers, pack_numbers, read_answers, read_meshes
from cellc.robot.description.meshes import (
    MeshError,
    MeshFacts,
    MeshFile,
    identify,
    identify_all,
    read_pieces,
    readable,
    unusable,
)
from cellc.robot.description.model import Mesh
from cellc.robot.description.packages import lies_under

TRIANGLE = "solid t\nfacet normal 0 0 1\nouter loop\n{}\nendloop\nendfacet\nendsolid t\n"
CORNERS = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 2 0"
OBJ = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n"
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n"
)


def _cell(folder: Path) -> Path:
    """Make a folder of a spec with a package, and a package beside it that nobody named."""
    for package in (folder / "cell" / "parts", folder / "secret"):
        package.mkdir(parents=True)
        (package / "part.stl").write_text(TRIANGLE.format(CORNERS))
    return folder / "cell"


def _refusal(name: str, roots: tuple[Path, ...], shelves: tuple[Path, ...] = ()) -> str:
    with pytest.raises(MeshError) as caught:
        identify(name, roots, shelves)
    assert "\n" not in str(caught.value)
    return caught.value.code


def _read(file: Path) -> MeshNumbers | MeshError:
    (read,) = read_meshes((identify(f"file://{file}", (file.parent,), ()),))
    return read


def _box(content: MeshNumbers | MeshError) -> tuple[float, ...]:
    assert isinstance(content, MeshNumbers), content
    return (*content.vertices.min(axis=0), *content.vertices.max(axis=0))


def test_package_beside_the_spec_is_found(tmp_path: Path) -> None:
    root = _cell(tmp_path)
    assert identify("package://parts/part.stl", (root,), ()).path == str(root / "parts" / "part.stl")


def test_package_of_a_workspace_may_consist_of_links(tmp_path: Path) -> None:
    # As `colcon build --symlink-install` makes them.
    share = tmp_path / "install" / "share" / "tool"
    share.mkdir(parents=True)
    (tmp_path / "part.stl").write_text(TRIANGLE.format(CORNERS))
    (share / "part.stl").symlink_to(tmp_path / "part.stl")
    shelves = (tmp_path / "install",)
    for name in ("package://tool/part.stl", f"file://{share}/part.stl"):
        assert identify(name, (), shelves).path == str(tmp_path / "part.stl")


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("package://parts/../../secret/part.stl", "mesh-outside-root"),
        ("package://../secret/part.stl", "mesh-outside-root"),
        ("package:///../../../../etc/passwd", "mesh-outside-root"),
        ("../secret/part.stl", "mesh-outside-root"),
        ("file:///etc/passwd", "mesh-outside-root"),
        ("/etc/passwd", "mesh-outside-root"),
        ("file://part.stl", "mesh-outside-root"),
        ("/dev/zero", "mesh-outside-root"),
        ("/proc/self/environ", "mesh-outside-root"),
        ("package://parts", "mesh-not-found"),
        ("package://parts/", "mesh-not-found"),
        ("package://", "mesh-not-found"),
        ("package://secret/part.stl", "mesh-not-found"),
        ("package://parts/" + "a" * 5000, "mesh-not-found"),
        ("http://127.0.0.1:9/part.stl", "mesh-not-found"),
    ],
)
def test_name_that_reaches_elsewhere_is_refused(name: str, code: str, tmp_path: Path) -> None:
    assert _refusal(name, (_cell(tmp_path),)) == code


@pytest.mark.parametrize("name", ["/dev/zero", "/proc/self/environ", "/sys/kernel/notes"])
def test_package_path_leads_to_no_file_of_the_system(name: str, tmp_path: Path) -> None:
    (tmp_path / "part.stl").symlink_to(name)
    assert _refusal("part.stl", (), (tmp_path,)) == "mesh-outside-root"
    assert _refusal(name, (), (Path("/"),)) == "mesh-outside-root"


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda file: file.symlink_to(file.parents[2] / "secret" / "part.stl"), "mesh-outside-root"),
        (lambda file: file.symlink_to("/etc/passwd"), "mesh-outside-root"),
        (lambda file: file.symlink_to("/dev/zero"), "mesh-outside-root"),
        (lambda file: file.symlink_to(file), "mesh-not-found"),
        (lambda file: file.symlink_to(file.parent / "absent"), "mesh-not-found"),
        (lambda file: os.mkfifo(file), "mesh-not-found"),
        (lambda file: file.mkdir(), "mesh-not-found"),
    ],
    ids=["link", "link_to_passwd", "link_to_device", "link_to_itself", "dangling", "fifo", "folder"],
)
def test_what_is_no_file_of_the_spec_is_refused(make: Callable[[Path], None], code: str, tmp_path: Path) -> None:
    root = _cell(tmp_path)
    file = root / "parts" / "other.stl"
    make(file)
    assert _refusal("package://parts/other.stl", (root,)) == code
    assert _refusal(f"file://{file}", (root,)) == code


def test_fifo_that_takes_the_place_of_a_file_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "part.stl")
    with pytest.raises(OSError, match="Not a regular file"):
        next(read_pieces(tmp_path / "part.stl"))


def test_link_that_changes_after_it_was_judged_is_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    root = _cell(tmp_path)
    file = root / "parts" / "part.stl"

    def swapped(path: str, folder: str) -> bool:
        answer = lies_under(path, folder)
        file.unlink()
        file.symlink_to(tmp_path / "secret" / "part.stl")
        return answer

    monkeypatch.setattr("cellc.robot.description.meshes.lies_under", swapped)
    assert _refusal("package://parts/part.stl", (root,)) == "mesh-not-found"


def test_file_that_changes_after_it_was_hashed_is_not_read(tmp_path: Path) -> None:
    root = _cell(tmp_path)
    file = identify("package://parts/part.stl", (root,), ())
    Path(file.path).unlink()
    Path(file.path).symlink_to("/etc/passwd")
    (read,) = read_meshes((file,))
    assert isinstance(read, MeshError)
    assert (read.code, str(read)) == ("malformed-mesh", "changes while it is read")


def _binary_stl(count: int, *triangles: tuple[float, ...]) -> bytes:
    return bytes(80) + struct.pack("<I", count) + b"".join(struct.pack("<12fH", 0, 0, 0, *t, 0) for t in triangles)


def _glb(scene: dict[str, object], body: bytes = b"") -> bytes:
    text = json.dumps({"asset": {"version": "2.0"}} | scene).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(body), b"BIN\0") + body
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _scene(count: int, **buffer: object) -> dict[str, object]:
    return {
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"byteLength": 36} | buffer],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"}],
    }


POINTS = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0)
BODY = struct.pack("<9f", *POINTS)
_COLLADA = (
    '<?xml version="1.0"?>{}<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>'
    '<up_axis>Z_UP</up_axis></asset><library_images><image id="i"><init_from>file:///etc/passwd</init_from></image>'
    '</library_images><library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">{}'
    '</float_array><technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>'
    '<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>'
    '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" '
    'source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>'
    '<visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>'
    '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
)
_BOMB = '<!DOCTYPE c [<!ENTITY a "1 "><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
_EXTERNAL = '<!DOCTYPE c SYSTEM "file:///etc/passwd" [<!ENTITY b SYSTEM "file:///etc/passwd">]>'

SHAPES = {
    "ascii.stl": TRIANGLE.format(CORNERS).encode(),
    "binary.stl": _binary_stl(1, POINTS),
    "plain.obj": OBJ.encode(),
    "materials.obj": f"mtllib ../../../../etc/passwd\nmtllib /dev/zero\n{OBJ}".encode(),
    "continued.obj": f"  mtllib a \\\n /dev/zero\n{OBJ}".encode(),
    "textured.ply": PLY.replace("element vertex", "comment TextureFile /etc/passwd\nelement vertex").encode(),
    "plain.off": b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n",
    "plain.glb": _glb(_scene(3), BODY),
    "images.dae": _COLLADA.format("", "0 0 0 1 0 0 0 2 0").encode(),
    "UPPER.STL": _binary_stl(1, POINTS),
}
MALFORMED = {
    "empty.stl": b"",
    "words.stl": b"a drawing",
    "count_too_high.stl": _binary_stl(2, POINTS),
    "count_too_low.stl": _binary_stl(0, POINTS),
    "nan.stl": _binary_stl(1, (float("nan"), *POINTS[1:])),
    "infinite.stl": _binary_stl(1, (float("inf"), *POINTS[1:])),
    "nan_in_text.stl": TRIANGLE.format(CORNERS.replace("2", "nan")).encode(),
    "overflow.obj": OBJ.replace("2", "1e400", 1).encode(),
    "no_triangle.ply": PLY.replace("element face 1", "element face 0").replace("3 0 1 2\n", "").encode(),
    "index_beyond.obj": OBJ.replace("f 1 2 3", "f 1 2 99999999").encode(),
    "many_vertices.ply": PLY.replace("element vertex 3", "element vertex 4000000000").encode(),
    "other_file.glb": _glb(_scene(3, uri="/dev/zero")),
    "other_image.glb": _glb(_scene(3) | {"images": [{"uri": "../../etc/passwd"}]}, BODY),
    "huge_accessor.glb": _glb(_scene(2**31 - 1), BODY),
    "deep.glb": _glb({"extras": 1}).replace(b'"extras": 1', b'"a": 11111'),
    "bomb.dae": _COLLADA.format(_BOMB, "&b;").encode(),
    "external.dae": _COLLADA.format(_EXTERNAL, "&b;").encode(),
    "text.dae": b"<COLLADA>",
}


@pytest.fixture(name="results", scope="module")
def results_fixture(tmp_path_factory: pytest.TempPathFactory) -> dict[str, MeshNumbers | MeshError]:
    """Read every file by one child: one that crashed or looped would leave those after it without an answer."""
    folder = tmp_path_factory.mktemp("meshes")
    with zipfile.ZipFile(folder / "archive.dae", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.dae", _COLLADA.format("", "0 0 0 1 0 0 0 2 0") + " " * 10_000_000)
    for name, content in (SHAPES | MALFORMED).items():
        (folder / name).write_bytes(content)
    files = tuple(identify(f"file://{file}", (folder,), ()) for file in sorted(folder.iterdir()))
    return {Path(file.path).name: read for file, read in zip(files, read_meshes(files), strict=True)}


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_formats_of_the_field_are_read(name: str, results: dict[str, MeshNumbers | MeshError]) -> None:
    assert _box(results[name]) == (0.0, 0.0, 0.0, 1.0, 2.0, 0.0)


@pytest.mark.parametrize("name", [*sorted(MALFORMED), "archive.dae"])
def test_malformed_mesh_ends_in_one_refusal(name: str, results: dict[str, MeshNumbers | MeshError]) -> None:
    found = results[name]
    assert isinstance(found, MeshError), found
    assert found.code == "malformed-mesh"
    assert found.help_text
    assert "\n" not in str(found)


def test_refusal_quotes_nothing_of_a_file(results: dict[str, MeshNumbers | MeshError]) -> None:
    assert str(results["words.stl"]) == "cannot be read as `.stl`"


def test_bytes_and_triangles_are_bounded(tmp_path: Path) -> None:
    file = tmp_path / "part.stl"
    file.write_bytes(_binary_stl(2, POINTS, POINTS))
    with in_force(replace(DEFAULTS, mesh_triangles=1)):
        read = _read(file)
    assert isinstance(read, MeshError)
    assert (read.code, str(read)) == ("mesh-too-large", "must have at most 1 triangles, got 2")
    with in_force(replace(DEFAULTS, mesh_bytes=183)):
        assert _refusal("part.stl", (), (tmp_path,)) == "mesh-too-large"


def test_triangles_of_all_meshes_together_are_bounded(tmp_path: Path) -> None:
    for name in ("a.stl", "b.stl"):
        (tmp_path / name).write_bytes(_binary_stl(1, POINTS))
    files = tuple(identify(f"file://{file}", (tmp_path,), ()) for file in sorted(tmp_path.iterdir()))
    with in_force(replace(DEFAULTS, mesh_triangles_together=2)):
        assert [len(read.triangles) for read in read_meshes(files) if isinstance(read, MeshNumbers)] == [1, 1]
    with in_force(replace(DEFAULTS, mesh_triangles_together=1)):
        first, second = read_meshes(files)
    assert isinstance(first, MeshNumbers)
    assert isinstance(second, MeshError)
    assert str(second) == "must have at most 1 triangles with the meshes before it, got 2"
    assert not second.certain


def test_mesh_of_which_nothing_is_known_is_no_fault(tmp_path: Path) -> None:
    mesh, (files, facts) = _facts(tmp_path, (0.0, 1.0, 1.0))
    unread = Mesh("unread.stl", (1.0, 1.0, 1.0))
    assert list(unusable([mesh], files, {})) == []
    assert list(unusable([unread], files, facts)) == []
    assert [one for one, _ in unusable([unread, mesh], files, facts)] == [mesh]


def test_child_that_does_not_end_well_is_told_in_a_sentence() -> None:
    with pytest.raises(ChildEndedError) as caught:
        ask_child("cellc.robot.description.mesh_child", b"no request")
    assert str(caught.value) == "takes more time or memory than it may use"
    assert caught.value.answer == b""


def test_mesh_that_ends_the_child_is_named_and_those_before_it_are_read(tmp_path: Path) -> None:
    # A polygon of so many corners keeps the library busy for minutes.
    (tmp_path / "a.stl").write_bytes(_binary_stl(1, POINTS))
    (tmp_path / "b.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf" + " 1 2 3 4" * 60_000)
    (tmp_path / "c.stl").write_bytes(_binary_stl(1, POINTS))
    files = tuple(identify(f"file://{file}", (tmp_path,), ()) for file in sorted(tmp_path.iterdir()))
    with in_force(replace(DEFAULTS, mesh_seconds=2)):
        read = read_meshes(files)
    assert len(read) == 2
    assert _box(read[0]) == (0.0, 0.0, 0.0, 1.0, 2.0, 0.0)
    assert isinstance(read[1], MeshError)
    assert (read[1].code, read[1].certain) == ("mesh-too-large", False)


def test_hostile_child_gives_no_numbers_that_are_not_checked() -> None:
    vertices = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, np.nan, 0.0]])
    beyond = pack_numbers(MeshNumbers(np.zeros((3, 3)), np.array([[0, 1, 3]])))
    nowhere = pack_numbers(MeshNumbers(vertices, np.array([[0, 1, 2]])))
    assert all(isinstance(read, MeshError) for read in read_answers(beyond + nowhere, 2))


@pytest.mark.parametrize("scale", [(0.0, 1.0, 1.0), (1e300, 1.0, 1.0), (1.0, -1e7, 1.0)])
def test_scale_beyond_bounds_is_refused(scale: tuple[float, float, float], tmp_path: Path) -> None:
    mesh, facts = _facts(tmp_path, scale)
    ((_, fault),) = unusable([mesh], *facts)
    assert fault.code == "malformed-mesh"


def test_mirrored_mesh_is_none_beyond_bounds(tmp_path: Path) -> None:
    mesh, facts = _facts(tmp_path, (1.0, -0.001, 1.0))
    assert list(unusable([mesh], *facts)) == []


def test_ten_thousand_shapes_of_one_file_are_counted(tmp_path: Path) -> None:
    mesh, facts = _facts(tmp_path, (1.0, 1.0, 1.0))
    assert [fault.code for _, fault in unusable([mesh] * 10_000, *facts)] == ["mesh-too-large"]


def _facts(
    folder: Path, scale: tuple[float, float, float]
) -> tuple[Mesh, tuple[dict[str, MeshFile | MeshError], dict[MeshFile, MeshFacts]]]:
    """Return a mesh of a triangle with what ``unusable`` is told of it."""
    (folder / "part.stl").write_bytes(_binary_stl(1, POINTS))
    mesh = Mesh(str(folder / "part.stl"), scale)
    files = identify_all([mesh], (folder,))
    return mesh, (files, {file: MeshFacts(1, (1.0, 2.0, 0.0)) for file in readable(files)})


@pytest.mark.parametrize(
    "line",
    [b"mtl\\\nlib x", b"\rmtllib x", b"\fmtllib x", b"\0mtllib x", b"v 0 0 0\\\r\nmtllib x", b"\vmtllib x", b"call x"],
)
def test_no_spelling_of_a_line_of_an_obj_names_another_file(line: bytes) -> None:
    # assimp joins lines at a backslash, and ends them at more characters than a line feed (its LineSplitter).
    kept = mesh_child._self_contained(OBJ.encode() + line + b"\n", ".obj")
    assert {words.split(b" ")[0] for words in kept.splitlines()} == {b"v", b"f"}


def test_lines_of_an_obj_that_are_continued_make_the_same_shape(tmp_path: Path) -> None:
    (tmp_path / "plain.obj").write_text(OBJ)
    (tmp_path / "continued.obj").write_text(OBJ.replace("1 0 0", "1 \\\n 0 0").replace("f 1 2", "usemtl a\nf 1 2 \\\n"))
    assert _box(_read(tmp_path / "continued.obj")) == _box(_read(tmp_path / "plain.obj")) == (0, 0, 0, 1, 2, 0)


def test_key_that_stands_twice_in_a_glb_is_refused(tmp_path: Path) -> None:
    # Python keeps the last, the library reads the first: each would see other files.
    content = _glb(_scene(3), BODY)
    length = int.from_bytes(content[12:16], "little")
    text = content[20 : 20 + length].rstrip()
    twice = b'{"buffers": [{"byteLength": 36, "uri": "../../secret.bin"}], ' + text[1:]
    twice += b" " * (-len(twice) % 4)
    chunks = len(twice).to_bytes(4, "little") + b"JSON" + twice + content[20 + length :]
    (tmp_path / "twice.glb").write_bytes(content[:8] + (12 + len(chunks)).to_bytes(4, "little") + chunks)
    read = _read(tmp_path / "twice.glb")
    assert isinstance(read, MeshError)
    assert read.message == "must be a binary glTF 2.0"


def test_file_that_changed_while_it_was_read_says_nothing_for_the_next_time(tmp_path: Path) -> None:
    (tmp_path / "part.stl").write_text(TRIANGLE.format(CORNERS))
    with pytest.raises(MeshError) as caught:
        mesh_child._read(tmp_path / "part.stl", "0" * 64, tmp_path / "copy.stl")
    assert not caught.value.certain
