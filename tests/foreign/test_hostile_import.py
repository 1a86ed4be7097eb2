"""Folders of somebody who means harm are imported: nothing outside of the device folder is written or copied in."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from cellc.contract.limits import DEFAULTS, in_force
from cellc.tools.importing.beside import controllers_near, read_controllers
from cellc.tools.importing.merge import facts_in, merged
from tests.cells import there
from tests.cli.run import run
from tests.foreign.test_import import ARM, _robot

_FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\nendloop\nendfacet\n"
_SECRET = f"solid secret\n{_FACET}endsolid secret\n"


def _with_mesh(attributes: str) -> str:
    shape = f"<collision><geometry><mesh {attributes}/></geometry></collision>"
    return _robot(*ARM).replace('<link name="a">', f'<link name="a">{shape}')


def _linked(place: str, target: str) -> Callable[[Path], None]:
    def make(here: Path) -> None:
        (here / place).parent.mkdir(parents=True, exist_ok=True)
        (here / place).symlink_to(here.parent / "home" / target)

    return make


def _nothing(here: Path) -> None:
    return None


def _written(place: str, text: str) -> Callable[[Path], None]:
    def make(here: Path) -> None:
        (here / place).parent.mkdir(parents=True, exist_ok=True)
        (here / place).write_text(text.replace("HOME", (here.parent / "home").as_posix()), encoding="utf-8")

    return make


def _lock(name: str, content: str) -> Callable[[Path], None]:
    digest = hashlib.sha256(content.encode()).hexdigest()
    return _written("odd_arm/import.lock.json", json.dumps({"format": 1, "files": {name: f"sha256:{digest}"}}))


_SELF = 'filename="HOME/secret.stl"'
MESHES = {
    "absolute": _SELF,
    "absolute behind file://": 'filename="file://HOME/secret.stl"',
    "another attribute first": "data-filename='package://p/a.stl' filename='HOME/.bashrc'",
    "an attribute with an angle": "data='>' filename='HOME/.bashrc'",
    "an attribute in an attribute": "data=' filename=\"package://p/a.stl\"' filename='HOME/.bashrc'",
    "above": 'filename="../home/secret.stl"',
    "above a package": 'filename="package://../home/secret.stl"',
    "above from a package": 'filename="package://p/../../home/secret.stl"',
    "an absolute path in a package": 'filename="package://p/HOME/secret.stl"',
    "two slashes in a package": 'filename="package://p//etc/passwd"',
    "the device's own file": 'filename="package://robot.urdf/a.stl"',
    "a link that leads out": 'filename="package://p/link.stl"',
    "a folder that leads out": 'filename="package://linked/secret.stl"',
    "a link, from the folder above": 'filename="package://x/bench/p/link.stl"',
    "a link, from a folder above that is called as a package": 'filename="package://ABOVE/bench/p/link.stl"',
    "a name with a quote": 'filename="package://p/&quot;&gt;&lt;x.stl"',
}
"""What a mesh is named by; HOME is a folder outside of the import, ABOVE the name of the folder that holds both."""
FOLDERS: Mapping[str, Callable[[Path], None]] = {
    "a link at robot.urdf": _linked("odd_arm/robot.urdf", ".bashrc"),
    "a link at .import.yaml": _linked("odd_arm/.import.yaml", ".bashrc"),
    "a link at device.yaml": _linked("odd_arm/device.yaml", ".bashrc"),
    "a link at the lock": _linked("odd_arm/import.lock.json", ".bashrc"),
    "a link at the folder": _linked("odd_arm", "folder"),
    "a link at cell.yaml": _linked("cell.yaml", ".bashrc"),
    "a link at a cell.yaml that is not there": _linked("cell.yaml", "nothing"),
    "a person's robot.urdf": _written("odd_arm/robot.urdf", "mine\n"),
    "a lock that names a file above": _lock("../../home/.bashrc", "home\n"),
    "a lock that names an absolute file": _lock("HOME/.bashrc", "home\n"),
    "a lock of other things": _written("odd_arm/import.lock.json", '{"files": [1], "device": {"as_of": [{}]}}'),
    "a lock that is a list": _written("odd_arm/import.lock.json", "[[]]"),
    "a lock without end": _written("odd_arm/import.lock.json", "[" * 100_000),
    "a device.yaml in Latin-1": lambda here: _bytes(here / "odd_arm/device.yaml", b"vendor: Gr\xfcn\n"),
}


def _bytes(file: Path, content: bytes) -> None:
    file.parent.mkdir(parents=True)
    file.write_bytes(content)


def _state(folder: Path) -> dict[str, str]:
    """Return what a folder holds; links are not followed."""
    return {
        path.relative_to(folder).as_posix(): os.readlink(path)
        if path.is_symlink()
        else path.read_text(encoding="latin-1")
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or path.is_file()
    }


@pytest.fixture(name="here")
def here_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the package of a robot, beside a folder of somebody else."""
    here, home = tmp_path / "bench", tmp_path / "home"
    (home / "folder").mkdir(parents=True)
    (home / "secret.stl").write_text(_SECRET, encoding="utf-8")
    (home / ".bashrc").write_text("home\n", encoding="utf-8")
    (here / "p").mkdir(parents=True)
    beside = here / home.relative_to("/")  # where `package://` and an absolute path lead to from here
    beside.mkdir(parents=True)
    for name in ("secret.stl", ".bashrc"):
        (beside / name).write_text("harm\n", encoding="utf-8")
    (here / "p/link.stl").symlink_to(home / "secret.stl")
    (here / "linked").symlink_to(home)
    monkeypatch.chdir(here)
    return here


def _imported(here: Path, text: str) -> tuple[int, str]:
    home = here.parent / "home"
    before, passwd = _state(home), Path("/etc/passwd").stat().st_mtime_ns
    (here / "arm.urdf").write_text(
        text.replace("HOME", home.as_posix()).replace("ABOVE", here.parent.name), encoding="utf-8"
    )
    ran = run("import", "arm.urdf", "--cell")
    assert "Traceback" not in ran.out + ran.err
    assert "bug of cellc" not in ran.out + ran.err
    assert _state(home) == before
    assert Path("/etc/passwd").stat().st_mtime_ns == passwd
    assert sorted(path.name for path in here.parent.iterdir()) == ["bench", "home"]
    known = {"arm.urdf", "cell.yaml", "linked", "odd_arm", "p", here.parts[1]}
    assert {path.name for path in here.iterdir()} <= known
    return ran.code, ran.out + ran.err


@pytest.mark.parametrize("attributes", MESHES.values(), ids=MESHES.keys())
def test_mesh_outside_is_neither_written_to_nor_copied(attributes: str, here: Path) -> None:
    _imported(here, _with_mesh(attributes))
    folder = here / "odd_arm"
    held = _state(folder) if folder.exists() else {}
    assert "solid secret" not in "".join(held.values())


@pytest.mark.parametrize("prepare", FOLDERS.values(), ids=FOLDERS.keys())
def test_what_stands_in_the_place_of_the_folder_is_not_followed(prepare: Callable[[Path], None], here: Path) -> None:
    prepare(here)
    mine = {name: text for name, text in _state(here).items() if text == "mine\n"}
    code, out = _imported(here, _robot(*ARM))
    assert code in (0, 1), out
    assert {name: text for name, text in _state(here).items() if text == "mine\n"} == mine
    checked = run("import", "--check", "odd_arm")
    assert "Traceback" not in checked.out + checked.err
    assert checked.code in (0, 1, 2)


def test_lock_that_leads_out_is_not_read(here: Path) -> None:
    assert _imported(here, _robot(*ARM))[0] == 0
    lock = here / "odd_arm/import.lock.json"
    facts = json.loads(lock.read_text(encoding="utf-8"))
    facts["files"]["../../home/.bashrc"] = hashlib.sha256(b"home\n").hexdigest()
    lock.write_text(json.dumps(facts), encoding="utf-8")
    assert run("import", "--check", "odd_arm").code == 2


def test_attributes_are_changed_to_the_letter_and_no_others(here: Path) -> None:
    (here / "meshes").mkdir()
    (here / "meshes/a.stl").write_text(_SECRET, encoding="utf-8")
    mesh = "<mesh data=' filename=\"meshes/b.stl\"'\n filename = 'meshes/a.stl' scale='1 1 1'/>"
    shape = f"<!-- <mesh filename='x'/> -->{mesh}"
    text = _robot(*ARM).replace(
        '<link name="a">', f'<link name="a"><collision><geometry>{shape}</geometry></collision>'
    )
    assert _imported_with(here, text)[0] == 0
    told = shape.replace("'meshes/a.stl'", '"package://meshes/a.stl"')
    assert told in (here / "odd_arm/robot.urdf").read_text(encoding="utf-8")


def _imported_with(here: Path, text: str) -> tuple[int, str]:
    (here / "arm.urdf").write_text(text, encoding="utf-8")
    ran = run("import", "arm.urdf")
    return ran.code, ran.out + ran.err


@pytest.mark.parametrize("number", ["1" + "0" * 400, "-1", "0", ".nan", ".inf", "1e400", "true", "x", "[1]"])
def test_no_number_beside_a_description_is_more_than_a_rate(number: str, tmp_path: Path) -> None:
    file = tmp_path / "controllers.yaml"
    arm = f"arm: {{ros__parameters: {{joints: [j], constraints: {{goal_time: {number}}}}}}}\n"
    file.write_text(f"controller_manager: {{ros__parameters: {{update_rate: {number}}}}}\n{arm}", encoding="utf-8")
    found = there(read_controllers(file, ["j"]))
    assert 0.0 < found.update_rate_hz <= 100.0
    assert 0.0 < found.goal_time_s <= 1.0


@pytest.mark.parametrize("links", ["5", "null", "{a: b}", "text", "[[1], {}]"])
def test_pairs_that_are_none_are_a_persons(links: str) -> None:
    person = facts_in(f"allowed_collisions: [{{links: {links}}}]\n")
    now = {"allowed_collisions": [{"links": ["a", "b"], "because": "r.srdf says Adjacent"}]}
    assert person is not None
    assert merged({}, now, person)["allowed_collisions"]
    assert merged(person, now, now) == now


def test_files_beside_a_description_are_read_up_to_a_bound_together(tmp_path: Path) -> None:
    text = "arm: {ros__parameters: {joints: [j], constraints: {goal_time: 3}}}\n"
    (tmp_path / "b.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "a.yaml").write_text("# " + "-" * 100 + "\n", encoding="utf-8")
    (tmp_path / "dangling.yaml").symlink_to(tmp_path / "nothing")
    assert controllers_near(tmp_path / "arm.urdf", ["j"]).goal_time_s == 3.0
    with in_force(replace(DEFAULTS, xml_bytes=100 + len(text))):
        assert controllers_near(tmp_path / "arm.urdf", ["j"]).file is None
