"""Values of every kind in files beside the contract: what a sweep draws, the index of evidence, the lock of an import.

Each field takes its turn with each value: a refusal in one line that names the file, or the file counts for nothing.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any, TypeAlias

import pytest

from cellc.contract.uncertainty import Uncertainty
from cellc.mock import folder as folders
from cellc.mock.cell import MockCell, load
from cellc.mock.errors import MockError
from cellc.mock.sweep.sweep import uncertainty_of
from tests.cells import CORPUS, ROOT
from tests.cli.run import Ran, run
from tests.printing.payloads import harm

_Place: TypeAlias = "tuple[str | int, ...]"
VALUES: tuple[Any, ...] = (
    "../../x",
    "/abs",
    "\x1b[2J\n::error::f",
    1e308,
    10**30,
    float("nan"),
    -1,
    True,
    None,
    [],
    {},
    [[[]]],
    "a" * 10**5,
)
NAMES = ("../../x", "/abs", "\x1b[2J\n::error::f", "a\0b", "")
UNCERTAINTY, INDEX, LOCK = "config/uncertainty.json", "evidence.json", "import.lock.json"


def _places(value: Any, place: _Place = ()) -> Iterator[_Place]:
    """Yield every field, of lists and mappings of names the first ones."""
    yield place
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, one in islice(inner, 8):
        yield from _places(one, (*place, step))


def _spoilt(text: str) -> Iterator[str]:
    """Yield the text with each field in turn of another value, and each key of another name."""
    for place in _places(json.loads(text)):
        if not place:
            yield from map(json.dumps, VALUES)
            continue
        for value in VALUES:
            data, holder = _opened(text, place)
            holder[place[-1]] = value
            yield json.dumps(data)
        for name in NAMES if isinstance(place[-1], str) else ():
            data, holder = _opened(text, place)
            holder[name] = holder.pop(place[-1])
            yield json.dumps(data)


def _opened(text: str, place: _Place) -> tuple[Any, Any]:
    data = holder = json.loads(text)
    for step in place[:-1]:
        holder = holder[step]
    return data, holder


def _ran(*words: str) -> Ran:
    ran = run(*words)
    assert ran.code in (0, 1, 2)
    assert harm(ran.out) == harm(ran.err) == []
    assert "Traceback" not in ran.err
    assert len(ran.err.splitlines()) <= 1
    return ran


@pytest.fixture(name="here")
def here_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    return tmp_path


def test_what_a_sweep_draws_is_refused_with_its_file(here: Path) -> None:
    shutil.copytree(ROOT / "generated/ur5e_pick", "folder")
    file = Path("folder", UNCERTAINTY)
    good = load(Path("folder"))
    ends = list[bool]()
    for number, text in enumerate(_spoilt(file.read_text(encoding="utf-8"))):
        file.write_text(text, encoding="utf-8")
        refusal = _refusal(good)
        ends.append(refusal == "")
        assert harm(refusal) == []
        if number % 64 == 0:  # as people meet it
            ran = _ran("campaign", "folder", "--edited", "--list")
            assert (ran.code == 0) is ends[-1]
            assert ran.code == 0 or ran.err.startswith(f"error: {UNCERTAINTY}: "), text[:200]
    assert len(ends) > 320
    assert ends.count(True) < len(ends) / 10  # names of quantities are free
    assert [path.name for path in here.iterdir()] == ["here"]


def _refusal(cell: MockCell) -> str:
    """Return why the file in ``folder`` is refused, empty where it is read; a sweep may refuse what it names."""
    try:
        read = folders._read_model(Path("folder"), UNCERTAINTY, Uncertainty)
    except MockError as problem:
        return str(problem)
    with suppress(MockError):
        uncertainty_of(cell.with_realities(replace(cell.folder, uncertainty=read), {}))
    return ""


def _evidence() -> Ran:
    return _ran("mock", (ROOT / "generated/minimal").as_posix(), "--evidence", "made")


def _imported() -> Ran:
    return _ran("import", "stage", "-o", "made", "--force")


@pytest.mark.parametrize(("index", "again"), [(INDEX, _evidence), (LOCK, _imported)])
def test_an_index_of_others_has_no_file_removed(index: str, again: Callable[[], Ran], here: Path) -> None:
    shutil.copytree(CORPUS / "valid/parts/stage", "stage")
    Path("stage/device.yaml").unlink()
    assert again().code == 0
    shutil.copytree("made", "kept")
    held = json.loads(Path("kept", index).read_text(encoding="utf-8"))
    for outside in (here / "x", here / "here/mine", here / "here/made/mine"):
        outside.write_text("of somebody", encoding="utf-8")
        names = (outside.as_posix(), os.path.relpath(outside, here / "here/made"))
        # With the right hash: as a file of ours that this run does not write again.
        hashes = dict.fromkeys(names, hashlib.sha256(outside.read_bytes()).hexdigest())
        wrong = {**held, "files": {**held["files"], **hashes}}
        Path("made", index).write_text(json.dumps(wrong), encoding="utf-8")
        again()
        assert outside.exists() or outside.parent.name == "made", outside
    for text in islice(_spoilt(json.dumps(held)), 0, None, 12):
        shutil.rmtree("made")
        shutil.copytree("kept", "made")
        Path("made", index).write_text(text, encoding="utf-8")
        ran = again()
        assert ran.code == 0 or ran.err.startswith("error: made"), text[:200]
