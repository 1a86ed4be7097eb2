"""How the program of the bring-up is called, and what it leaves behind when it ends."""

from __future__ import annotations

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.cells import ROOT
from tests.consumers.stand_in_graph import program


@pytest.mark.parametrize("text", ["abc", "inf", "nan", "-1"])
def test_patience_that_is_no_time_is_a_usage_error(
    text: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("CELL_WAIT_S", text)
    with pytest.raises(SystemExit) as ended:
        program().main(["--plan", "none.json", "--target", "mock", "start"])
    assert ended.value.code == 2
    assert "invalid seconds value" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform != "linux", reason="prctl(2) is of Linux")
def test_program_behind_a_killed_bring_up_ends_too() -> None:
    waits = "import sys; print('waits', flush=True); sys.stdin.read()"
    code = f"""
from types import SimpleNamespace
import sys, time
from tests.consumers.stand_in_graph import program
module = program()
graph = SimpleNamespace(spin=time.sleep)
module.run_while_claimed(graph, SimpleNamespace(proof=[]), [sys.executable, "-c", {waits!r}])
"""
    taken = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=ROOT)
    assert taken.stdin is not None
    assert taken.stdout is not None
    assert taken.stdout.readline() == b"waits\n"
    taken.kill()
    with ThreadPoolExecutor(1) as pool:
        ended = pool.submit(taken.stdout.read)  # ends when nobody holds the other end
        try:
            assert ended.result(timeout=30.0) == b""
        finally:
            taken.stdin.close()
            taken.wait()
