"""The promises of SECURITY.md on what is kept and generated, each held through a command."""

from __future__ import annotations

import json
import os
import re
import shutil
import stat
import subprocess
import tarfile
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest
import yaml

from cellc.compiler.feasibility import compute
from cellc.compiler.feasibility.question import MotionQuestion
from cellc.contract.store import cache
from cellc.contract.store.cache import read_entry, write_entry
from cellc.contract.store.cache_key import _working_tree
from tests.cells import CORPUS
from tests.cli.hostile_cell import IN_THE_WAY, SPEC, make, mesh, new_cell, sparse
from tests.cli.run import Ran, run
from tests.consumers.launch_interpreter import Launch
from tests.consumers.launch_text import LaunchError
from tests.consumers.starting import CONFIRMED
from tests.deploy.test_unknown_effects import _SPEC as SILENT
from tests.feasibility.test_kept_answers import LARGE, SMALL, _cube
from tests.output.building import contents, staging_at_work
from tests.store.test_swap import _meanwhile

_FOUND = "in-collision"


@pytest.fixture(name="cell")
def cell_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a cell, which is the current one."""
    folder = new_cell(tmp_path / "cell")
    monkeypatch.chdir(folder)
    return folder


def test_a_changed_mesh_package_or_link_is_checked_again(cell: Path) -> None:
    free, bar = (partial(_cube, side=side) for side in (SMALL, LARGE))
    make(cell, IN_THE_WAY | mesh("package://parts/bar.stl"))
    make(cell.parent, {"one/parts/bar.stl": free, "one/parts/large.stl": bar, "two/parts/bar.stl": bar})
    for packages, change, found in (
        ("one", {}, False),
        ("two", {}, True),
        ("one", {}, False),
        ("one", {"one/parts/bar.stl": bar}, True),
        ("one", {"one/parts/bar.stl": free}, False),
        ("one", {"one/parts/bar.stl": lambda place: place.symlink_to("large.stl")}, True),
    ):
        make(cell.parent, change)
        ran = run("check", "--package-path", str(cell.parent / packages), "cell.yaml")
        assert (_FOUND in ran.out) == found, (packages, change, ran.out)


@pytest.fixture(name="generated")
def generated_fixture(cell: Path) -> Path:
    """The generated folder of the cell."""
    assert run("build", "cell.yaml").code == 0
    return cell / "generated/fuzzed"


_NUMBERS = ("NaN", "-1", "1e300", "1e9", "true", "null", "1" + "0" * 400)
_PLACES = (
    ("contract.json", ("managers", "control", "update_rate_hz")),
    ("contract.json", ("joint_limits", "stage_turn", "jerk")),
    ("rehearsals.json", ("rehearsals", 0, "timeout_s")),
    ("rehearsals.json", ("rehearsals", 0, "steps", 1, "duration_s")),
)


@pytest.mark.parametrize(("file", "place"), _PLACES, ids=str)
def test_a_damaged_number_ends_the_mock_with_a_refusal_or_an_outcome(
    file: str, place: tuple[str | int, ...], generated: Path
) -> None:
    whole = json.loads((generated / file).read_text(encoding="utf-8"))
    inner = whole
    for step in place[:-1]:
        inner = inner[step]
    assert place[-1] in inner
    inner[place[-1]] = "MARK"
    for number in _NUMBERS:
        (generated / file).write_text(json.dumps(whole).replace('"MARK"', number), encoding="utf-8")
        ran = run("mock", "generated/fuzzed", "--edited")
        assert ran.code in (0, 1, 2), (number, ran)
        assert (ran.code == 2) == (len(ran.err.splitlines()) == 1), (number, ran)
        assert "Traceback" not in ran.err


_DAMAGES: dict[str, tuple[Callable[[Path], object], str]] = {
    "larger than a file may be": (sparse(1 << 40), "--limit folder-bytes=N"),
    "a pipe": (os.mkfifo, "is not a regular file"),
    "a device": (lambda place: place.symlink_to("/dev/zero"), "is a link that leads out of the folder"),
    "nested": (lambda place: place.write_text("[" * 10_000, encoding="utf-8"), "is not JSON"),
    "many values": (
        lambda place: place.write_text(json.dumps([[0] * 1000] * 401), encoding="utf-8"),
        "holds more than 400000 values",
    ),
    "half": (lambda place: place.write_text('{"format": ', encoding="utf-8"), "is not JSON"),
}


@pytest.mark.parametrize(("damage", "words"), _DAMAGES.values(), ids=_DAMAGES)
def test_a_damaged_file_of_a_generated_folder_is_refused_in_one_line(
    damage: Callable[[Path], object], words: str, generated: Path
) -> None:
    for name in ("contract.json", "rehearsals.json", "manifest.json"):
        kept = (generated / name).read_bytes()
        make(generated, {name: damage})
        ran = run("mock", "generated/fuzzed", "--edited")
        assert (ran.code, len(ran.err.splitlines()), name in ran.err, words in ran.err) == (2, 1, True, True), ran
        (generated / name).unlink()
        (generated / name).write_bytes(kept)


@pytest.fixture(name="lying")
def lying_fixture(cell: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of this user, with an entry that no shape of the cell is in the way."""
    home = cell.parent / "home"
    monkeypatch.setenv("XDG_CACHE_HOME", str(home))
    monkeypatch.setenv("XDG_STATE_HOME", str(home / "state"))
    make(cell, IN_THE_WAY)
    answer = compute.answer
    with monkeypatch.context() as patch:
        patch.setattr(compute, "answer", lambda question, *given: answer(_emptied(question), *given))
        run("check", "cell.yaml")
    assert _FOUND not in run("check", "cell.yaml").out  # it is believed as it is
    return home / "cellc"


def _emptied(question: MotionQuestion) -> MotionQuestion:
    return replace(question, urdf=re.sub("<collision.*?</collision>", "", question.urdf, flags=re.S))


def _entry(home: Path) -> Path:
    (entry,) = (home / "motion").iterdir()
    return entry


def _changed(home: Path) -> None:
    content = bytearray(_entry(home).read_bytes())
    content[-1] ^= 1
    _entry(home).write_bytes(content)


def _moved(home: Path) -> None:
    entry = _entry(home)
    content = read_entry(f"motion/{entry.name}")
    assert content is not None
    write_entry("motion/other", content)
    (home / "motion/other").replace(entry)


def _piped(home: Path) -> None:
    entry = _entry(home)
    entry.unlink()
    os.mkfifo(entry)


def _linked(home: Path) -> None:
    entry = _entry(home)
    entry.replace(home / "elsewhere")
    entry.symlink_to(home / "elsewhere")


_UNTRUE: dict[str, Callable[[Path], object]] = {
    "one byte is another": _changed,
    "the entry of another question": _moved,
    "a pipe": _piped,
    "a link": _linked,
    "others may write": lambda home: (home / "motion").chmod(0o770),
    "a checkout holds it": lambda home: (home.parents[1] / ".git").mkdir(),
}


@pytest.mark.parametrize("spoil", _UNTRUE.values(), ids=_UNTRUE)
def test_an_answer_that_may_be_of_others_is_not_believed(spoil: Callable[[Path], object], lying: Path) -> None:
    spoil(lying)
    _working_tree.cache_clear()  # of the process that a user starts anew
    assert _FOUND in run("check", "cell.yaml").out


def test_an_answer_that_another_key_signed_is_not_believed(lying: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(lying.parent / "ours"))
    assert _FOUND in run("check", "cell.yaml").out


def test_an_answer_of_another_user_is_not_believed(lying: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getuid", lambda: -1)
    assert _FOUND in run("check", "cell.yaml").out


def test_an_entry_that_unpacks_to_more_than_an_answer_is_not_believed(
    lying: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cache, "MAX_CONTENT_BYTES", 10)
    assert _FOUND in run("check", "cell.yaml").out


def test_of_two_builds_the_later_writes_nothing(cell: Path, generated: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = contents(cell / "generated")
    make(cell, {"cell.yaml": SPEC.replace("10 deg", "20 deg")})
    _meanwhile(monkeypatch, lambda: staging_at_work(cell / "generated/.fuzzed.tmp-1"))
    ran = run("build", "cell.yaml")
    assert (ran.code, "error[output-busy]" in ran.out) == (1, True), ran
    assert contents(cell / "generated") == {".fuzzed.tmp-1/.cellc-lock": "", **before}


def test_a_staging_folder_that_came_out_of_an_archive_keeps_no_build_away(cell: Path, generated: Path) -> None:
    before = contents(generated)
    with tarfile.open(cell.parent / "stranger.tar", "w") as archive:
        for name, kind in ((".fuzzed.tmp-1", tarfile.DIRTYPE), (".fuzzed.tmp-1/.cellc-lock", tarfile.REGTYPE)):
            entry = tarfile.TarInfo(name)
            entry.type, entry.mode = kind, 0o1777  # with the mark that a build sets
            archive.addfile(entry)
    subprocess.run(["tar", "-xpf", str(cell.parent / "stranger.tar"), "-C", "generated"], check=True)
    assert (cell / "generated/.fuzzed.tmp-1").stat().st_mode & stat.S_ISVTX
    make(cell, {"cell.yaml": SPEC.replace("10 deg", "20 deg")})
    ran = run("build", "cell.yaml")
    assert ran.code == 0, ran
    assert contents(generated) != before
    assert [path.name for path in (cell / "generated").iterdir()] == ["fuzzed"]


def test_no_more_of_an_evidence_folder_is_compared_than_the_limit(cell: Path, generated: Path) -> None:
    def evidence(size: int) -> Ran:
        names = ("a.bin", "b.bin")
        index = json.dumps({"format": 1, "files": dict.fromkeys(names, "0" * 64)})
        make(cell, {"evidence/evidence.json": index, **{f"evidence/{name}": sparse(size) for name in names}})
        return run("mock", "generated/fuzzed", "--evidence", "evidence")

    ran = evidence(1 << 40)
    assert (ran.code, "folder-total-bytes" in ran.err) == (2, True), ran
    ran = evidence(1 << 10)
    assert (ran.code, "is not as cellc wrote it" in ran.err) == (2, True), ran


def test_the_real_target_waits_for_its_confirmation_and_for_a_person(cell: Path) -> None:
    shutil.copytree(CORPUS / "invalid/base/silent_arm", cell / "device")
    make(cell, {"cell.yaml": SILENT})
    assert run("build", "cell.yaml").code == 0
    texts = contents(cell / "generated/silent")
    for given in ({"target": "real"}, {"target": "real", "confirm_real": "yes"}):
        with pytest.raises(LaunchError, match="confirm_real"):
            Launch("silent", texts, given).run("launch/cell.launch.xml")
    started = Launch("silent", texts, CONFIRMED).run("launch/cell.launch.xml")
    told = [word for process in started.processes for word in process.arguments]
    assert "start" in told
    assert not {"activate", "claim"} & set(told)
    manager = yaml.safe_load(texts["config/controllers.yaml"])["controller_manager"]["ros__parameters"]
    assert manager["hardware_components_initial_state"] == {"unconfigured": ["it_hardware"]}
