"""Ctrl-C at many moments of real processes: no traceback, whole files or none, nothing temporary left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.refused import everything_below
from tests.cli.run import MINIMAL, PICK, run

pytestmark = pytest.mark.skipif(os.name != "posix", reason="Ctrl-C is sent as a POSIX signal")
# From the imports to the end of a run, which takes about 1.3 s on two cores.
MOMENTS_S = (0.0, 0.02, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.2)
_START = """
import sys
sys.argv[0] = "cellc"
from cellc.__main__ import main
print("started", flush=True)
main()
"""


def _interrupted(arguments: list[str], moment_s: float) -> tuple[int, str]:
    """Press Ctrl-C so long after the command began; return exit code and standard error."""
    child = subprocess.Popen(
        [sys.executable, "-c", _START, *arguments],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "started\n"
    time.sleep(moment_s)
    child.send_signal(signal.SIGINT)
    _, told = child.communicate(timeout=60)
    return child.returncode, told


def _assert_ended_well(code: int, told: str) -> None:
    # 0: it was done before. -2: Python's own end after the command's, when the signal came while it was leaving.
    assert code in (0, 1, 2, -signal.SIGINT), told
    assert "Traceback" not in told
    assert code in (0, -signal.SIGINT) or "interrupted" in told


@pytest.mark.parametrize("moment_s", MOMENTS_S)
def test_interrupted_build_leaves_a_whole_folder_or_none(moment_s: float, tmp_path: Path) -> None:
    _assert_ended_well(*_interrupted(["build", PICK, "-o", str(tmp_path / "out")], moment_s))
    left = everything_below(tmp_path)
    assert left == [] or "out/ur5e_pick/manifest.json" in left
    assert [name for name in left if "tmp-" in name] == []
    if "out/ur5e_pick" in left:
        assert run("build", "--check", PICK, "-o", (tmp_path / "out").as_posix()).code == 0


@pytest.mark.parametrize("moment_s", MOMENTS_S[1::2])
def test_interrupted_check_of_many_cells_ends_its_workers(moment_s: float) -> None:
    cells = [file.as_posix() for file in sorted((ROOT / "tests/corpus/valid").glob("*.yaml"))]
    code, told = _interrupted(["check", *cells], moment_s)
    # Standard error is read to its end: no process that shares it is left.
    _assert_ended_well(code, told)


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    output = tmp_path_factory.mktemp("built")
    assert run("build", MINIMAL, "-o", output.as_posix()).code == 0
    return output / "minimal"


@pytest.mark.parametrize("moment_s", MOMENTS_S[:6])
def test_interrupted_mock_leaves_whole_records_or_none(moment_s: float, built: Path, tmp_path: Path) -> None:
    _assert_ended_well(*_interrupted(["mock", str(built), "--records", str(tmp_path / "records.jsonl")], moment_s))
    assert everything_below(tmp_path) in ([], ["records.jsonl"])
    for file in tmp_path.iterdir():
        assert file.read_text().endswith("}\n")
