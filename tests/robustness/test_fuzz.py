"""A sample of what the fuzzer makes; ``python -m tests.robustness.fuzz --count 100000`` takes the rest."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.compiler import pipeline
from cellc.robot.description.packages import on_package_path
from tests.cells import ROOT
from tests.robustness.fuzz import oracle
from tests.robustness.fuzz.inputs import KINDS, make_input
from tests.robustness.fuzz.oracle import Sandbox, judge

COUNTS = {"spec": 60, "device": 60, "description": 60, "folder": 50, "cache": 8, "import": 30}


@pytest.fixture(name="sandbox")
def sandbox_fixture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Sandbox]:
    for name in ("XDG_CACHE_HOME", "XDG_STATE_HOME", "CELLC_NO_CACHE"):
        monkeypatch.setenv(name, "")  # the sandbox sets them, and this puts them back
    with on_package_path([]):
        yield Sandbox(tmp_path)


@pytest.mark.parametrize("kind", KINDS)
def test_no_input_ends_in_a_traceback_or_an_answer_that_is_wrong(kind: str, sandbox: Sandbox) -> None:
    for number in range(COUNTS[kind]):
        assert judge(make_input(kind, number), sandbox) == [], f"{kind} {number}"


def test_two_words_name_the_same_input_in_every_process() -> None:
    script = (
        "import hashlib\nfrom tests.robustness.fuzz.inputs import KINDS, make_input\n"
        "for kind in KINDS:\n    for number in (1, 2, 3):\n"
        "        print(hashlib.sha256(repr(make_input(kind, number)).encode()).hexdigest())\n"
    )
    environment = {**os.environ, "PYTHONHASHSEED": "7"}
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    here = [hashlib.sha256(repr(make_input(kind, number)).encode()) for kind in KINDS for number in (1, 2, 3)]
    assert done.stdout.split() == [digest.hexdigest() for digest in here]


def test_a_traceback_and_a_wrong_answer_are_seen(sandbox: Sandbox, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = next(number for number in range(100) if not make_input("cache", number).damage)
    monkeypatch.setattr(oracle, "_answers", iter([("before",), ("before",), ("now",)]).__next__)
    assert [found.wrong for found in judge(make_input("cache", whole), sandbox)] == ["wrong answer"]

    def broken(path: str) -> pipeline.Checked:
        raise KeyError(path)

    monkeypatch.setattr(oracle, "check", broken)
    assert [found.wrong for found in judge(make_input("spec", 0), sandbox)] == ["traceback"]
