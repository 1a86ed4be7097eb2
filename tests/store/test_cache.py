"""The cache: where it is, what it forgives, and that an answer never depends on it."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from cellc.contract.store.cache import GEOMETRY, Program, cache_folder, recall


@dataclass(frozen=True, slots=True)
class Answer:
    value: float


class Counting:
    """Computes, and counts how often."""

    def __init__(self) -> None:
        self.calls = 0

    def __call__(self) -> Answer:
        self.calls += 1
        return Answer(0.1)


@pytest.fixture(name="home", autouse=True)
def home_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CELLC_NO_CACHE", raising=False)
    return tmp_path / "cellc"


def _entries(home: Path) -> list[Path]:
    return sorted(home.rglob("*.*"))


def test_an_answer_is_computed_once(home: Path) -> None:
    compute = Counting()
    assert [recall("kind", "question", Answer, compute) for _ in range(3)] == [Answer(0.1)] * 3
    assert compute.calls == 1
    assert len(_entries(home)) == 1  # no half-written file is left


def test_another_question_or_kind_is_another_entry() -> None:
    compute = Counting()
    for kind, question in (("a", "x"), ("a", "y"), ("b", "x")):
        recall(kind, question, Answer, compute)
    assert compute.calls == 3


@pytest.mark.parametrize("damage", [b"", b"{", b"\xff\xfe", b"[]", b'{"value": "x"}', b'{"value": null}'])
def test_a_damaged_entry_is_computed_again(home: Path, damage: bytes) -> None:
    compute = Counting()
    recall("kind", "question", Answer, compute)
    (entry,) = _entries(home)
    good = entry.read_bytes()
    entry.write_bytes(damage)
    assert recall("kind", "question", Answer, compute) == Answer(0.1)
    assert compute.calls == 2
    assert entry.read_bytes() == good


def test_the_cache_can_be_turned_off(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CELLC_NO_CACHE", "1")
    compute = Counting()
    recall("kind", "question", Answer, compute)
    recall("kind", "question", Answer, compute)
    assert compute.calls == 2
    assert not home.exists()


def test_a_folder_that_cannot_be_made_costs_time_only(home: Path) -> None:
    home.write_text("a file in the place of the folder")
    compute = Counting()
    assert recall("kind", "question", Answer, compute) == Answer(0.1)
    assert recall("kind", "question", Answer, compute) == Answer(0.1)
    assert compute.calls == 2


def test_another_program_does_not_read_the_entry(monkeypatch: pytest.MonkeyPatch) -> None:
    compute = Counting()
    recall("kind", "question", Answer, compute)
    monkeypatch.setattr("cellc.contract.store.cache.__version__", "0.0.0")
    recall("kind", "question", Answer, compute)
    assert compute.calls == 2


def test_an_entry_of_other_code_or_of_other_libraries_is_not_read() -> None:
    compute = Counting()
    for program in (GEOMETRY, Program(("verify",), ()), Program(("verify",), ("numpy",)), Program(("verify",), ())):
        recall("kind", "question", Answer, compute, program=program)
    assert compute.calls == 3


def test_a_relative_folder_is_ignored_as_the_standard_has_it() -> None:
    assert cache_folder({"XDG_CACHE_HOME": "relative"}, "linux") == Path.home() / ".cache" / "cellc"
    assert cache_folder({}, "darwin") == Path.home() / "Library" / "Caches" / "cellc"
    assert cache_folder({"CELLC_NO_CACHE": "1"}, "linux") is None
    assert cache_folder({"CELLC_NO_CACHE": "0", "XDG_CACHE_HOME": "/c"}, "linux") == Path("/c/cellc")


def test_a_warm_check_says_the_same_without_the_robot_library(home: Path) -> None:
    root = Path(__file__).resolve().parents[2]
    script = (
        "import sys; from cellc.compiler.pipeline import check; "
        "print([str(d) for d in check('cells/ur5e_pick/cell.yaml').diagnostics]); print('pinocchio' in sys.modules)"
    )

    def run(**environment: str) -> list[str]:
        variables = {**os.environ, **environment}
        command = [sys.executable, "-c", script]
        done = subprocess.run(command, cwd=root, env=variables, capture_output=True, text=True, check=True)
        return done.stdout.splitlines()

    cold, warm, without = run(), run(), run(CELLC_NO_CACHE="1")
    assert cold[0] == warm[0] == without[0]
    assert [cold[1], warm[1], without[1]] == ["True", "False", "True"]
    assert home.exists()
