"""No name in a file of a generated folder has a command write outside of its output.

Each field of each file takes its turn with a name that leads out, under a command that reads the folder.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import cycle
from pathlib import Path
from typing import Any, TypeAlias

import pytest

from cellc.contract.base import ContractModel
from cellc.contract.contract import Contract
from cellc.contract.file_names import is_file_name, is_inside
from cellc.contract.manifest import Manifest
from cellc.contract.reading import FormatError, read_json
from tests.cells import generated
from tests.cli.run import run

_Place: TypeAlias = "tuple[str | int, ...]"
FILES = ("contract.json", "manifest.json", "rehearsals.json", "config/bring_up.json")
COMMANDS = (
    ("mock", "{folder}", "--edited", "--evidence", "{out}/evidence", "--records", "{out}/records.jsonl"),
    ("view", "{folder}"),
    ("campaign", "{folder}", "--edited", "--list"),
    ("diff", "{other}", "{folder}"),
    ("sweep", "{folder}", "--edited", "--runs", "1", "--jobs", "1", "--journal", "{out}/journal.jsonl"),
)
REHEARSED = ("diff", "{folder}", "{other}", "--rehearse")
"""With names that become paths, which are refused before the mock starts; with others it takes seconds."""
SHARE = 6
"""One of so many other fields; all of them take two minutes."""
# Names that no file of a folder has as a path, each in another way.
NO_PATHS = (
    "",
    "..",
    "../x",
    "/abs",
    "a/../b",
    "a//b",
    "a/",
    "./a",
    "a\\b",
    "c:/a",
    "a\0b",
    "a\nb",
    "a" * 300,
    "a/" * 2500,
)
NO_CELLS = (*NO_PATHS, "a/b", "A", "a b", "a-b", "a.b", "é", "a" * 65)


@pytest.mark.parametrize("name", NO_PATHS, ids=ascii)
def test_no_file_of_a_folder_is_named_so(name: str) -> None:
    assert not is_inside(name)
    assert not is_file_name(name)
    contract, manifest = _text("contract.json"), _text("manifest.json")
    for key in ("urdf_mock", "urdf_real", "srdf", "rehearsals", "bring_up"):
        _refused(contract, Contract, ("files", key), name)
    _refused(contract, Contract, ("files", "parameters"), {"manager": name})
    if name not in ("..", "../x", "a/../b", "./a"):  # they lie beside the folder; who reads them asks where
        _refused(contract, Contract, ("files", "packages"), [name])
    _refused(manifest, Manifest, ("files",), {name: "0"})


@pytest.mark.parametrize("name", NO_CELLS, ids=ascii)
def test_no_cell_is_named_so(name: str) -> None:
    _refused(_text("contract.json"), Contract, ("cell",), name)
    _refused(_text("manifest.json"), Manifest, ("cell",), name)


def _text(file: str) -> str:
    return (generated("minimal") / file).read_text(encoding="utf-8")


def _refused(text: str, model: type[Contract | Manifest], place: _Place, value: Any) -> None:
    with pytest.raises(FormatError, match=r"must be a|must have|at most"):
        read_json(json.dumps(_with(json.loads(text), place, value)), model)


def _with(data: Any, place: _Place, value: Any) -> Any:
    inner = data
    for step in place[:-1]:
        inner = inner[step]
    inner[place[-1]] = value
    return data


def _fields(file: str) -> Iterator[tuple[str, _Place]]:
    """Yield a place of each text, once for entries of one list or mapping of names."""
    fields = {field for model in ContractModel.__subclasses__() for field in model.model_fields}
    known: set[str] = set()
    open_: list[_Place] = [()]
    data = json.loads(_text(file))
    while open_:
        place = open_.pop(0)
        value = data
        for step in place:
            value = value[step]
        if isinstance(value, dict | list):
            open_ += [(*place, step) for step in (value if isinstance(value, dict) else range(len(value)))]
        elif isinstance(value, str):
            kind = ".".join(str(step) if step in fields else "*" for step in place)
            if kind not in known:
                known.add(kind)
                yield file, place


class _Writes:
    """Every path that this process writes, makes, moves or removes while it is watched."""

    def __init__(self) -> None:
        self.paths: list[str] = []
        self.watched = False
        sys.addaudithook(self._heard)

    def _heard(self, event: str, given: tuple[Any, ...]) -> None:
        if not self.watched:
            return
        if event == "open" and isinstance(given[0], str | bytes) and _writes(given[1], given[2]):
            self.paths.append(str(given[0]))
        elif event in ("os.remove", "os.rmdir") and given[1] != -1:
            return  # of a tree that is removed, whose top is told too
        elif event in ("os.mkdir", "os.remove", "os.rmdir", "os.rename", "os.link", "os.symlink", "os.truncate"):
            self.paths += [str(one) for one in given[:2] if isinstance(one, str | Path)]

    @contextmanager
    def told(self) -> Iterator[None]:
        self.paths, self.watched = [], True
        try:
            yield
        finally:
            self.watched = False


def _writes(mode: str | None, flags: int) -> bool:
    return bool(flags & 3) if mode is None else not set(mode).isdisjoint("wax+")


@pytest.fixture(name="writes", scope="module")
def writes_fixture() -> _Writes:
    return _Writes()


def test_no_name_in_a_folder_leads_a_command_to_write_elsewhere(
    tmp_path: Path, writes: _Writes, monkeypatch: pytest.MonkeyPatch
) -> None:
    work, out, private, outside = (tmp_path / name for name in ("work", "out", "private", "outside"))
    for one in (work, out, private, outside):
        one.mkdir()
    monkeypatch.chdir(work)
    monkeypatch.setattr(tempfile, "tempdir", str(private))
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    monkeypatch.setattr(sys, "dont_write_bytecode", True)  # what Python itself keeps is no command's
    leading = cycle((f"{outside}/absolute", f"{'../' * 40}{outside.as_posix().lstrip('/')}/relative"))
    every = [field for file in FILES for field in _fields(file)]
    assert len(every) > 60
    fields = [field for number, field in enumerate(every) if number % SHARE == 0 or field[1][0] in ("cell", "files")]
    ended = set[int]()
    for number, ((file, place), name, command) in enumerate(zip(fields, leading, cycle(COMMANDS), strict=False)):
        folder = _spoilt(tmp_path / "folders" / str(number), file, place, name)
        values = {
            "folder": folder.as_posix(),
            "other": generated("minimal").as_posix(),
            "out": (out / str(number)).as_posix(),
        }
        command = REHEARSED if place[0] in ("cell", "files") else command
        with writes.told():
            ran = run(*(word.format(**values) for word in command))
        ended.add(ran.code)
        assert ran.code in (0, 1, 2)
        assert "Traceback" not in ran.err, (file, place, command, ran.err)
        strayed = [path for path in writes.paths if not _is_output(Path(path), (out, private), work)]
        assert strayed == [], (file, place, command)
        shutil.rmtree(folder)
    assert ended >= {0, 2}
    assert not list(outside.iterdir())


def _is_output(path: Path, folders: tuple[Path, ...], work: Path) -> bool:
    # A temporary file without a name is opened by its folder: open(2), O_TMPFILE.
    if str(path) == "/dev/null" or any(folder in (path, *path.parents) for folder in folders):
        return ".." not in path.parts
    return (work / path).parent == work and path.name.startswith(("minimal.html", ".minimal.html.tmp-"))


def _spoilt(folder: Path, file: str, place: _Place, name: str) -> Path:
    """Return a copy of a generated folder with one text replaced, and a manifest that fits it."""
    shutil.copytree(generated("minimal"), folder)
    changed = folder / file
    changed.write_text(
        json.dumps(_with(json.loads(changed.read_text(encoding="utf-8")), place, name)), encoding="utf-8"
    )
    if file != "manifest.json":
        manifest = folder / "manifest.json"
        digest = hashlib.sha256(changed.read_bytes()).hexdigest()
        spoilt = _with(json.loads(manifest.read_text(encoding="utf-8")), ("files", file), digest)
        manifest.write_text(json.dumps(spoilt), encoding="utf-8")
    return folder
